/**
 * Takes what others store into an open recording, without disturbing the person: the place stays, a drag goes on, and a
 * hand of which something of theirs waits keeps theirs until the server has answered (a conflict is then settled by choice).
 */

import type { Annotation } from "../api/types";
import { fromWire, kept, keyText, type PoseKey } from "../model/pose";
import { activeKey, type AnnotatorState } from "./annotator";
import type { SaveQueue } from "./saveQueue";
import type { Store } from "./store";

/** A hand as somebody stored it; points null when it was deleted. */
export type Label = Pick<Annotation, "camera" | "frame" | "hand" | "revision" | "author" | "sources"> & { readonly points: Annotation["points"] | null };

export interface Merging {
  hear: (label: Label) => void;
  /** The labels as they are now, all of them: what is not among them is gone, or not to be seen any more. */
  reload: (labels: readonly Label[]) => void;
  stop: () => void;
}

export function startMerging(store: Store<AnnotatorState>, queue: SaveQueue): Merging {
  /** Newest version of each hand that cannot be shown yet. */
  const held = new Map<string, Label>();

  const isDrawn = (key: string): boolean => store.get().draft !== null && keyText(activeKey(store.get())) === key;

  function hear(label: Label): void {
    const key = keyText(label);
    held.delete(key);
    const points = label.points && kept(label.points, label.sources);
    const heard = { points, revision: points ? label.revision : null, author: label.author, version: label.revision };
    const outcome = isDrawn(key) ? "busy" : queue.hear(key, heard);
    if (outcome === "busy") held.set(key, label);
    else if (outcome === "news") show(label, points && fromWire(points));
  }

  function show(place: PoseKey, pose: AnnotatorState["poses"][string] | null): void {
    const state = store.get();
    const { [keyText(place)]: before, ...others } = state.poses;
    if (!before && !pose) return;
    store.set({ ...state, poses: pose ? { ...others, [keyText(place)]: pose } : others }, "server");
  }

  const again = (): void => {
    // What is still busy is held anew.
    for (const label of [...held.values()]) hear(label);
  };
  const stops = [queue.watch(again), store.watch((now, before) => now.draft !== before.draft && again())];

  return {
    hear,
    reload(labels) {
      const there = new Set(labels.map(keyText));
      held.clear();
      for (const [key] of Object.entries(store.get().poses)) {
        if (there.has(key) || isDrawn(key) || !queue.forget(key)) continue;
        const { [key]: gone, ...poses } = store.get().poses;
        void gone;
        store.set({ ...store.get(), poses }, "server");
      }
      labels.forEach(hear);
    },
    stop: () => stops.forEach((stop) => stop()),
  };
}
