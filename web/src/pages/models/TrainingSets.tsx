import { ActionIcon, Button, Text, Title, Tooltip } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { IconDownload, IconShieldCheck } from "@tabler/icons-react";
import { trainingSetUrl, useTrainingSets, verifyTrainingSet, type TrainingSet } from "../../api/handModels";
import { formatCount } from "../../model/format";
import { Awaited } from "../parts/Awaited";
import type { Column } from "../parts/CardTable";
import { KeptTable } from "./KeptTable";

const COLUMNS: readonly Column<TrainingSet>[] = [
  { head: "Chosen by", width: 160, show: ({ rule }) => (rule.by === "verdict" ? "the program" : rule.needs_two ? "two people" : "people") },
  { head: "Registrations", width: 120, isNumber: true, show: ({ registration_count: count }) => count.toLocaleString("en") },
  { head: "Subjects", width: 96, isNumber: true, show: ({ subject_count: count }) => count },
];

async function verify(set: TrainingSet): Promise<void> {
  try {
    const { is_intact, damaged } = await verifyTrainingSet(set.id);
    notifications.show(
      is_intact
        ? { message: `“${set.name}” is intact: the SHA-256 of every file matches.`, color: "teal" }
        : { message: `${formatCount(damaged.length, "registration")} of “${set.name}” changed or missing. Restore the files from a backup.`, color: "red", autoClose: false },
    );
  } catch (failure) {
    notifications.show({ color: "red", title: "Not verified", message: (failure as Error).message });
  }
}

/** What models learnt from: registrations as a rule chose them at one moment, under a hash. */
export function TrainingSets() {
  const query = useTrainingSets();
  const sets = query.data;
  if (query.error && !sets) return <Awaited what="The training sets" query={query} />;
  if (!sets || sets.length === 0) return null;
  return (
    <section aria-label="Training sets">
      <Title order={2} mb="sm">
        Training sets
      </Title>
      <KeptTable
        items={sets}
        columns={COLUMNS}
        when="Kept"
        actsWidth={160}
        acts={(set) => (
          <>
            <Button size="compact-xs" variant="subtle" leftSection={<IconShieldCheck size={14} aria-hidden />} onClick={() => void verify(set)} aria-label={`Verify the hashes of ${set.name}`}>
              Verify
            </Button>
            <Tooltip label="Download its registrations">
              <ActionIcon component="a" href={trainingSetUrl(set.id)} download aria-label={`Download the registrations of ${set.name}`}>
                <IconDownload size={16} />
              </ActionIcon>
            </Tooltip>
          </>
        )}
      />
      <Text size="xs" className="quiet" mt={4}>
        A set never changes; after later decisions, make a new one.
      </Text>
    </section>
  );
}
