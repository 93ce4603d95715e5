/** Keeps the proposals between key frames up to date: watches the annotations and the key frames; nobody else knows of it. */

import { HANDS } from "../model/joints";
import { between, keyFramesOf } from "../model/interpolation";
import { keyText, type Pose } from "../model/pose";
import type { Suggestion } from "../model/suggestion";
import type { AnnotatorState } from "./annotator";
import type { KeyFrames } from "./keyFrames";
import type { Store } from "./store";
import { suggest, withdraw, type SuggestionStore } from "./suggestions";

export function startInterpolation(annotator: Store<AnnotatorState>, keys: Store<KeyFrames>, suggestions: SuggestionStore, cameras: readonly string[]): () => void {
  /** The spans that were proposed, with the poses at their ends. */
  let proposed = new Map<string, readonly [Pose, Pose]>();

  const update = (): void => {
    const { poses } = annotator.get();
    const spans = new Map<string, readonly [Pose, Pose]>();
    const made: (() => Suggestion[])[] = [];
    for (const hand of cameras.flatMap((camera) => HANDS.map((side) => ({ camera, hand: side })))) {
      const frames = keyFramesOf(keys.get(), poses, hand);
      frames.slice(1).forEach((to, index) => {
        const from = frames[index] ?? to;
        const [a, b] = [poses[keyText({ ...hand, frame: from })], poses[keyText({ ...hand, frame: to })]];
        if (!a || !b) return;
        spans.set(keyText({ ...hand, frame: from }), [a, b]);
        made.push(() => between(poses, hand, [from, to]));
      });
    }
    const isSame = spans.size === proposed.size && [...spans].every(([name, [a, b]]) => proposed.get(name)?.[0] === a && proposed.get(name)?.[1] === b);
    if (isSame) return;
    proposed = spans;
    withdraw(suggestions, "interpolation");
    suggest(suggestions, made.flatMap((make) => make()));
  };

  update();
  const stops = [
    annotator.watch((now, before) => {
      if (now.poses !== before.poses && keys.get().size > 1) update();
    }),
    keys.watch(update),
  ];
  return () => stops.forEach((stop) => stop());
}
