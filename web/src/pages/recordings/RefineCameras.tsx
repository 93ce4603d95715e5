import { Button, Checkbox, Group, Stack, Text } from "@mantine/core";
import { IconAdjustments, IconArrowBackUp, IconCheck } from "@tabler/icons-react";
import { useState } from "react";
import { usePutRefinementBack, useRefine, useRefinements, useTakeRefinement, type Refinement } from "../../api/refinements";
import type { Recording } from "../../api/types";
import { formatAgo, formatCount } from "../../model/format";
import { tellFailure } from "../parts/undo";
import { For } from "../parts/For";
import { RefinementTable } from "./RefinementTable";

/** What to say of the newest proposal, above its table. */
function titleOf({ state, is_current, report, changed_at }: Refinement, tracks: number): string {
  const again = tracks > 0 ? ` Earlier tracks keep the old cameras (${formatCount(tracks, "track")} here): track again.` : "";
  if (state === "taken") return `These cameras were taken ${formatAgo(changed_at ?? "")}; those of before are kept.${again}`;
  if (state === "put_back") return `The cameras of before were put back; the labels would have these.${again}`;
  if (!is_current) return "The cameras were changed since; refine them again.";
  return report.refusal || "The cameras would agree better with the labels, also with those left out. Nothing is changed until you take them.";
}

/** Cameras of a recording refined from its labels: before and after are shown, and a person takes them or leaves them. */
export function RefineCameras({ recording, tracks }: { recording: Recording; tracks: number }) {
  const known = useRefinements(recording.id).data ?? [];
  const refine = useRefine(recording.id);
  const take = useTakeRefinement(recording.id);
  const putBack = usePutRefinementBack(recording.id);
  const [hasLenses, setLenses] = useState(false);
  const [leftId, leave] = useState<string | null>(null);
  if (recording.cameras.length < 2) return null;
  const newest = known[0]?.id === leftId ? undefined : known[0];
  /** The one whose cameras the recording has now: it can be put back, whatever was proposed since. */
  const taken = known.find((one) => one.state === "taken" && one.is_current);

  return (
    <Stack gap="sm" mt="md" component="section" aria-label="Refine cameras from labels">
      <Group justify="space-between">
        <Text size="sm" className="quiet" style={{ flex: "1 1 280px" }}>
          Cameras that were knocked after their calibration can be corrected from joints marked in two cameras or more.
        </Text>
        <For role="lead">
          <Group gap="md">
            <Checkbox size="xs" label="Lenses too" checked={hasLenses} onChange={(event) => setLenses(event.currentTarget.checked)} />
            <Button
              size="xs"
              variant="default"
              loading={refine.isPending}
              onClick={() => refine.mutate(hasLenses)}
              leftSection={<IconAdjustments size={16} aria-hidden />}
            >
              Refine from labels
            </Button>
          </Group>
        </For>
      </Group>
      {refine.error && (
        <Text size="sm" c="var(--bad-text)" role="alert">
          {refine.error.message}
        </Text>
      )}
      {newest && (
        <Stack gap="sm" className="card" p="md">
          <Text size="sm" fw={600} role="status">
            {titleOf(newest, tracks)}
          </Text>
          <RefinementTable refinement={newest} />
          <For role="lead">
            <Group gap="sm">
              {newest.state === "proposed" && newest.is_current && !newest.report.refusal && (
                <Button
                  size="xs"
                  loading={take.isPending}
                  onClick={() => take.mutate(newest.id, { onError: tellFailure })}
                  leftSection={<IconCheck size={16} aria-hidden />}
                >
                  Take these cameras
                </Button>
              )}
              {newest.state === "proposed" && (
                <Button size="xs" variant="subtle" onClick={() => leave(newest.id)}>
                  Leave the cameras as they are
                </Button>
              )}
              {taken && (
                <Button
                  size="xs"
                  variant="default"
                  loading={putBack.isPending}
                  onClick={() => putBack.mutate(taken.id, { onError: tellFailure })}
                  leftSection={<IconArrowBackUp size={16} aria-hidden />}
                >
                  Restore the previous cameras
                </Button>
              )}
            </Group>
          </For>
        </Stack>
      )}
    </Stack>
  );
}
