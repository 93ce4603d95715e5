import { useEffect, useRef, useState } from "react";
import { fetchBitmap } from "../api/client";
import { createFrameCache } from "./frameCache";

const cache = createFrameCache<ImageBitmap>(fetchBitmap, {
  capacity: 96e6,
  weigh: (bitmap) => 4 * bitmap.width * bitmap.height,
  dispose: (bitmap) => bitmap.close(),
});

/** A rendered overlay; null while it is not here, because one of another frame would lie. */
export function useOverlay(address: string | null): { picture: ImageBitmap | null; failure: Error | null } {
  const [, setArrived] = useState<unknown>(null);
  const failed = useRef<{ address: string; error: Error } | null>(null);
  useEffect(() => {
    if (address === null) return;
    let isGone = false;
    cache.focus([address]).then(
      (picture) => !isGone && setArrived(picture),
      (error: Error) => {
        if (isGone || error.name === "AbortError") return;
        failed.current = { address, error };
        setArrived(error);
      },
    );
    return () => {
      isGone = true;
    };
  }, [address]);
  return {
    picture: address === null ? null : (cache.peek(address) ?? null),
    failure: failed.current && failed.current.address === address ? failed.current.error : null,
  };
}
