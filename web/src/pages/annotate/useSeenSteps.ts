import { useEffect, useRef, useState } from "react";

/** Steps that wait at most, half a second of them; more are taken at once, or a slow picture would hold the person up. */
const MOST_WAITING = 15;

export interface SeenSteps {
  step(by: number): void;
  /** Take what waits now, because something else is to happen after it. */
  flush(): void;
}

/**
 * Steps from frame to frame of which each is seen: one that comes before the last frame was drawn waits for that, so that two
 * key presses between two refreshes of the screen leave no frame out.
 */
export function useSeenSteps(go: (by: number) => void, isSeen: () => boolean): SeenSteps {
  const current = useRef({ go, isSeen });
  current.current = { go, isSeen };
  const [steps] = useState(() => {
    let waiting: number[] = [];
    let request = 0;
    const flush = (): void => {
      cancelAnimationFrame(request);
      const by = waiting.reduce((sum, one) => sum + one, 0);
      waiting = [];
      if (by !== 0) current.current.go(by);
    };
    const tick = (): void => {
      if (current.current.isSeen()) {
        const by = waiting.shift();
        if (by !== undefined) current.current.go(by);
      }
      if (waiting.length > 0) request = requestAnimationFrame(tick);
    };
    return {
      flush,
      step(by: number) {
        if (waiting.length === 0 && current.current.isSeen()) return current.current.go(by);
        waiting.push(by);
        if (waiting.length > MOST_WAITING) return flush();
        if (waiting.length === 1) request = requestAnimationFrame(tick);
      },
    };
  });
  useEffect(() => steps.flush, [steps]);
  return steps;
}
