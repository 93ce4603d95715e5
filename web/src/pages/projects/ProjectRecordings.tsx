import { Button, Progress, Select, Table, Text, Title } from "@mantine/core";
import { useState } from "react";
import { Link } from "react-router";
import { useRecordings } from "../../api/recordings";
import { useProjectRecordings, useTeamChange, type Project, type ProjectRecording } from "../../api/teams";
import { Awaited } from "../parts/Awaited";
import { offerUndo, tellFailure } from "../parts/undo";
import classes from "./projects.module.css";

/** The recordings of a project and how much of them is finished. */
export function ProjectRecordings({ project, mayChange }: { project: Project; mayChange: boolean }) {
  const query = useProjectRecordings(project.id);
  const { data } = query;
  const change = useTeamChange();
  const path = (id: string): string => `/projects/${project.id}/sequences/${id}`;
  const add = (id: string): Promise<unknown> => change.mutateAsync({ method: "PUT", path: path(id) });
  const takeOut = async (one: ProjectRecording): Promise<void> => {
    await change.mutateAsync({ method: "DELETE", path: path(one.id) });
    offerUndo(`${one.name} was taken out.`, () => add(one.id));
  };
  return (
    <section className={classes.section} aria-label="Recordings">
      <Title order={2} mb="sm">
        Recordings
      </Title>
      {!data && <Awaited what="The recordings" query={query} />}
      {data?.length === 0 && <Text className="quiet">No recordings yet. {mayChange ? "Add one below, then give its frames to people." : "A lead adds them."}</Text>}
      {data && data.length > 0 && (
        <div className={`card ${classes.frame}`}>
          <Table verticalSpacing="sm" horizontalSpacing="md">
            <Table.Thead>
              <Table.Tr>
                <Table.Th>Recording</Table.Th>
                <Table.Th ta="right">Frames</Table.Th>
                <Table.Th ta="right">Assigned</Table.Th>
                <Table.Th w={240}>Accepted</Table.Th>
                <Table.Th />
              </Table.Tr>
            </Table.Thead>
            <Table.Tbody>
              {data.map((recording) => (
                <Table.Tr key={recording.id}>
                  <Table.Td>
                    <Link to={`/recordings/${recording.id}`} className={classes.link} style={{ fontSize: 14 }}>
                      {recording.name}
                    </Link>
                  </Table.Td>
                  <Table.Td ta="right">{recording.frame_count}</Table.Td>
                  <Table.Td ta="right">{recording.assigned_frames}</Table.Td>
                  <Table.Td>
                    <Progress value={(100 * recording.accepted_frames) / recording.frame_count} aria-label={`${recording.accepted_frames} of ${recording.frame_count} frames accepted`} />
                    <Text size="xs" className="quiet" mt={4}>
                      {recording.accepted_frames} of {recording.frame_count} frames
                    </Text>
                  </Table.Td>
                  <Table.Td ta="right">
                    {mayChange && (
                      <Button
                        size="compact-xs"
                        variant="subtle"
                        color="gray"
                        aria-label={`Take out ${recording.name}`}
                        onClick={() => void takeOut(recording).catch(tellFailure)}
                      >
                        Take out
                      </Button>
                    )}
                  </Table.Td>
                </Table.Tr>
              ))}
            </Table.Tbody>
          </Table>
        </div>
      )}
      {mayChange && data && <AddRecording known={data.map((one) => one.id)} isBusy={change.isPending} onAdd={(id) => void add(id).catch(tellFailure)} />}
    </section>
  );
}

function AddRecording({ known, isBusy, onAdd }: { known: readonly string[]; isBusy: boolean; onAdd: (id: string) => void }) {
  const recordings = useRecordings().data?.filter((one) => !known.includes(one.id)) ?? [];
  const [chosen, setChosen] = useState<string | null>(null);
  return (
    <form
      className={`card ${classes.form}`}
      onSubmit={(event) => {
        event.preventDefault();
        if (chosen) onAdd(chosen);
        setChosen(null);
      }}
    >
      <Select
        label="Add a recording"
        w={400}
        searchable
        placeholder={recordings.length > 0 ? "Choose" : "Every recording is here already"}
        data={recordings.map((one) => ({ value: one.id, label: one.name }))}
        value={chosen}
        onChange={setChosen}
      />
      <Button type="submit" loading={isBusy} disabled={!chosen}>
        Add
      </Button>
    </form>
  );
}
