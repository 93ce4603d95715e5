import { useCallback, useEffect, useId, useMemo, useReducer, useRef } from "react";
import { fetchBitmap, fetchBytes } from "../api/client";
import { colorUrl, depthUrl } from "../api/recordings";
import type { Camera, Recording } from "../api/types";
import { findRange, paintDepth, readDepth, type DepthImage, type DepthRange, type Palette } from "./depth";
import { aheadFor, createFrameCache, framesToLoad, travelOn, type FrameCache, type Setback, type Travel } from "./frameCache";

const MEGABYTE = 1e6;

const colorCache = createFrameCache<ImageBitmap>(fetchBitmap, {
  capacity: 256 * MEGABYTE,
  weigh: (bitmap) => 4 * bitmap.width * bitmap.height,
  dispose: (bitmap) => bitmap.close(),
});
const depthCache = createFrameCache<DepthImage>(
  async (address, signal) => {
    const { data, headers } = await fetchBytes(address, signal);
    return readDepth(data, headers);
  },
  { capacity: 64 * MEGABYTE, weigh: (image) => image.raw.byteLength },
);

export type Picture = ImageBitmap | HTMLCanvasElement;

interface Wanted<T> {
  /** The picture that is wanted, once it is here. */
  picture: T | undefined;
  setback: Setback | null;
}

/** The picture of the first address, the neighbours on their way. */
function useCached<T>(cache: FrameCache<T>, addresses: readonly string[]): Wanted<T> {
  const [first] = addresses;
  const viewer = useId();
  const [, wake] = useReducer((count: number) => count + 1, 0);
  const picture = first === undefined ? undefined : cache.peek(first);
  const list = addresses.join("\n");

  useEffect(() => {
    if (!list) return cache.leave(viewer);
    const wanted = list.split("\n");
    const stop = cache.watch((address) => address === wanted[0] && wake());
    cache.focus(wanted, viewer);
    return stop;
  }, [cache, list, viewer]);
  useEffect(() => () => cache.leave(viewer), [cache, viewer]);
  useEffect(() => {
    // What came between drawing and watching.
    if (first !== undefined && picture === undefined && cache.peek(first) !== undefined) wake();
  });

  return { picture, setback: first === undefined || picture !== undefined ? null : cache.setbackOf(first) };
}

export interface Pictures {
  color: Picture | null;
  depth: Picture | null;
  depthImage: DepthImage | null;
  range: DepthRange | null;
  /** The frame that is shown, in colour and depth alike: another one than the wanted one while that is still on its way. */
  shownFrame: number | null;
  isStale: boolean;
  /** Why a picture of the wanted frame is not here. */
  setback: Setback | null;
  /** Ask again at once. */
  retry: () => void;
}

interface Kinds {
  color: boolean;
  depth: boolean;
  palette?: Palette;
}

interface Shown {
  /** Of which recording and camera. */
  of: string;
  frame: number;
  color: ImageBitmap | undefined;
  depth: DepthImage | undefined;
}

/**
 * Colour and depth of one frame of one camera; the last frame stays until all that is wanted of the next one is here, so that
 * both are always of the same one. `range` null chooses one from the first depth image seen; at most `most` frames are loaded
 * in the direction of travel.
 */
export function usePictures(recording: Recording, camera: Camera, frame: number, wanted: Kinds, range: DepthRange | null, most = 30): Pictures {
  const travel = useRef<Travel>({ frame, direction: 1, run: -1 });
  travel.current = travelOn(travel.current, frame);
  const { direction } = travel.current;
  const ahead = Math.min(most, aheadFor(travel.current, 4 * camera.width * camera.height));

  const frames = useMemo(() => framesToLoad(frame, direction, recording.frame_count, ahead), [frame, direction, recording.frame_count, ahead]);
  const colors = wanted.color && camera.has_color ? frames.map((index) => colorUrl(recording, camera.id, index)) : [];
  const depths = wanted.depth && camera.has_depth ? frames.map((index) => depthUrl(recording, camera.id, index)) : [];
  const color = useCached(colorCache, colors);
  const depth = useCached(depthCache, depths);

  const of = `${recording.id}/${camera.id}`;
  const shown = useRef<Shown | null>(null);
  if (shown.current?.of !== of) shown.current = null;
  const isSettled = (list: readonly string[], { picture, setback }: Wanted<unknown>): boolean => list.length === 0 || picture !== undefined || setback?.isForGood === true;
  // Of what is wanted, all is here, or will never be; or it is the same frame, of which more is shown as it comes.
  if ((isSettled(colors, color) && isSettled(depths, depth)) || shown.current?.frame === frame) {
    shown.current = { of, frame, color: color.picture, depth: depth.picture };
  }
  const now = shown.current;

  const found = useRef<{ of: string; range: DepthRange } | null>(null);
  if (now?.depth && found.current?.of !== of) found.current = { of, range: findRange(now.depth) };
  const usedRange = range ?? (found.current?.of === of ? found.current.range : null);

  const [firstColor, firstDepth] = [colors[0], depths[0]];
  const retry = useCallback(() => {
    if (firstColor !== undefined && colorCache.setbackOf(firstColor)) colorCache.retry(firstColor);
    if (firstDepth !== undefined && depthCache.setbackOf(firstDepth)) depthCache.retry(firstDepth);
  }, [firstColor, firstDepth]);

  const [shownColor, shownDepth, shownFrame] = [now?.color ?? null, now?.depth ?? null, now?.frame ?? null];
  const palette = wanted.palette ?? "warm";
  const painted = useMemo(() => (shownDepth && usedRange ? paintDepth(shownDepth, usedRange, palette) : null), [shownDepth, usedRange, palette]);
  const setback = color.setback ?? depth.setback;
  const isStale = shownFrame !== frame;
  return useMemo(
    () => ({ color: shownColor, depth: painted, depthImage: shownDepth, range: usedRange, shownFrame, isStale, setback, retry }),
    [shownColor, painted, shownDepth, usedRange, shownFrame, isStale, setback, retry],
  );
}
