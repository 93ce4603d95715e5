import { Button, type ButtonProps } from "@mantine/core";
import { mayStart, useJobCheck } from "../../api/jobChecks";
import type { Recording } from "../../api/types";
import { hasRole, useMe } from "../../state/me";

interface TrackButtonProps extends ButtonProps {
  recording: Recording;
  onClick: () => void;
}

/** Why a recording cannot be tracked whatever is chosen; empty when it can be, and while that is not known. */
export function useTrackObstacles(recording: Recording | undefined): readonly string[] {
  const isAsked = hasRole(useMe(), "reviewer") && recording !== undefined;
  return useJobCheck({ kind: "track", sequence_id: recording?.id ?? "" }, isAsked).data?.obstacles ?? [];
}

/** Opens the form of a tracking job, for those who may start one; of a recording that cannot be tracked it is disabled. */
export function TrackButton({ recording, onClick, ...look }: TrackButtonProps) {
  const isReviewer = hasRole(useMe(), "reviewer");
  const check = useJobCheck({ kind: "track", sequence_id: recording.id }, isReviewer);
  if (!isReviewer) return null;
  const obstacles = check.data?.obstacles ?? [];
  return (
    <Button {...look} onClick={onClick} disabled={!check.isPending && !mayStart(check)} title={obstacles.join(" ") || undefined}>
      Track …
    </Button>
  );
}
