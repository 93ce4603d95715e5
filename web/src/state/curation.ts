/** Where a curator is in the queue, what they decided in this visit, and the way back. */

import type { QueueChoice, Registration } from "../api/registrations";
import type { DecisionLog, Standing } from "./decisionLog";
import { createStore, type Store } from "./store";

/** A decision of this visit, for the way back. */
interface Step {
  readonly registrationId: string;
  readonly operationId: string;
  readonly before: Standing | null;
}

export interface CurationState {
  readonly items: readonly Registration[];
  readonly place: number;
  /** Whether the server has more behind what is loaded. */
  readonly hasMore: boolean;
  /** What I decided, by registration; null was taken back. What is not in here is as the server says. */
  readonly mine: Readonly<Record<string, Standing | null>>;
  readonly steps: readonly Step[];
  /** When each decision of this visit was made, ms. */
  readonly times: readonly number[];
}

export interface Curation {
  /** Which registrations the queue asks for. */
  readonly choice: QueueChoice;
  readonly store: Store<CurationState>;
  decide: (decision: Standing, reasons?: readonly string[]) => void;
  /** Takes the last decision of this visit back; without one, what stands of mine about the registration shown. */
  undo: () => void;
  go: (by: number) => void;
  goTo: (registrationId: string) => void;
  /** More of the queue has come. */
  append: (items: readonly Registration[], hasMore: boolean) => void;
}

export const shownIn = (state: CurationState): Registration | null => state.items[state.place] ?? null;

export const decisionOf = (state: CurationState, item: Registration): Standing | null =>
  item.id in state.mine ? (state.mine[item.id] ?? null) : item.my_decision;

/** What is drawn now and what is likely drawn next, the most urgent first. */
export function soonShown({ items, place }: CurationState, ahead = 5, behind = 2): readonly Registration[] {
  const at = [place, ...Array.from({ length: ahead }, (_, step) => place + step + 1), ...Array.from({ length: behind }, (_, step) => place - step - 1)];
  return at.flatMap((one) => items[one] ?? []);
}

export function openCuration(log: DecisionLog, choice: QueueChoice, now: () => number = Date.now): Curation {
  // What still waits from an earlier visit stands already.
  const waiting: Record<string, Standing | null> = {};
  for (const one of log.waiting()) waiting[one.registrationId] = one.decision === "undo" ? null : one.decision;
  const store = createStore<CurationState>({ items: [], place: 0, hasMore: true, mine: waiting, steps: [], times: [] });
  let shownAt = now();

  function go(place: number): void {
    const state = store.get();
    // One beyond the last is the end of the queue.
    const next = Math.max(0, Math.min(state.items.length, place));
    if (next === state.place) return;
    shownAt = now();
    store.set({ ...state, place: next }, "person");
  }

  return {
    choice,
    store,
    decide(decision, reasons = []) {
      const state = store.get();
      const item = shownIn(state);
      if (!item) return;
      const time = now();
      const operationId = log.add({
        registrationId: item.id,
        name: item.scan.name,
        decision,
        reasons,
        seconds: Math.min(86_400, Math.max(0, (time - shownAt) / 1000)),
        undoes: null,
      });
      shownAt = time;
      store.set(
        {
          ...state,
          place: state.place + 1,
          mine: { ...state.mine, [item.id]: decision },
          steps: [...state.steps, { registrationId: item.id, operationId, before: decisionOf(state, item) }],
          times: [...state.times, time],
        },
        "person",
      );
    },
    undo() {
      const state = store.get();
      const step = state.steps.at(-1);
      if (step) {
        const place = state.items.findIndex((item) => item.id === step.registrationId);
        const item = state.items[place];
        log.add({ registrationId: step.registrationId, name: item?.scan.name ?? "", decision: "undo", reasons: [], seconds: null, undoes: { operationId: step.operationId } });
        shownAt = now();
        store.set(
          {
            ...state,
            place: place < 0 ? state.place : place,
            mine: { ...state.mine, [step.registrationId]: step.before },
            steps: state.steps.slice(0, -1),
            times: state.times.slice(0, -1),
          },
          "history",
        );
        return;
      }
      const item = shownIn(state);
      if (!item?.my_decision_id || decisionOf(state, item) === null) return;
      log.add({ registrationId: item.id, name: item.scan.name, decision: "undo", reasons: [], seconds: null, undoes: { decisionId: item.my_decision_id } });
      store.set({ ...state, mine: { ...state.mine, [item.id]: null } }, "history");
    },
    go: (by) => go(store.get().place + by),
    goTo(registrationId) {
      const place = store.get().items.findIndex((item) => item.id === registrationId);
      if (place >= 0) go(place);
    },
    append(items, hasMore) {
      const state = store.get();
      const known = new Set(state.items.map((item) => item.id));
      store.set({ ...state, items: [...state.items, ...items.filter((item) => !known.has(item.id))], hasMore }, "server");
    },
  };
}
