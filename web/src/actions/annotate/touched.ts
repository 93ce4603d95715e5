import { parseKey } from "../../model/pose";
import { changedKeys, type AnnotatorState } from "../../state/annotator";

/**
 * The cameras whose pictures of the frame one is at must be seen for a change of labels: the one it was made in, and every other
 * one whose labels of this frame it changes. None when no label changes.
 */
export function camerasTouched(before: AnnotatorState, next: AnnotatorState): ReadonlySet<string> {
  const keys = changedKeys(next.poses, before.poses);
  const isDrag = next.draft !== null && next.draft !== before.draft;
  if (keys.length === 0 && !isDrag) return new Set();
  const places = keys.map(parseKey).filter(({ frame }) => frame === before.frame);
  return new Set([before.camera, ...places.map(({ camera }) => camera)]);
}
