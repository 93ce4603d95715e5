import { useEffect, useId, useMemo, useRef, useState } from "react";
import { fetchBitmap, fetchBytes } from "../api/client";
import { colorUrl, depthUrl } from "../api/recordings";
import type { Camera, Recording } from "../api/types";
import { findRange, paintDepth, readDepth, type DepthImage, type DepthRange, type Palette } from "./depth";
import { aheadFor, createFrameCache, framesToLoad, travelOn, type FrameCache, type Travel } from "./frameCache";

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

interface Loaded<T> {
  picture: T | null;
  /** The frame that it is of. */
  frame: number | null;
  /** What is shown belongs to another frame, because the wanted one is still on its way. */
  isStale: boolean;
  failure: Error | null;
}

/** The picture of one address, the neighbours on their way; the last one stays until the next is here. */
function useCached<T>(cache: FrameCache<T>, addresses: readonly string[], frame: number): Loaded<T> {
  const [first] = addresses;
  const viewer = useId();
  const shown = useRef<{ address: string; frame: number; picture: T } | null>(null);
  const [, setArrived] = useState<unknown>(null);
  const [failure, setFailure] = useState<{ address: string; error: Error } | null>(null);
  const here = first === undefined ? undefined : cache.peek(first);
  if (first !== undefined && here !== undefined) shown.current = { address: first, frame, picture: here };
  const list = addresses.join("\n");

  useEffect(() => {
    if (!list) return cache.leave(viewer);
    const wanted = list.split("\n");
    let isGone = false;
    cache.focus(wanted, viewer).then(
      (picture) => !isGone && setArrived(picture),
      (error: Error) => !isGone && error.name !== "AbortError" && setFailure({ address: wanted[0] ?? "", error }),
    );
    return () => {
      isGone = true;
    };
  }, [cache, list, viewer]);
  useEffect(() => () => cache.leave(viewer), [cache, viewer]);

  const picture = first === undefined ? null : (shown.current?.picture ?? null);
  return {
    picture,
    frame: picture === null ? null : (shown.current?.frame ?? null),
    isStale: picture !== null && shown.current?.address !== first,
    failure: failure && failure.address === first && here === undefined ? failure.error : null,
  };
}

export interface Pictures {
  color: Picture | null;
  depth: Picture | null;
  depthImage: DepthImage | null;
  range: DepthRange | null;
  /** The frame that is shown: another one than the wanted one while that is still on its way. */
  shownFrame: number | null;
  isStale: boolean;
  failure: Error | null;
}

interface Wanted {
  color: boolean;
  depth: boolean;
  /** Depth is not only looked up but seen. */
  isDepthSeen?: boolean;
  palette?: Palette;
}

/**
 * Colour and depth of one frame of one camera. `range` null chooses one from the first depth image seen; at most `most`
 * frames are loaded in the direction of travel.
 */
export function usePictures(recording: Recording, camera: Camera, frame: number, wanted: Wanted, range: DepthRange | null, most = 30): Pictures {
  const travel = useRef<Travel>({ frame, direction: 1, run: 0 });
  travel.current = travelOn(travel.current, frame);
  const { direction } = travel.current;
  const ahead = Math.min(most, aheadFor(travel.current, 4 * camera.width * camera.height));

  const frames = useMemo(() => framesToLoad(frame, direction, recording.frame_count, ahead), [frame, direction, recording.frame_count, ahead]);
  const colors = wanted.color && camera.has_color ? frames.map((index) => colorUrl(recording, camera.id, index)) : [];
  const depths = wanted.depth && camera.has_depth ? frames.map((index) => depthUrl(recording, camera.id, index)) : [];
  const color = useCached(colorCache, colors, frame);
  const depth = useCached(depthCache, depths, frame);

  const found = useRef<{ key: string; range: DepthRange } | null>(null);
  const key = `${recording.id}/${camera.id}`;
  if (depth.picture && found.current?.key !== key) found.current = { key, range: findRange(depth.picture) };
  const usedRange = range ?? (found.current?.key === key ? found.current.range : null);
  const isDepthSeen = wanted.isDepthSeen ?? wanted.depth;
  const painted = useMemo(
    () => (isDepthSeen && depth.picture && usedRange ? paintDepth(depth.picture, usedRange, wanted.palette ?? "warm") : null),
    [depth.picture, usedRange?.near, usedRange?.far, wanted.palette, isDepthSeen],
  );

  return {
    color: color.picture,
    depth: painted,
    depthImage: depth.isStale ? null : depth.picture,
    range: usedRange,
    shownFrame: wanted.color && camera.has_color ? color.frame : depth.frame,
    isStale: color.isStale || (isDepthSeen && depth.isStale),
    failure: color.failure ?? depth.failure,
  };
}
