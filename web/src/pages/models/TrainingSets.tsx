import { ActionIcon, Button, Group, Table, Text, Title, Tooltip } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { IconDownload, IconShieldCheck } from "@tabler/icons-react";
import { trainingSetUrl, useTrainingSets, verifyTrainingSet, type TrainingSet } from "../../api/handModels";
import { formatAgo, formatCount } from "../../model/format";
import classes from "./Models.module.css";

async function verify(set: TrainingSet): Promise<void> {
  try {
    const { is_intact, damaged } = await verifyTrainingSet(set.id);
    notifications.show(
      is_intact
        ? { message: `“${set.name}” is intact: every file has the SHA-256 that was noted.`, color: "teal" }
        : { message: `${formatCount(damaged.length, "registration")} of “${set.name}” changed or gone. Bring the files back from a backup.`, color: "red", autoClose: false },
    );
  } catch (failure) {
    notifications.show({ color: "red", title: "Not verified", message: (failure as Error).message });
  }
}

/** What models learnt from: registrations as a rule chose them at one moment, under a hash. */
export function TrainingSets() {
  const sets = useTrainingSets().data;
  if (!sets || sets.length === 0) return null;
  return (
    <section aria-label="Training sets">
      <Title order={2} mb="sm">
        Training sets
      </Title>
      <div className={`card ${classes.frame}`}>
        <Table verticalSpacing="xs" horizontalSpacing="md">
          <Table.Thead>
            <Table.Tr>
              <Table.Th>Name</Table.Th>
              <Table.Th w={160}>Chosen by</Table.Th>
              <Table.Th w={120} ta="right">
                Registrations
              </Table.Th>
              <Table.Th w={96} ta="right">
                Subjects
              </Table.Th>
              <Table.Th w={128}>SHA-256</Table.Th>
              <Table.Th w={128} ta="right">
                Kept
              </Table.Th>
              <Table.Th w={160} aria-label="Acts" />
            </Table.Tr>
          </Table.Thead>
          <Table.Tbody>
            {sets.map((set) => (
              <Table.Tr key={set.id}>
                <Table.Td className={classes.cell} title={set.name}>
                  {set.name}
                </Table.Td>
                <Table.Td>{set.rule.by === "verdict" ? "the program" : set.rule.needs_two ? "two people" : "people"}</Table.Td>
                <Table.Td ta="right">{set.registration_count.toLocaleString("en")}</Table.Td>
                <Table.Td ta="right">{set.subject_count}</Table.Td>
                <Table.Td className={classes.cell} title={set.digest} style={{ fontFamily: "var(--mantine-font-family-monospace)", fontSize: 12 }}>
                  {set.digest.slice(0, 12)}
                </Table.Td>
                <Table.Td ta="right" className="quiet">
                  {formatAgo(set.created_at)}
                </Table.Td>
                <Table.Td>
                  <Group gap={4} justify="flex-end" wrap="nowrap">
                    <Button size="compact-xs" variant="subtle" leftSection={<IconShieldCheck size={14} aria-hidden />} onClick={() => void verify(set)} aria-label={`Verify the hashes of ${set.name}`}>
                      Verify
                    </Button>
                    <Tooltip label="Download its registrations">
                      <ActionIcon component="a" href={trainingSetUrl(set.id)} download aria-label={`Download the registrations of ${set.name}`}>
                        <IconDownload size={16} />
                      </ActionIcon>
                    </Tooltip>
                  </Group>
                </Table.Td>
              </Table.Tr>
            ))}
          </Table.Tbody>
        </Table>
      </div>
      <Text size="xs" className="quiet" mt={4}>
        A set never changes: who decides otherwise later makes a new one.
      </Text>
    </section>
  );
}
