import { useEffect, useReducer } from "react";
import { fetchBitmap } from "../api/client";
import { createFrameCache } from "./frameCache";

const cache = createFrameCache<ImageBitmap>(fetchBitmap, {
  capacity: 96e6,
  weigh: (bitmap) => 4 * bitmap.width * bitmap.height,
  dispose: (bitmap) => bitmap.close(),
});

/** A rendered overlay; null while it is not here, because one of another frame would lie. */
export function useOverlay(address: string | null): { picture: ImageBitmap | null; failure: Error | null } {
  const [, wake] = useReducer((count: number) => count + 1, 0);
  useEffect(() => {
    if (address === null) return cache.leave("");
    const stop = cache.watch((one) => one === address && wake());
    cache.focus([address]);
    return stop;
  }, [address]);
  useEffect(() => () => cache.leave(""), []);
  return {
    picture: address === null ? null : (cache.peek(address) ?? null),
    failure: address === null ? null : (cache.setbackOf(address)?.error ?? null),
  };
}
