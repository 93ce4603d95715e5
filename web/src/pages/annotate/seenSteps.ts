/** Steps that wait at most, half a second of them; more are taken at once, or a slow picture would hold the person up. */
const MOST_WAITING = 15;

export interface SeenSteps {
  step: (by: number) => void;
  /** Done once the last frame that was gone to is drawn; at once if it is. */
  whenDrawn: (act: () => void) => void;
  /** A picture was drawn for the next refresh of the screen: what waits for it may go on. */
  drawn: () => void;
  /** Take what waits now, because something else is to happen after it. */
  flush: () => void;
}

/**
 * Steps from frame to frame of which each is seen: one that comes before the last frame was drawn waits for that, so that two
 * key presses between two refreshes of the screen leave no frame out, and what is pressed behind them finds its picture.
 */
export function createSeenSteps(go: (by: number) => void, isDrawn: () => boolean): SeenSteps {
  let waiting: (number | (() => void))[] = [];
  const take = (one: number | (() => void)): void => (typeof one === "number" ? go(one) : one());
  const flush = (): void => {
    const all = waiting;
    waiting = [];
    all.forEach(take);
  };
  const put = (one: number | (() => void)): void => {
    if (waiting.length === 0 && isDrawn()) return take(one);
    waiting.push(one);
    if (waiting.length > MOST_WAITING) flush();
  };
  return {
    flush,
    drawn(): void {
      while (waiting.length > 0 && isDrawn()) take(waiting.shift() ?? 0);
    },
    step: put,
    whenDrawn: put,
  };
}
