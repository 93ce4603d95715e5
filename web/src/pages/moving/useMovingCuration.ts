import { useDecideStretch, useStretchDecisions, useUndoStretch, type StretchDecision } from "../../api/movingScans";
import { sayStretch, type Stretch } from "../../model/stretch";
import { useMe } from "../../state/me";
import { offerUndo, tellFailure } from "../parts/undo";

export interface MovingCuration {
  /** About the registration, the newest first. */
  readonly decisions: readonly StretchDecision[];
  readonly me: string;
  decide: (decision: "accept" | "reject", stretch: Stretch) => void;
  takeBack: (decision: StretchDecision) => void;
  readonly canUndo: boolean;
  /** Take one's last decision about the registration back. */
  undo: () => void;
}

/** Decisions about stretches of a registration, each of which can be taken back. */
export function useMovingCuration(scan: string, registration: string | undefined): MovingCuration {
  const me = useMe().id;
  const decisions = (useStretchDecisions(scan).data ?? []).filter((one) => one.registration_id === registration);
  const decide = useDecideStretch(scan);
  const undo = useUndoStretch(scan);
  const last = decisions.find((one) => one.stands && one.decision !== "undo" && one.account_id === me);
  const takeBack = (decision: StretchDecision): void => undo.mutate(decision.id, { onError: tellFailure });
  return {
    decisions,
    me,
    decide(decision, { first, last: end }) {
      if (registration === undefined || decide.isPending) return;
      const words = `${decision === "accept" ? "Accepted" : "Rejected"} ${sayStretch({ first, last: end })}.`;
      decide.mutate(
        { registration, decision, first_frame: first, last_frame: end },
        { onSuccess: (made) => offerUndo(words, () => undo.mutateAsync(made.id)), onError: tellFailure },
      );
    },
    takeBack,
    canUndo: last !== undefined && !undo.isPending,
    undo: () => last && !undo.isPending && takeBack(last),
  };
}
