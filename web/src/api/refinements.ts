/** Cameras of a recording, refined from its labels. */

import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { request } from "./client";
import { recordingKeys } from "./recordings";
import type { components } from "./schema";

export type Refinement = components["schemas"]["RefinementOut"];
export type RefinedCamera = components["schemas"]["RefinedCameraOut"];

const keyOf = (recordingId: string) => ["refinements", recordingId] as const;

/** The newest first. */
export const useRefinements = (recordingId: string) =>
  useQuery({ queryKey: keyOf(recordingId), queryFn: () => request<Refinement[]>("GET", `/sequences/${recordingId}/refinements`) });

/** Something that changes what is known of a recording's cameras. */
function useChange<Subject>(recordingId: string, act: (subject: Subject) => Promise<Refinement>) {
  const client = useQueryClient();
  return useMutation({
    mutationFn: act,
    onSettled: async () => {
      await client.invalidateQueries({ queryKey: keyOf(recordingId) });
      await client.invalidateQueries({ queryKey: recordingKeys.all });
    },
  });
}

export const useRefine = (recordingId: string) =>
  useChange(recordingId, (lenses: boolean) => request<Refinement>("POST", `/sequences/${recordingId}/refinements`, { body: { lenses } }));

export const useTakeRefinement = (recordingId: string) =>
  useChange(recordingId, (id: string) => request<Refinement>("POST", `/refinements/${id}/take`));

export const usePutRefinementBack = (recordingId: string) =>
  useChange(recordingId, (id: string) => request<Refinement>("POST", `/refinements/${id}/put-back`));
