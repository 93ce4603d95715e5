/** The stream of the page: jobs everywhere, and of an open recording what others do in it. A browser has few connections, so a page has one. */

import { createStore } from "./store";

/** What else the page's stream is to say while a recording is open. */
export interface LiveRoom {
  /** Of the stream, without what it is to go on after. */
  readonly path: string;
  readonly query: Readonly<Record<string, string>>;
  /** Time of the labels at hand, for the beginning. */
  readonly since: string;
  readonly handlers: Readonly<Record<string, (data: unknown) => void>>;
  /** The stream is there, for the first time or again. */
  onOpen: () => void;
}

const store = createStore<LiveRoom | null>(null);

export const liveRoom = store;

/** Times up to which the stream has heard: of jobs, of labels. */
let heardJobs = "";
let heardLabels = "";

/** Note how far it is: `<jobs>`, or of an open recording `<jobs>~<labels>`. */
export function noteHeard(id: string): void {
  const [jobs, labels] = id.split("~");
  if (jobs) heardJobs = jobs;
  if (labels) heardLabels = labels;
}

/** Where the stream goes on. */
export function streamAddress(): string {
  const room = store.get();
  if (!room) return "/jobs/events";
  const after = `${heardJobs}~${heardLabels || room.since}`;
  return `${room.path}?${new URLSearchParams({ ...room.query, after })}`;
}

/** From now on the stream speaks of this recording, too. Returns the way to stop. */
export function enterRoom(room: LiveRoom): () => void {
  heardLabels = "";
  store.set(room, "person");
  return () => {
    if (store.get() === room) store.set(null, "person");
  };
}
