import { useEffect, useRef, useState } from "react";

/** Play at the recording's speed (at most 30 steps a second); `step` says whether there is more to come. */
export function usePlayback(fps: number, step: () => boolean): [boolean, (isPlaying: boolean) => void] {
  const [isPlaying, setPlaying] = useState(false);
  const current = useRef(step);
  current.current = step;
  useEffect(() => {
    if (!isPlaying) return;
    const timer = setInterval(() => {
      if (!current.current()) setPlaying(false);
    }, 1000 / Math.min(30, Math.max(1, fps)));
    return () => clearInterval(timer);
  }, [isPlaying, fps]);
  return [isPlaying, setPlaying];
}
