import { useEffect, useId, useMemo, useRef, useState } from "react";
import { fetchBitmap, fetchBytes } from "../api/client";
import { colorUrl, depthUrl } from "../api/recordings";
import type { Camera, Recording } from "../api/types";
import { findRange, paintDepth, readDepth, type DepthImage, type DepthRange, type Palette } from "./depth";
import { createFrameCache, framesToLoad, type FrameCache } from "./frameCache";

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
  /** What is shown belongs to another frame, because the wanted one is still on its way. */
  isStale: boolean;
  failure: Error | null;
}

/** The picture of one address, the neighbours on their way; the last one stays until the next is here. */
function useCached<T>(cache: FrameCache<T>, addresses: readonly string[]): Loaded<T> {
  const [first] = addresses;
  const viewer = useId();
  const shown = useRef<{ address: string; picture: T } | null>(null);
  const [, setArrived] = useState<unknown>(null);
  const [failure, setFailure] = useState<{ address: string; error: Error } | null>(null);
  const here = first === undefined ? undefined : cache.peek(first);
  if (first !== undefined && here !== undefined) shown.current = { address: first, picture: here };
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
    isStale: picture !== null && shown.current?.address !== first,
    failure: failure && failure.address === first && here === undefined ? failure.error : null,
  };
}

export interface Pictures {
  color: Picture | null;
  depth: Picture | null;
  depthImage: DepthImage | null;
  range: DepthRange | null;
  isStale: boolean;
  failure: Error | null;
}

interface Wanted {
  color: boolean;
  depth: boolean;
  palette?: Palette;
}

/**
 * Colour and depth of one frame of one camera. `range` null chooses one from the first depth image seen; `ahead` frames
 * are loaded in the direction of travel.
 */
export function usePictures(recording: Recording, camera: Camera, frame: number, wanted: Wanted, range: DepthRange | null, ahead = 8): Pictures {
  const travel = useRef<{ frame: number; direction: 1 | -1 }>({ frame, direction: 1 });
  if (travel.current.frame !== frame) travel.current = { frame, direction: frame > travel.current.frame ? 1 : -1 };
  const { direction } = travel.current;

  const frames = useMemo(() => framesToLoad(frame, direction, recording.frame_count, ahead), [frame, direction, recording.frame_count, ahead]);
  const colors = wanted.color && camera.has_color ? frames.map((index) => colorUrl(recording, camera.id, index)) : [];
  const depths = wanted.depth && camera.has_depth ? frames.map((index) => depthUrl(recording, camera.id, index)) : [];
  const color = useCached(colorCache, colors);
  const depth = useCached(depthCache, depths);

  const found = useRef<{ key: string; range: DepthRange } | null>(null);
  const key = `${recording.id}/${camera.id}`;
  if (depth.picture && found.current?.key !== key) found.current = { key, range: findRange(depth.picture) };
  const usedRange = range ?? (found.current?.key === key ? found.current.range : null);
  const painted = useMemo(
    () => (depth.picture && usedRange ? paintDepth(depth.picture, usedRange, wanted.palette ?? "warm") : null),
    [depth.picture, usedRange?.near, usedRange?.far, wanted.palette],
  );

  return {
    color: color.picture,
    depth: painted,
    depthImage: depth.isStale ? null : depth.picture,
    range: usedRange,
    isStale: color.isStale || depth.isStale,
    failure: color.failure ?? depth.failure,
  };
}
