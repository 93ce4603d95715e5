import { useEffect, useRef } from "react";

interface Steps {
  /** Whether what is shown now has been shown. */
  isReady: () => boolean;
  /** Goes on; says whether there is more to come. */
  step: () => boolean;
  /** The last frame was reached. */
  end: () => void;
}

/** Play at the recording's speed (at most 30 steps a second), in step with the screen. */
export function usePlayback(isPlaying: boolean, fps: number, steps: Steps): void {
  const current = useRef(steps);
  current.current = steps;
  useEffect(() => {
    if (!isPlaying) return;
    const period = 1000 / Math.min(30, Math.max(1, fps));
    let due = performance.now() + period;
    let request = requestAnimationFrame(function tick(now) {
      request = requestAnimationFrame(tick);
      if (now < due - 2 || !current.current.isReady()) return;
      // After waiting for a picture go on at the same speed instead of hurrying.
      due = Math.max(due, now - period) + period;
      if (!current.current.step()) current.current.end();
    });
    return () => cancelAnimationFrame(request);
  }, [isPlaying, fps]);
}
