/** What waits in this browser beside what the page itself is saving: in other recordings, in other tabs, of other people. */

import { useMemo, useSyncExternalStore } from "react";
import { decisionLog } from "./deciding";
import { DECISIONS } from "./decisionLog";
import { UNSAVED } from "./journal";
import { accountId, nameOf } from "./me";
import { allQueues, watchQueues } from "./saving";

export interface Elsewhere {
  /** Of this person: gestures and decisions that the page's own status does not count. */
  readonly mine: number;
  /** A recording where some of them wait, if it is known. */
  readonly recording: string | null;
  /** Cropped in this tab and not saved. */
  readonly crops: number;
  readonly others: readonly { readonly name: string; readonly count: number }[];
}

/** What a page counts itself: a save queue's scope with its key frames, or the decisions. */
export type Own = { readonly scope: string } | "decisions";

/** Where strokes on scans wait in this tab until they are saved; each person's own. */
export const cropKey = (scan: string): string => `handloom/crop/${accountId()}/${scan}`;

/** What the hook that keeps a draft writes for "none" as soon as a scan is opened. */
const NO_DRAFT = JSON.stringify(null);

const namesIn = (storage: Storage, prefix: string): string[] =>
  Array.from({ length: storage.length }, (_, at) => storage.key(at) ?? "").filter((name) => name.startsWith(prefix));

export function findElsewhere(storages: { local: Storage; session: Storage }, account: string, queues: ReturnType<typeof allQueues>, own: Own): Elsewhere {
  const isOwn = (scope: string): boolean => own !== "decisions" && (scope === own.scope || scope.startsWith(`${own.scope}+`));
  const waiting = new Set<string>();
  const counted = new Set<string>();
  for (const [scope, queue] of queues) {
    for (const key of queue.waiting().keys()) (isOwn(scope) ? counted : waiting).add(`${scope}/${key}`);
  }
  const others = new Map<string, number>();
  for (const prefix of [UNSAVED, DECISIONS]) {
    for (const name of namesIn(storages.local, prefix)) {
      const [owner = "", ...rest] = name.slice(prefix.length).split("/");
      const place = rest.join("/");
      if (owner !== account) others.set(owner, (others.get(owner) ?? 0) + 1);
      else if (prefix === DECISIONS ? own !== "decisions" : !counted.has(place)) waiting.add(place);
    }
  }
  const recordings = [...waiting].filter((place) => place.includes("|")).map((place) => place.split(/[/~+]/)[0] ?? "");
  return {
    mine: waiting.size,
    recording: recordings[0] ?? null,
    crops: namesIn(storages.session, `handloom/crop/${account}/`).filter((name) => storages.session.getItem(name) !== NO_DRAFT).length,
    others: [...others].map(([owner, count]) => ({ name: nameOf(owner), count })),
  };
}

export function useElsewhere(own: Own): Elsewhere {
  const scope = own === "decisions" ? null : own.scope;
  const source = useMemo(() => {
    let text = "";
    let found: Elsewhere | null = null;
    const get = (): Elsewhere => {
      const next = findElsewhere({ local: window.localStorage, session: window.sessionStorage }, accountId(), allQueues(), scope === null ? "decisions" : { scope });
      const nextText = JSON.stringify(next);
      if (!found || nextText !== text) [text, found] = [nextText, next];
      return found;
    };
    const watch = (tell: () => void): (() => void) => {
      const stops = [watchQueues(tell), decisionLog().watch(tell)];
      // Another tab of this browser writes into the same storage.
      window.addEventListener("storage", tell);
      return () => {
        stops.forEach((stop) => stop());
        window.removeEventListener("storage", tell);
      };
    };
    return { get, watch };
  }, [scope]);
  return useSyncExternalStore(source.watch, source.get);
}
