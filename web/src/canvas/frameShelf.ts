/** Frames that are played: the one that is shown and those behind it are fetched ahead, the farthest are put away. */

export interface FrameShelf<Frame> {
  /** Show this frame now, and others `step` apart behind it soon. */
  want: (frame: number, step: number) => void;
  /** Null while it is on its way. */
  get: (frame: number) => Frame | null;
  failureOf: (frame: number) => Error | null;
  /** Put away what is not as it would be fetched now; it is asked for again when it is wanted. */
  forget: (isOld: (frame: number, held: Frame) => boolean) => void;
  /** Ask again for what failed. */
  retry: () => void;
  /** Tells that a frame has come, or failed. */
  watch: (watcher: () => void) => () => void;
  stop: () => void;
}

const AT_ONCE = 3;
const AHEAD = 10;
const KEPT = 90;

/** `load` fetches a frame; `frames` are those that there are, in order. */
export function createFrameShelf<Frame>(load: (frame: number, signal: AbortSignal) => Promise<Frame>, frames: readonly number[]): FrameShelf<Frame> {
  const there = new Map<number, Frame>();
  const failures = new Map<number, Error>();
  const coming = new Map<number, AbortController>();
  const watchers = new Set<() => void>();
  let wanted: readonly number[] = [];
  let isStopped = false;

  function fill(): void {
    for (const frame of wanted) {
      if (coming.size >= AT_ONCE || isStopped) return;
      if (!there.has(frame) && !failures.has(frame) && !coming.has(frame)) void fetchOne(frame);
    }
  }

  async function fetchOne(frame: number): Promise<void> {
    const abort = new AbortController();
    coming.set(frame, abort);
    try {
      const found = await load(frame, abort.signal);
      if (coming.get(frame) === abort) there.set(frame, found);
    } catch (failure) {
      if (!abort.signal.aborted) failures.set(frame, failure instanceof Error ? failure : new Error(String(failure)));
    }
    if (coming.get(frame) !== abort || isStopped) return;
    coming.delete(frame);
    watchers.forEach((watcher) => watcher());
    fill();
  }

  function putAway(frame: number): void {
    for (const [other, abort] of coming) {
      if (wanted.includes(other)) continue;
      abort.abort();
      coming.delete(other);
    }
    const farthest = [...there.keys()].sort((a, b) => Math.abs(b - frame) - Math.abs(a - frame));
    for (const other of farthest.slice(0, Math.max(0, there.size - KEPT))) there.delete(other);
  }

  return {
    want(frame, step) {
      const at = frames.indexOf(frame);
      if (at < 0) return;
      wanted = Array.from({ length: AHEAD + 1 }, (_, number) => frames[at + number * step]).filter((one) => one !== undefined);
      putAway(frame);
      fill();
    },
    get: (frame) => there.get(frame) ?? null,
    failureOf: (frame) => failures.get(frame) ?? null,
    forget(isOld) {
      for (const [frame, held] of [...there]) if (isOld(frame, held)) there.delete(frame);
      fill();
    },
    retry() {
      failures.clear();
      fill();
    },
    watch(watcher) {
      watchers.add(watcher);
      return () => watchers.delete(watcher);
    },
    stop() {
      isStopped = true;
      for (const abort of coming.values()) abort.abort();
      there.clear();
      watchers.clear();
    },
  };
}
