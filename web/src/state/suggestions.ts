/** Suggestions of an open recording: beside the annotations, never among them; nothing here is saved. */

import { keyText, type PoseKey } from "../model/pose";
import { openJoints, placeText, type OpenJoint, type Source, type Suggestion, type SuggestionsOfHand } from "../model/suggestion";
import type { AnnotatorState } from "./annotator";
import { createStore, type Store } from "./store";

export interface SuggestionsState {
  /** By `keyText`, then by source. */
  readonly byPlace: Readonly<Record<string, SuggestionsOfHand>>;
  /** Sources that the person does not want to see. */
  readonly hidden: ReadonlySet<Source>;
}

export type SuggestionStore = Store<SuggestionsState>;

export const createSuggestionStore = (): SuggestionStore => createStore<SuggestionsState>({ byPlace: {}, hidden: new Set() });

/** Put suggestions in place of those that their sources gave before for the same hands. */
export function suggest(store: SuggestionStore, suggestions: readonly Suggestion[]): void {
  if (suggestions.length === 0) return;
  const state = store.get();
  const byPlace = { ...state.byPlace };
  for (const one of suggestions) byPlace[placeText(one)] = { ...byPlace[placeText(one)], [one.source]: one };
  store.set({ ...state, byPlace }, "server");
}

/** Take back what a source suggested for a hand, or everything it ever suggested. */
export function withdraw(store: SuggestionStore, source: Source, place?: PoseKey): void {
  const state = store.get();
  const wanted = place && keyText(place);
  const byPlace: Record<string, SuggestionsOfHand> = {};
  let isChanged = false;
  for (const [key, { [source]: gone, ...others }] of Object.entries(state.byPlace)) {
    const isMeant = gone !== undefined && (wanted === undefined || wanted === key);
    isChanged ||= isMeant;
    const kept = isMeant ? others : (state.byPlace[key] ?? {});
    if (Object.keys(kept).length > 0) byPlace[key] = kept;
  }
  if (isChanged) store.set({ ...state, byPlace }, "server");
}

export function setHidden(store: SuggestionStore, sources: readonly Source[]): void {
  store.set({ ...store.get(), hidden: new Set(sources) }, "person");
}

/** What can be accepted for a hand: 21, null where the person decided already or nothing is proposed. */
export const openJointsAt = (suggestions: SuggestionsState, annotator: AnnotatorState, place: PoseKey): (OpenJoint | null)[] =>
  openJoints(suggestions.byPlace[keyText(place)], annotator.poses[keyText(place)], suggestions.hidden);
