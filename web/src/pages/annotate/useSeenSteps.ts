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
    // Drawn, and the screen has been refreshed since: being drawn alone does not make it seen.
    let isSettled = true;
    const go = (by: number): void => {
      isSettled = false;
      cancelAnimationFrame(request);
      request = requestAnimationFrame(tick);
      current.current.go(by);
    };
    const tick = (): void => {
      request = requestAnimationFrame(tick);
      if (!current.current.isSeen()) return;
      const by = waiting.shift();
      if (by !== undefined) return go(by);
      isSettled = true;
      cancelAnimationFrame(request);
    };
    const flush = (): void => {
      const by = waiting.reduce((sum, one) => sum + one, 0);
      waiting = [];
      if (by !== 0) go(by);
    };
    return {
      flush,
      step(by: number) {
        if (waiting.length === 0 && isSettled && current.current.isSeen()) return go(by);
        waiting.push(by);
        if (waiting.length > MOST_WAITING) flush();
        else if (isSettled) {
          isSettled = false;
          request = requestAnimationFrame(tick);
        }
      },
      stop(): void {
        flush();
        cancelAnimationFrame(request);
      },
    };
  });
  useEffect(() => steps.stop, [steps]);
  return steps;
}
