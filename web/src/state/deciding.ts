/** The decision log of this browser's person; it outlives the pages and a reload. */

import { sendDecision } from "../api/registrations";
import { createDecisionLog, hasWaitingDecisions, type DecisionLog } from "./decisionLog";
import { accountId } from "./me";

let log: DecisionLog | null = null;

export const decisionLog = (): DecisionLog =>
  (log ??= createDecisionLog({ send: sendDecision, storage: window.localStorage, account: accountId() }));

/** Try to send every decision that waits, now; also those of an earlier visit. */
export function flushDecisions(): void {
  if (log || hasWaitingDecisions(window.localStorage, accountId())) decisionLog().flush();
}
