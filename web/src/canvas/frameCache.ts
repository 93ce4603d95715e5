/** Decoded pictures by address: the one wanted now, those in the direction of travel, and the last ones used. */

import { isForGood, onNetworkBack, pauseAfter } from "./patience";

/** Why a picture is not here. */
export interface Setback {
  readonly error: Error;
  /** Nobody asks again by itself. */
  readonly isForGood: boolean;
}

export interface FrameCache<T> {
  /** The picture if it is here. */
  peek: (address: string) => T | undefined;
  /** Why it is not here, if asking for it failed; null while it is asked for the first time. */
  setbackOf: (address: string) => Setback | null;
  /**
   * Load these, the first ones first; what is under way and nobody wants any more is called off. Several can look at once,
   * each under its own name; the first picture of everybody comes before anybody's second. What failed is asked for again
   * after a pause that grows, and what will not come only when somebody comes to it anew.
   */
  focus: (addresses: readonly string[], viewer?: string) => void;
  /** A viewer that looks no more. */
  leave: (viewer: string) => void;
  /** Ask at once for what failed. */
  retry: (address: string) => void;
  /** Tells of each picture that has come or failed; returns the way to stop. */
  watch: (watcher: (address: string) => void) => () => void;
}

type Load<T> = (address: string, signal: AbortSignal) => Promise<T>;

/** As many as a browser opens to one server. */
const PARALLEL = 6;

interface Budget<T> {
  /** How much may be held, in the unit of `weigh`. */
  capacity: number;
  weigh: (picture: T) => number;
  dispose?: (picture: T) => void;
  /** How many are loaded at once. */
  parallel?: number;
}

interface Failed extends Setback {
  readonly times: number;
  /** Until it may be asked for again; null once it may. */
  readonly pause: ReturnType<typeof setTimeout> | null;
}

