import { useEffect, useMemo, useReducer, useRef, type RefObject } from "react";
import { useBodyFaces } from "../../api/bodies";
import { fetchFrame, type FrameGeometry, type MovingScan } from "../../api/movingScans";
import { createFrameShelf } from "../../canvas/frameShelf";
import type { Box, Surface } from "../../canvas/hand3d/geometry";
import type { Stage } from "../../canvas/hand3d/stage";
import type { Staged } from "../../canvas/hand3d/staged";
import { standingUp } from "../../model/standing";

/** About how far the points of a person lie apart that the browser draws, m. */
const SPACING = 0.007;

export interface ShownFrame {
  readonly isDrawn: boolean;
  readonly failure: Error | null;
  retry: () => void;
}

/** All that the eye is to see while a person moves. */
function boxOfScan({ box_m: [low, high] }: MovingScan): Box {
  const [from, to] = [low ?? [0, 0, 0], high ?? [0, 0, 0]];
  const centre = [0, 1, 2].map((axis) => ((from[axis] ?? 0) + (to[axis] ?? 0)) / 2) as [number, number, number];
  return { centre, radius: Math.hypot(...[0, 1, 2].map((axis) => ((to[axis] ?? 0) - (from[axis] ?? 0)) / 2)) };
}

/** A body without extent, for a view whose first frame has none. */
function emptyBody(faces: Uint32Array): Surface {
  const count = faces.reduce((most, vertex) => Math.max(most, vertex), 0) + 1;
  return { positions: new Float32Array(3 * count), normals: new Int8Array(3 * count), colors: new Uint8Array(3 * count), index: faces, errorMm: null, taken: null };
}

/** Draws a frame of a moving scan, with the body that was laid onto it where there is one; frames behind it are fetched ahead. */
export function useShownFrame(
  stage: Stage | null,
  scan: MovingScan,
  /** Of each frame that has a body, the registration whose it is. */
  bodies: ReadonlyMap<number, string>,
  frame: number,
  step: number,
  drawn: RefObject<string>,
): ShownFrame {
  const [, redraw] = useReducer((count: number) => count + 1, 0);
  const { data: faces, error: facesError } = useBodyFaces();
  const staged = useRef<Staged | null>(null);
  const shown = useRef<FrameGeometry | null>(null);
  const bodiesNow = useRef(bodies);
  bodiesNow.current = bodies;
  const { id, frame_count, problems } = scan;
  const missing = problems.map((problem) => problem.frame).join();

  const shelf = useMemo(() => {
    if (!faces) return null;
    const lost = new Set(missing === "" ? [] : missing.split(",").map(Number));
    const frames = Array.from({ length: frame_count }, (_, at) => at).filter((at) => !lost.has(at));
    const load = (at: number, signal: AbortSignal): Promise<FrameGeometry> => fetchFrame(id, at, bodiesNow.current.get(at) ?? null, faces, signal);
    return createFrameShelf(load, frames);
  }, [id, faces, frame_count, missing]);

  // What was fetched without its body, or with another registration's, is fetched again.
  useEffect(() => shelf?.forget((at, held) => held.registration !== (bodies.get(at) ?? null)), [shelf, bodies]);
  useEffect(() => {
    if (!shelf) return;
    const unwatch = shelf.watch(redraw);
    return () => {
      unwatch();
      shelf.stop();
    };
  }, [shelf]);
  useEffect(() => shelf?.want(frame, step), [shelf, frame, step]);

  const geometry = shelf?.get(frame) ?? null;
  const failure = shelf?.failureOf(frame) ?? facesError;
  const isUnusable = problems.some((problem) => problem.frame === frame);

  useEffect(() => {
    if (!stage || !faces) return;
    if (isUnusable) {
      drawn.current = "";
      stage.show(null);
      shown.current = null;
      return;
    }
    if (!geometry || shown.current === geometry) return;
    drawn.current = `${frame}`;
    if (staged.current) {
      staged.current.renew(geometry.scan, geometry.mesh);
      if (shown.current === null) stage.show(staged.current);
      else stage.refresh();
    } else {
      const mesh = geometry.mesh ?? emptyBody(faces);
      staged.current = stage.prepare({ scan: geometry.scan, mesh, side: null, upright: standingUp(geometry.scan.positions), box: boxOfScan(scan), spacing: SPACING });
      if (!geometry.mesh) staged.current.renew(geometry.scan, null);
      stage.show(staged.current);
    }
    shown.current = geometry;
  }, [stage, faces, geometry, isUnusable, frame, scan, drawn]);
  useEffect(
    () => () => {
      staged.current?.release();
      staged.current = null;
      shown.current = null;
    },
    [stage, id],
  );
  return { isDrawn: geometry !== null || isUnusable, failure, retry: () => shelf?.retry() };
}
