import { useCallback, useEffect, useRef, useState } from "react";
import { isForGood, onNetworkBack, pauseAfter } from "../../canvas/patience";

interface Patience {
  /** Another one when it is time to ask again: later and later, and as soon as the network is back. */
  readonly round: number;
  failed: (failure: Error) => void;
  succeeded: () => void;
}

/** Asks again for what failed for a passing reason. */
export function usePatience(): Patience {
  const [round, setRound] = useState(0);
  const failures = useRef(0);
  const timer = useRef<ReturnType<typeof setTimeout>>(undefined);
  const again = useCallback((): void => {
    clearTimeout(timer.current);
    timer.current = undefined;
    setRound((now) => now + 1);
  }, []);
  useEffect(() => {
    const stop = onNetworkBack(() => failures.current > 0 && again());
    return () => {
      stop();
      clearTimeout(timer.current);
    };
  }, [again]);
  const failed = useCallback(
    (failure: Error): void => {
      if (isForGood(failure)) return;
      failures.current += 1;
      clearTimeout(timer.current);
      timer.current = setTimeout(again, pauseAfter(failures.current));
    },
    [again],
  );
  const succeeded = useCallback((): void => {
    failures.current = 0;
    clearTimeout(timer.current);
  }, []);
  return { round, failed, succeeded };
}
