import { useEffect, useReducer } from "react";
import { fetchBitmap } from "../api/client";
import { createFrameCache } from "./frameCache";

const createOverlayCache = () =>
  createFrameCache<ImageBitmap>(fetchBitmap, {
    capacity: 96e6,
    weigh: (bitmap) => 4 * bitmap.width * bitmap.height,
    dispose: (bitmap) => bitmap.close(),
  });

/** Each kind has its own: what one asks for is not dropped for the other. */
const caches = { mesh: createOverlayCache(), unknown: createOverlayCache() };

/** A rendered overlay; null while it is not here, because one of another frame would lie. */
export function useOverlay(kind: keyof typeof caches, address: string | null): { picture: ImageBitmap | null; failure: Error | null } {
  const cache = caches[kind];
  const [, wake] = useReducer((count: number) => count + 1, 0);
  useEffect(() => {
    if (address === null) return cache.leave("");
    const stop = cache.watch((one) => one === address && wake());
    cache.focus([address]);
    return stop;
  }, [cache, address]);
  useEffect(() => () => cache.leave(""), [cache]);
  return {
    picture: address === null ? null : (cache.peek(address) ?? null),
    failure: address === null ? null : (cache.setbackOf(address)?.error ?? null),
  };
}
