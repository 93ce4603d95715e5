import { keepPreviousData, useQuery } from "@tanstack/react-query";
import { API, request } from "./client";
import { INDEPENDENT } from "../model/source";
import { fetchAll } from "./recordings";
import type { components } from "./schema";

type Schemas = components["schemas"];
export type Comparison = Schemas["Comparison"];
export type JudgedTrack = Schemas["JudgedTrackOut"];
export type Method = Schemas["MethodOut"];
export type ErrorStatistics = Schemas["ErrorStatistics"];
export type PairedDifference = Schemas["PairedDifferenceOut"];
export type WorstFrame = Schemas["WorstFrame"];

/** What is compared, as the page's address holds it. */
export interface EvaluationChoice {
  tracks: readonly string[];
  recordings: readonly string[];
  project: string | null;
  reference: string | null;
  snapshots: readonly string[];
  camera: string;
  hand: string;
  visibility: string;
  /** Of `independent`, `all` and the kinds of sources. */
  sources: readonly string[];
  withoutStart: boolean;
  within: number;
}

export const USUAL_WITHIN_PX = 10;

const USUAL_SOURCES: readonly string[] = [INDEPENDENT];
const isUsual = (sources: readonly string[]): boolean => sources.join() === USUAL_SOURCES.join();

const list = (text: string | null): string[] => (text ?? "").split(",").filter(Boolean);

export function readChoice(address: URLSearchParams): EvaluationChoice {
  const within = Number(address.get("within"));
  return {
    tracks: list(address.get("tracks")),
    recordings: list(address.get("recordings")),
    project: address.get("project"),
    reference: address.get("reference"),
    snapshots: list(address.get("snapshots")),
    camera: address.get("camera") ?? "",
    hand: address.get("hand") ?? "",
    visibility: address.get("visibility") ?? "",
    sources: address.get("sources") ? list(address.get("sources")) : USUAL_SOURCES,
    withoutStart: address.get("without_start") === "1",
    within: within > 0 && within <= 1000 ? within : USUAL_WITHIN_PX,
  };
}

/** The page's address of a choice. */
export function writeChoice(choice: EvaluationChoice): URLSearchParams {
  const address = new URLSearchParams();
  const put = (name: string, value: string | null): void => void (value && address.set(name, value));
  put("tracks", choice.tracks.join(","));
  put("recordings", choice.recordings.join(","));
  put("project", choice.project);
  put("reference", choice.reference);
  put("snapshots", choice.snapshots.join(","));
  put("camera", choice.camera);
  put("hand", choice.hand);
  put("visibility", choice.visibility);
  put("sources", isUsual(choice.sources) ? null : choice.sources.join(","));
  put("without_start", choice.withoutStart ? "1" : null);
  put("within", choice.within === USUAL_WITHIN_PX ? null : String(choice.within));
  return address;
}

export const isChosen = (choice: EvaluationChoice): boolean => choice.tracks.length > 0 || choice.recordings.length > 0 || choice.project !== null;

/** The same as a query of the API. */
export function queryOf(choice: EvaluationChoice): string {
  const query = new URLSearchParams();
  for (const id of choice.tracks) query.append("track", id);
  for (const id of choice.recordings) query.append("sequence", id);
  for (const id of choice.snapshots) query.append("snapshot", id);
  if (choice.project) query.set("project", choice.project);
  if (choice.reference) query.set("reference", choice.reference);
  if (choice.camera) query.set("camera", choice.camera);
  if (choice.hand) query.set("hand", choice.hand);
  if (choice.visibility) query.set("visibility", choice.visibility);
  if (!isUsual(choice.sources)) for (const source of choice.sources) query.append("source", source);
  if (choice.withoutStart) query.set("without_start", "true");
  query.set("within", String(choice.within));
  return query.toString();
}

/** Judged anew whenever the page is come back to, for the labels may have changed. */
export const useComparison = (choice: EvaluationChoice) =>
  useQuery({
    queryKey: ["evaluations", queryOf(choice)],
    queryFn: ({ signal }) => request<Comparison>("GET", `/evaluations?${queryOf(choice)}`, { signal }),
    enabled: isChosen(choice),
    placeholderData: keepPreviousData,
    retry: false,
    staleTime: 0,
  });

/** Projects whose recordings can be judged together. */
export const useEvaluableProjects = () =>
  useQuery({ queryKey: ["evaluations", "projects"], queryFn: () => fetchAll<Schemas["ProjectOut"]>("/projects") });

export const REPORTS = [
  { kind: "html", label: "Page (HTML)", help: "one file with tables, curves and pictures" },
  { kind: "csv", label: "Every joint (CSV)", help: "one row for each joint of each frame" },
  { kind: "json", label: "Numbers (JSON)", help: "what this page shows, for scripts" },
] as const;

export const reportUrl = (kind: (typeof REPORTS)[number]["kind"], choice: EvaluationChoice): string => `${API}/evaluations/report.${kind}?${queryOf(choice)}`;
