/** Decoded pictures by address: the one wanted now, those in the direction of travel, and the last ones used. */

export interface FrameCache<T> {
  /** The picture if it is here. */
  peek(address: string): T | undefined;
  /**
   * Load these, the first ones first; what is under way and nobody wants any more is called off. Resolves with the first.
   * Several can look at once, each under its own name; the first picture of everybody comes before anybody's second.
   */
  focus(addresses: readonly string[], viewer?: string): Promise<T>;
  /** A viewer that looks no more. */
  leave(viewer: string): void;
  clear(): void;
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

export function createFrameCache<T>(load: Load<T>, { capacity, weigh, dispose = () => undefined, parallel = PARALLEL }: Budget<T>): FrameCache<T> {
  /** In order of use, the oldest first. */
  const held = new Map<string, T>();
  let weight = 0;
  const flying = new Map<string, { controller: AbortController; promise: Promise<T> }>();
  const viewers = new Map<string, readonly string[]>();
  /** What all viewers want, by turns: everybody's first, everybody's second, ... */
  let wanted: readonly string[] = [];
  let firsts: ReadonlySet<string> = new Set();

  function merge(): void {
    const lists = [...viewers.values()];
    const longest = Math.max(0, ...lists.map((list) => list.length));
    const order = Array.from({ length: longest }, (_, k) => lists.flatMap((list) => list[k] ?? []));
    wanted = [...new Set(order.flat())];
    firsts = new Set(order[0] ?? []);
    for (const [address, { controller }] of flying) if (!wanted.includes(address)) controller.abort();
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

  function fetchOne(address: string): Promise<T> {
    const known = flying.get(address);
    // One that was called off brings nothing any more.
    if (known && !known.controller.signal.aborted) return known.promise;
    const controller = new AbortController();
    const promise = load(address, controller.signal)
      .then((picture) => {
        keep(address, picture);
        return picture;
      })
      .finally(() => {
        if (flying.get(address)?.controller === controller) flying.delete(address);
        startNext();
      });
    flying.set(address, { controller, promise });
    promise.catch(() => undefined);
    return promise;
  }

  function startNext(): void {
    let room = capacity;
    let heaviest = 0;
    for (const address of wanted) {
      if (flying.size >= parallel) return;
      const here = held.get(address);
      if (here !== undefined) {
        heaviest = Math.max(heaviest, weigh(here));
        room -= weigh(here);
      } else {
        // What would only push out another one that is wanted sooner is left for later.
        if (room < heaviest && !firsts.has(address)) return;
        room -= heaviest;
        if (!flying.has(address)) void fetchOne(address);
      }
    }
  }

  return {
    peek(address) {
      return held.get(address);
    },
    focus(addresses, viewer = "") {
      viewers.set(viewer, addresses);
      merge();
      const [first] = addresses;
      if (first === undefined) return Promise.reject(new Error("No address to load."));
      const here = held.get(first);
      if (here !== undefined) keep(first, here);
      const promise = here !== undefined ? Promise.resolve(here) : fetchOne(first);
      startNext();
      return promise;
    },
    leave(viewer) {
      viewers.delete(viewer);
      merge();
    },
    clear() {
      viewers.clear();
      merge();
      flying.forEach(({ controller }) => controller.abort());
      held.forEach(dispose);
      held.clear();
      weight = 0;
    },
  };
}

/** Which way somebody goes through the frames, and for how many steps already. */
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

/** Who keeps going needs more in stock: up to a second at 30 frames a second, as far as memory allows. */
export function aheadFor({ run }: Travel, bytesOfFrame: number): number {
  const affordable = Math.max(4, Math.floor(160e6 / bytesOfFrame));
  return Math.min(affordable, run < 3 ? 8 : 30);
}

/** The frame of now, then those ahead, then one behind, all within the recording. */
export function framesToLoad(frame: number, direction: 1 | -1, frameCount: number, ahead = 8): number[] {
  const order = [frame, ...Array.from({ length: ahead }, (_, k) => frame + direction * (k + 1)), frame - direction];
  return order.filter((candidate) => candidate >= 0 && candidate < frameCount);
}