export function createFrameCache<T>(load: Load<T>, { capacity, weigh, dispose = () => undefined, parallel = PARALLEL }: Budget<T>): FrameCache<T> {
  /** In order of use, the oldest first. */
  const held = new Map<string, T>();
  let weight = 0;
  const flying = new Map<string, AbortController>();
  const failed = new Map<string, Failed>();
  const watchers = new Set<(address: string) => void>();
  const viewers = new Map<string, readonly string[]>();
  /** What all viewers want, by turns: everybody's first, everybody's second, ... */
  let wanted: readonly string[] = [];
  let firsts: ReadonlySet<string> = new Set();

  const tell = (address: string): void => watchers.forEach((watcher) => watcher(address));

  function forget(address: string): void {
    const found = failed.get(address);
    if (found?.pause != null) clearTimeout(found.pause);
    failed.delete(address);
  }

  function merge(): void {
    const lists = [...viewers.values()];
    const longest = Math.max(0, ...lists.map((list) => list.length));
    const order = Array.from({ length: longest }, (_, k) => lists.flatMap((list) => list[k] ?? []));
    const before = firsts;
    wanted = [...new Set(order.flat())];
    firsts = new Set(order[0] ?? []);
    for (const [address, controller] of flying) {
      if (wanted.includes(address)) continue;
      controller.abort();
      flying.delete(address);
    }
    for (const [address, { isForGood: isGone }] of failed) {
      const isAnew = isGone && firsts.has(address) && !before.has(address);
      if (isAnew || !wanted.includes(address)) forget(address);
    }
  }

  function keep(address: string, picture: T): void {
    if (held.delete(address)) weight -= weigh(picture);
    held.set(address, picture);
    weight += weigh(picture);
    for (const [oldest, old] of held) {
      if (weight <= capacity) break;
      if (firsts.has(oldest) || oldest === address) continue;
      held.delete(oldest);
      weight -= weigh(old);
      dispose(old);
    }
  }

  function fail(address: string, error: Error): void {
    const times = (failed.get(address)?.times ?? 0) + 1;
    const isGone = isForGood(error);
    const pause = isGone ? null : setTimeout(() => resume(address), pauseAfter(times));
    failed.set(address, { error, isForGood: isGone, times, pause });
  }

  /** The pause is over. */
  function resume(address: string): void {
    const found = failed.get(address);
    if (!found || found.isForGood) return;
    if (found.pause !== null) clearTimeout(found.pause);
    failed.set(address, { ...found, pause: null });
    startNext();
  }

  async function fetchOne(address: string): Promise<void> {
    const controller = new AbortController();
    flying.set(address, controller);
    const isCurrent = (): boolean => flying.get(address) === controller;
    try {
      const picture = await load(address, controller.signal);
      // One that was called off and came nevertheless is not thrown away.
      if (!isCurrent() && held.has(address)) return dispose(picture);
      forget(address);
      keep(address, picture);
    } catch (failure) {
      // What was called off has not failed.
      if (!isCurrent()) return;
      fail(address, failure instanceof Error ? failure : new Error(String(failure)));
    } finally {
      if (isCurrent()) flying.delete(address);
      startNext();
    }
    tell(address);
  }

  const isHeldBack = (address: string): boolean => {
    const found = failed.get(address);
    return found !== undefined && (found.isForGood || found.pause !== null);
  };

  function startNext(): void {
    // While what somebody looks at does not come, nothing is fetched in advance.
    const isCutOff = [...firsts].some((address) => failed.get(address)?.isForGood === false);
    let room = capacity;
    let heaviest = 0;
    for (const address of wanted) {
      if (flying.size >= parallel) return;
      const here = held.get(address);
      if (here !== undefined) {
        heaviest = Math.max(heaviest, weigh(here));
        room -= weigh(here);
      } else if (!isHeldBack(address) && (!isCutOff || firsts.has(address))) {
        // What would only push out another one that is wanted sooner is left for later.
        if (room < heaviest && !firsts.has(address)) return;
        room -= heaviest;
        if (!flying.has(address)) void fetchOne(address);
      }
    }
  }

  onNetworkBack(() => [...failed.keys()].forEach(resume));

  return {
    peek: (address) => held.get(address),
    setbackOf: (address) => failed.get(address) ?? null,
    focus(addresses, viewer = "") {
      viewers.set(viewer, addresses);
      merge();
      const [first] = addresses;
      const here = first === undefined ? undefined : held.get(first);
      if (first !== undefined && here !== undefined) keep(first, here);
      // What is looked at now does not wait for those that are fetched in advance.
      else if (first !== undefined && !flying.has(first) && !isHeldBack(first)) void fetchOne(first);
      startNext();
    },
    leave(viewer) {
      viewers.delete(viewer);
      merge();
      startNext();
    },
    retry(address) {
      forget(address);
      startNext();
      tell(address);
    },
    watch(watcher) {
      watchers.add(watcher);
      return () => watchers.delete(watcher);
    },
  };
}

/** Which way somebody goes through the frames, and for how many steps already; -1 before the first. */
export interface Travel {
  readonly frame: number;
  readonly direction: 1 | -1;
  readonly run: number;
}

export function travelOn(travel: Travel, frame: number): Travel {
  if (frame === travel.frame) return travel;
  const direction = frame > travel.frame ? 1 : -1;
  const isSteady = direction === travel.direction && Math.abs(frame - travel.frame) < 10;
  return { frame, direction, run: isSteady ? travel.run + 1 : 0 };
}

/** Who keeps going needs more in stock: up to a second at 30 frames a second, as far as memory allows. Before the first step nobody knows which way. */
export function aheadFor({ run }: Travel, bytesOfFrame: number): number {
  const affordable = Math.max(4, Math.floor(160e6 / bytesOfFrame));
  return Math.min(affordable, run < 0 ? 4 : run < 3 ? 8 : 30);
}

/** The frame of now, then those ahead, then one behind, all within the recording. */
export function framesToLoad(frame: number, direction: 1 | -1, frameCount: number, ahead = 8): number[] {
  const order = [frame, ...Array.from({ length: ahead }, (_, k) => frame + direction * (k + 1)), frame - direction];
  return order.filter((candidate) => candidate >= 0 && candidate < frameCount);
}
