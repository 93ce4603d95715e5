/** Projects, who marks which frames, what reviewers say, and how well people agree. */

import { keepPreviousData, useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { API, request } from "./client";
import { fetchAll } from "./recordings";
import type { components } from "./schema";

type Schemas = components["schemas"];
export type Me = Schemas["MyAccount"];
export type Person = Schemas["Person"];
export type Project = Schemas["ProjectOut"];
export type ProjectRecording = Schemas["ProjectRecording"];
export type Assignment = Schemas["AssignmentOut"];
export type AssignmentState = Assignment["state"];
export type Comment = Schemas["CommentOut"];
export type CommentMake = Schemas["CommentMake"];
export type ReplicaSet = Schemas["ReplicaSetOut"];
export type ReplicaSetMake = Schemas["ReplicaSetMake"];
export type AgreementReport = Schemas["AgreementReport"];
export type Spread = Schemas["SpreadOut"];

/** Everything below is fetched anew after each change: a team's lists are short. */
export const teamKeys = ["teams"] as const;
const key = (...rest: readonly (string | undefined | null)[]) => [...teamKeys, ...rest] as const;

export const useMe = () => useQuery({ queryKey: key("me"), queryFn: () => request<Me>("GET", "/account"), staleTime: 60_000 });
export const usePeople = () => useQuery({ queryKey: key("people"), queryFn: () => fetchAll<Person>("/people") });
export const useProjects = (isArchived: boolean) =>
  useQuery({ queryKey: key("projects", String(isArchived)), queryFn: () => fetchAll<Project>("/projects", { archived: String(isArchived) }) });
export const useProject = (id: string | undefined) =>
  useQuery({ queryKey: key("project", id), queryFn: () => request<Project>("GET", `/projects/${id}`), enabled: Boolean(id) });
export const useProjectRecordings = (id: string) =>
  useQuery({ queryKey: key("recordings", id), queryFn: () => fetchAll<ProjectRecording>(`/projects/${id}/sequences`) });
export const useReplicaSets = (project: string) =>
  useQuery({ queryKey: key("replicas", project), queryFn: () => fetchAll<ReplicaSet>(`/projects/${project}/replica-sets`) });
export const useReplicaSet = (id: string | null | undefined) =>
  useQuery({ queryKey: key("replica", id), queryFn: () => request<ReplicaSet>("GET", `/replica-sets/${id}`), enabled: Boolean(id) });
const sourceQuery = (sources: readonly string[]): string => new URLSearchParams(sources.map((source) => ["source", source])).toString();
export const useAgreement = (id: string | undefined, sources: readonly string[]) =>
  useQuery({
    queryKey: [...key("agreement", id), ...sources],
    queryFn: () => request<AgreementReport>("GET", `/replica-sets/${id}/agreement?${sourceQuery(sources)}`),
    enabled: Boolean(id),
    placeholderData: keepPreviousData,
    retry: false,
  });
export const agreementFile = (id: string, kind: "csv" | "html" | "", sources: readonly string[]): string => `${API}/replica-sets/${id}/agreement${kind && `.${kind}`}?${sourceQuery(sources)}`;

export const useAssignments = (query: { mine?: "true"; project?: string; sequence?: string; state?: AssignmentState }, isWanted = true) =>
  useQuery({ queryKey: key("assignments", JSON.stringify(query)), queryFn: () => fetchAll<Assignment>("/assignments", query), refetchInterval: 30_000, enabled: isWanted });
export const useAssignment = (id: string | null) =>
  useQuery({ queryKey: key("assignment", id), queryFn: () => request<Assignment>("GET", `/assignments/${id}`), enabled: Boolean(id) });
export const useComments = (assignment: string | undefined, isShown = true) =>
  useQuery({
    queryKey: key("comments", assignment),
    queryFn: () => fetchAll<Comment>(`/assignments/${assignment}/comments`),
    enabled: Boolean(assignment) && isShown,
    retry: false,
  });

/** One change of the team's things; what was loaded of them is loaded again. */
export interface TeamChange {
  method: "POST" | "PUT" | "PATCH" | "DELETE";
  path: string;
  body?: unknown;
  /** Revision that is changed, where two people may change it. */
  revision?: number;
}

export function useTeamChange<T = unknown>() {
  const client = useQueryClient();
  return useMutation({
    mutationFn: ({ method, path, body, revision }: TeamChange) =>
      request<T>(method, path, { ...(body === undefined ? {} : { body }), headers: revision === undefined ? {} : { "If-Match": `"${revision}"` } }),
    onSettled: () => client.invalidateQueries({ queryKey: key() }),
  });
}

/** Where the annotator opens at an assignment's next frame. */
export function assignmentAddress(assignment: Assignment, frame: number | null = assignment.next_frame): string {
  const place = new URLSearchParams({ frame: String(frame ?? assignment.frame_first) });
  if (assignment.replica_set_id) place.set("replica", assignment.id);
  return `/recordings/${assignment.sequence_id}/annotate?${place}`;
}
