/** Fingertip detectors that a lab has trained with `handloom train-detector` and uploaded. */

import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { API, request, upload } from "./client";
import { fetchAll } from "./recordings";
import type { components } from "./schema";

export type Detector = components["schemas"]["DetectorOut"];

const KEY = ["detectors"] as const;

export const useDetectors = () => useQuery({ queryKey: KEY, queryFn: () => fetchAll<Detector>("/detectors") });

export const detectorFileUrl = (id: string): string => `${API}/detectors/${id}/detector.npz`;

/** A change after which the list is asked for again. */
function useChange<Subject, Result>(act: (subject: Subject) => Promise<Result>) {
  const client = useQueryClient();
  return useMutation({
    mutationFn: act,
    onSuccess: () => client.invalidateQueries({ queryKey: KEY }),
  });
}

export const useUploadDetector = () =>
  useChange((file: File) => {
    const form = new FormData();
    form.append("files", file, file.name);
    return upload<Detector>("/detectors", form, () => undefined, new AbortController().signal);
  });

export const useRemoveDetector = () => useChange((id: string) => request("DELETE", `/detectors/${id}`));
