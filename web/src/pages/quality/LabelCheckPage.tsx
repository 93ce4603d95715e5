import { Button, Group, SegmentedControl, Text, Title } from "@mantine/core";
import { Link, useParams, useSearchParams } from "react-router";
import { useFlagPages } from "../../api/flags";
import { useRecording } from "../../api/recordings";
import { countOpen, KINDS } from "../../model/flag";
import { Failure } from "../parts/Failure";
import { useTitle } from "../parts/useTitle";
import { FlaggedLabels } from "./FlaggedLabels";
import { FramesToLookAt, Looking } from "./FramesToLookAt";
import classes from "./LabelCheck.module.css";

/** The address says which list: flagged labels, those found right, frames to look at. */
const SHOWN = ["open", "right", "frames"] as const;

/** Labels of a recording that look wrong, the worst first, and frames that need a person though no label looks wrong. */
export default function LabelCheckPage() {
  const { recordingId = "" } = useParams();
  const [address, setAddress] = useSearchParams();
  const kind = KINDS.find((one) => one === address.get("kind")) ?? null;
  const shown = SHOWN.find((one) => one === address.get("show")) ?? "open";
  const isDismissed = shown === "right";
  const recording = useRecording(recordingId);
  const pages = useFlagPages(recordingId, kind, isDismissed);
  useTitle("Label check");

  const choose = (change: Record<string, string | null>): void => {
    const next = new URLSearchParams(address);
    for (const [name, value] of Object.entries(change)) {
      if (value === null) next.delete(name);
      else next.set(name, value);
    }
    setAddress(next, { replace: true });
  };

  const error = recording.error ?? pages.error ?? null;
  if (error && (!recording.data || !pages.data)) {
    return (
      <Failure what="The label check could not be loaded" error={error} safe="Labels are as they were." onRetry={() => void Promise.all([recording.refetch(), pages.refetch()])}>
        <Button variant="default" component={Link} to="/recordings">
          To the recordings
        </Button>
      </Failure>
    );
  }
  const first = pages.data?.pages[0];
  const shot = recording.data;
  return (
    <div className="page">
      <Group justify="space-between" mb="sm">
        <div style={{ minWidth: 0 }}>
          <Text size="sm" className="quiet" style={{ overflowWrap: "anywhere" }}>
            <Link to={`/recordings/${recordingId}`} className={classes.back}>
              {shot?.name ?? "Recording"}
            </Link>
          </Text>
          <Title order={1}>Label check</Title>
        </div>
        <SegmentedControl
          size="xs"
          aria-label="Which list"
          value={shown}
          onChange={(value) => choose({ show: value === "open" ? null : value })}
          data={[
            { value: "open", label: first ? `Flagged labels (${countOpen(first)})` : "Flagged labels" },
            { value: "right", label: first ? `Found right (${first.dismissed})` : "Found right" },
            { value: "frames", label: "Frames to look at" },
          ]}
        />
      </Group>
      {shown === "frames" ? (
        shot ? <FramesToLookAt recording={shot} /> : <Looking />
      ) : (
        <FlaggedLabels recordingId={recordingId} recording={shot} pages={pages} kind={kind} isDismissed={isDismissed} onKind={(value) => choose({ kind: value })} />
      )}
    </div>
  );
}
