import { useMemo } from "react";
import { useRegisteredFrames, type FrameRegistration, type MovingRegistration } from "../../api/movingScans";

export interface Chain {
  /** Frames of the registration itself, in order. */
  readonly own: readonly FrameRegistration[];
  /** Of each frame, the registration that is shown: before one goes on from another, that other. */
  readonly shown: ReadonlyMap<number, string>;
  readonly found: ReadonlyMap<number, FrameRegistration>;
}

/** A registration with those that it goes on from, so that its beginning is seen to follow. */
export function useChain(scan: string, registration: MovingRegistration | undefined, all: readonly MovingRegistration[], isGrowing: boolean): Chain {
  const ids = useMemo(() => {
    const chain: string[] = [];
    for (let at = registration; at && !chain.includes(at.id); ) {
      chain.push(at.id);
      const { parent_id } = at;
      at = all.find((one) => one.id === parent_id);
    }
    return chain;
  }, [registration, all]);
  const lists = useRegisteredFrames(scan, ids, isGrowing);
  const first = registration?.first_frame ?? 0;
  return useMemo(() => {
    const shown = new Map<number, string>();
    const found = new Map<number, FrameRegistration>();
    lists.forEach((frames, at) => {
      const id = ids[at];
      for (const one of frames) {
        if (id === undefined || shown.has(one.frame) || (at > 0 && one.frame >= first)) continue;
        shown.set(one.frame, id);
        found.set(one.frame, one);
      }
    });
    return { own: lists[0] ?? [], shown, found };
  }, [lists, ids, first]);
}
