import { useEffect, useMemo, useRef, useState, useSyncExternalStore } from "react";
import { fetchQueue, type QueueChoice, type Registration } from "../../api/registrations";
import { request } from "../../api/client";
import { openCuration, type Curation, type CurationState } from "../../state/curation";
import { decisionLog } from "../../state/deciding";
import type { DecisionStatus } from "../../state/decisionLog";
import { useStore } from "../../state/useStore";

/** More is asked for when no more than this is left behind the one shown. */
const RESERVE = 12;

interface Opened {
  readonly curation: Curation;
  readonly state: CurationState;
  /** True until the first page of the queue has come. */
  readonly isLoading: boolean;
  readonly failure: Error | null;
  readonly retry: () => void;
}

/** A queue that fills itself; `first` stands before it. */
export function useCuration(choice: QueueChoice, first: string | null): Opened {
  // Another queue is another visit; where one starts is asked only once.
  const start = useRef(first);
  const curation = useMemo(() => openCuration(decisionLog(), choice), [choice]);
  const state = useStore(curation.store);
  const [failure, setFailure] = useState<Error | null>(null);
  const [attempt, setAttempt] = useState(0);
  const cursor = useRef<{ of: Curation; next: string | null }>({ of: curation, next: null });
  const busy = useRef<Curation | null>(null);
  const isShort = state.hasMore && state.items.length - state.place < RESERVE;

  useEffect(() => {
    if (!isShort || busy.current === curation) return;
    if (cursor.current.of !== curation) cursor.current = { of: curation, next: null };
    busy.current = curation;
    const load = async (): Promise<void> => {
      const wanted = start.current;
      start.current = null;
      const before: Registration[] = wanted ? await request<Registration>("GET", `/registrations/${wanted}`).then((one) => [one], () => []) : [];
      const page = await fetchQueue(curation.choice, cursor.current.next);
      if (busy.current !== curation) return;
      cursor.current = { of: curation, next: page.next_cursor };
      busy.current = null;
      setFailure(null);
      curation.append([...before, ...page.items], page.next_cursor !== null);
    };
    load().catch((reason: Error) => {
      if (busy.current !== curation) return;
      busy.current = null;
      setFailure(reason);
    });
  }, [curation, isShort, state.items.length, attempt]);

  return { curation, state, isLoading: state.items.length === 0 && state.hasMore, failure, retry: () => setAttempt((count) => count + 1) };
}

export function useDecisionStatus(): DecisionStatus {
  const log = decisionLog();
  return useSyncExternalStore(log.watch, log.status);
}
