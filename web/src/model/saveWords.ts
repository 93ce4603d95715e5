/** What the status line says of what was saved and what waits. */

import { formatCount } from "./format";

export interface SaveFacts {
  /** All that the server does not have, whatever the reason. */
  readonly waiting: number;
  readonly isSending: boolean;
  readonly isOffline: boolean;
  readonly trouble: string;
  readonly isHeld: boolean;
  readonly isKept: boolean;
  readonly conflicts?: number;
  readonly refusals: number;
}

/** What else of this person waits in this browser. */
interface Beside {
  readonly mine: number;
  readonly crops: number;
}

export type SaveSign = "settle" | "warning" | "lock" | "offline" | "busy" | "saved";

export interface SaveWords {
  readonly text: string;
  readonly tone: "good" | "busy" | "bad";
  readonly sign: SaveSign;
}

/** Why nothing is sent now, and how many wait for it. */
function describeHold(status: SaveFacts, waiting: number): SaveWords | null {
  if (status.isHeld) return { text: `log in to save, ${waiting} waiting`, tone: "bad", sign: "lock" };
  if (status.trouble) return { text: `held back, ${waiting} waiting`, tone: "bad", sign: "warning" };
  if (status.isOffline) return { text: `offline, ${waiting} waiting`, tone: "bad", sign: "offline" };
  return null;
}

/** `isBusy`: some other change, such as a comment, is on its way to the server. What a person has to settle hides nothing else that waits. */
export function describeSaving(status: SaveFacts, { mine, crops }: Beside, isBusy: boolean): SaveWords {
  const conflicts = status.conflicts ?? 0;
  const others = status.waiting - conflicts - status.refusals;
  const told: SaveWords | null =
    conflicts > 0
      ? { text: `${formatCount(conflicts, "change")} to settle`, tone: "bad", sign: "settle" }
      : status.refusals > 0
        ? { text: `not taken by the server, ${status.refusals} kept here`, tone: "bad", sign: "warning" }
        : null;
  const hold = describeHold(status, told ? others : status.waiting);
  if (told) return hold && others > 0 ? { ...told, text: `${told.text}; ${hold.text}` } : told;
  if (hold) return hold;
  if (status.waiting > 0 || status.isSending || isBusy) return { text: "saving …", tone: "busy", sign: "busy" };
  if (mine > 0) return { text: `saved here, ${mine} waiting elsewhere`, tone: "busy", sign: "busy" };
  if (crops > 0) return { text: `saved here, ${formatCount(crops, "crop")} not saved`, tone: "busy", sign: "warning" };
  return { text: "saved", tone: "good", sign: "saved" };
}
