import { useEffect, useRef, useState } from "react";

/** Steps that wait at most, half a second of them; more are taken at once, or a slow picture would hold the person up. */
const MOST_WAITING = 15;

export interface SeenSteps {
  step(by: number): void;
  /** A picture was drawn for the next refresh of the screen: what waits for it may go on. */
  drawn(): void;
  /** Take what waits now, because something else is to happen after it. */
  flush(): void;
}

/**
 * Steps from frame to frame of which each is seen: one that comes before the last frame was drawn waits for that, so that two
 * key presses between two refreshes of the screen leave no frame out.
 */
export function useSeenSteps(go: (by: number) => void, isDrawn: () => boolean): SeenSteps {
  const current = useRef({ go, isDrawn });
  current.current = { go, isDrawn };
  const [steps] = useState(() => {
    let waiting: number[] = [];
    const flush = (): void => {
      const by = waiting.reduce((sum, one) => sum + one, 0);
      waiting = [];
      if (by !== 0) current.current.go(by);
    };
    return {
      flush,
      drawn(): void {
        const by = current.current.isDrawn() ? waiting.shift() : undefined;
        if (by !== undefined) current.current.go(by);
      },
      step(by: number): void {
        if (waiting.length === 0 && current.current.isDrawn()) return current.current.go(by);
        waiting.push(by);
        if (waiting.length > MOST_WAITING) flush();
      },
    };
  });
  useEffect(() => steps.flush, [steps]);
  return steps;
}
