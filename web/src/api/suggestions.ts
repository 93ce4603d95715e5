import type { Pose, PoseKey } from "../model/pose";
import { toWire } from "../model/pose";
import type { Suggestion } from "../model/suggestion";
import { request } from "./client";
import type { Page, WireSuggestion } from "./types";

const pathOf = (recording: string, camera: string, frame: number): string => `/sequences/${recording}/suggestions/${encodeURIComponent(camera)}/${frame}`;

const fromServer = ({ source, label, camera, frame, hand, joints, track_id: trackId, model }: WireSuggestion): Suggestion => ({ source, label, place: { camera, frame, hand }, trackId, model, joints });

/** The hands of an image as a track has them (the recording's best one if none is named); none where it was lost. */
export async function fetchTrackSuggestions(recording: string, camera: string, frame: number, track: string | undefined, signal: AbortSignal): Promise<Suggestion[]> {
  const page = await request<Page<WireSuggestion>>("GET", pathOf(recording, camera, frame), { query: { track_id: track }, signal });
  return page.items.map(fromServer);
}

/** The hands of an image as the hand detector sees them; none where it sees none. */
export async function fetchDetected(recording: string, camera: string, frame: number, signal: AbortSignal): Promise<Suggestion[]> {
  const page = await request<Page<WireSuggestion>>("GET", `${pathOf(recording, camera, frame)}/detector`, { signal });
  return page.items.map(fromServer);
}

/** A model fitted to the joints that are placed. */
export async function fetchFit(recording: string, { camera, frame, hand }: PoseKey, pose: Pose, signal: AbortSignal): Promise<Suggestion> {
  return fromServer(await request<WireSuggestion>("POST", `${pathOf(recording, camera, frame)}/${hand}/fit`, { body: { points: toWire(pose) }, signal }));
}
