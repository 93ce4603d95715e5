/** An open recording as others change it, and who else has it open. The stream itself is `state/live.ts`. */

import { request } from "./client";
import type { Side } from "./types";

export interface PersonHere {
  readonly name: string;
  readonly camera: string;
  readonly frame: number;
  readonly hand: Side;
}

/** Say where one is; that it does not arrive matters to nobody. */
export const sendVisit = (recording: string, visit: string, place: Omit<PersonHere, "name">): void =>
  void request("PUT", `/sequences/${recording}/visits/${visit}`, { body: place, whenOut: "fail" }).catch(() => undefined);
