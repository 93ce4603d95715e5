import { Button, Checkbox, Group, MultiSelect, NumberInput, Select, Table, Text, TextInput, Title } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { useState } from "react";
import { Link } from "react-router";
import { useMe, usePeople, useProjectRecordings, useReplicaSets, useTeamChange, type Project, type ReplicaSet, type ReplicaSetMake } from "../../api/teams";
import { hasRole } from "../../model/assignment";
import { formatCount } from "../../model/format";
import { Awaited } from "../parts/Awaited";
import { offerUndo, tellFailure } from "../parts/undo";
import classes from "./projects.module.css";

/** Frames that several people mark without seeing each other, and how well they agree. */
export function ProjectReplicas({ project, mayChange }: { project: Project; mayChange: boolean }) {
  const query = useReplicaSets(project.id);
  const { data } = query;
  const isReviewer = hasRole(useMe().data, "reviewer");
  const change = useTeamChange();
  const withdraw = async (one: ReplicaSet): Promise<void> => {
    await change.mutateAsync({ method: "DELETE", path: `/replica-sets/${one.id}` });
    offerUndo(`${one.name} was withdrawn; what was marked stays stored.`, () => change.mutateAsync({ method: "POST", path: `/bin/replica_set/${one.id}/restore` }));
  };
  return (
    <section className={classes.section} aria-label="Blind replicas">
      <Title order={2} mb="sm">
        Blind replicas
      </Title>
      {!data && <Awaited what="The blind replicas" query={query} height={80} />}
      {data?.length === 0 && (
        <Text className="quiet">
          None yet. Give the same frames to several people, who mark them without seeing each other. How far apart they are shows how good the labels are.
        </Text>
      )}
      {data && data.length > 0 && (
        <div className={`card ${classes.frame}`}>
          <Table verticalSpacing="sm" horizontalSpacing="md">
            <Table.Thead>
              <Table.Tr>
                <Table.Th>Set</Table.Th>
                <Table.Th>Recording</Table.Th>
                <Table.Th ta="right">Frames</Table.Th>
                <Table.Th>Cameras, hands</Table.Th>
                <Table.Th ta="right">Submitted</Table.Th>
                <Table.Th />
              </Table.Tr>
            </Table.Thead>
            <Table.Tbody>
              {data.map((one) => (
                <Table.Tr key={one.id}>
                  <Table.Td fw={600}>{one.name}</Table.Td>
                  <Table.Td>{one.recording}</Table.Td>
                  <Table.Td ta="right">{one.frames.length}</Table.Td>
                  <Table.Td>
                    {one.cameras.join(", ")}; {one.hands.join(", ")}
                  </Table.Td>
                  <Table.Td ta="right">
                    {one.finished} of {one.annotators}
                  </Table.Td>
                  <Table.Td>
                    <Group gap="sm" justify="flex-end" wrap="nowrap">
                      {isReviewer && (
                        <Button size="compact-xs" variant="default" component={Link} to={`/projects/${project.id}/agreement/${one.id}`}>
                          Agreement
                        </Button>
                      )}
                      {mayChange && (
                        <Button size="compact-xs" variant="subtle" color="gray" aria-label={`Withdraw ${one.name}`} onClick={() => void withdraw(one).catch(tellFailure)}>
                          Withdraw
                        </Button>
                      )}
                    </Group>
                  </Table.Td>
                </Table.Tr>
              ))}
            </Table.Tbody>
          </Table>
        </div>
      )}
      {mayChange && data && <Replicate project={project} />}
    </section>
  );
}

const MOST_FRAMES = 2000;

function Replicate({ project }: { project: Project }) {
  const recordings = useProjectRecordings(project.id).data ?? [];
  const people = usePeople().data ?? [];
  const change = useTeamChange();
  const [name, setName] = useState("");
  const [recording, setRecording] = useState<string | null>(null);
  const [range, setRange] = useState<{ first: number | string; last: number | string; step: number | string }>({ first: 0, last: "", step: 10 });
  const [hands, setHands] = useState<string[] | null>(null);
  const [cameras, setCameras] = useState<string[] | null>(null);
  const [who, setWho] = useState<string[]>([]);
  const chosen = recordings.find((one) => one.id === recording) ?? (recordings.length === 1 ? recordings[0] : undefined);
  const last = range.last === "" ? (chosen?.frame_count ?? 1) - 1 : Number(range.last);
  const step = Math.max(1, Number(range.step) || 1);
  const first = Number(range.first);
  const frames = Array.from({ length: Math.max(0, Math.min(MOST_FRAMES, Math.floor((last - first) / step) + 1)) }, (_, index) => first + index * step);
  const wantedCameras = cameras ?? chosen?.cameras.slice(0, 1) ?? [];
  const wantedHands = (hands ?? chosen?.hands ?? []) as ReplicaSetMake["hands"];
  const isReady = chosen !== undefined && name.trim() !== "" && frames.length > 0 && who.length >= 2 && wantedCameras.length > 0 && wantedHands.length > 0;
  return (
    <form
      className={`card ${classes.form}`}
      aria-label="New replica set"
      onSubmit={(event) => {
        event.preventDefault();
        if (!isReady) return;
        const body: ReplicaSetMake = { name, sequence_id: chosen.id, frames, cameras: wantedCameras, hands: wantedHands, account_ids: who, note: "" };
        change.mutate(
          { method: "POST", path: `/projects/${project.id}/replica-sets`, body },
          {
            onSuccess: () => setName(""),
            onError: (failure) => notifications.show({ color: "red", title: "The set was not made", message: failure.message }),
          },
        );
      }}
    >
      <TextInput label="Name of the set" w={200} maxLength={200} value={name} onChange={(event) => setName(event.currentTarget.value)} placeholder="Agreement, week 1" />
      <Select label="Recording" w={200} data={recordings.map((one) => ({ value: one.id, label: one.name }))} value={chosen?.id ?? null} onChange={setRecording} placeholder="Choose" />
      <NumberInput label="First frame" w={80} min={0} hideControls value={first} onChange={(value) => setRange({ ...range, first: value })} />
      <NumberInput label="Last frame" w={80} min={0} hideControls value={last} onChange={(value) => setRange({ ...range, last: value })} />
      <NumberInput label="Every" w={64} min={1} hideControls value={range.step} onChange={(value) => setRange({ ...range, step: value })} />
      {chosen && chosen.cameras.length > 1 && <MultiSelect label="Cameras" w={200} data={chosen.cameras} value={wantedCameras} onChange={setCameras} />}
      <MultiSelect label="People, at least two" w={280} searchable data={people.map((one) => ({ value: one.id, label: one.name }))} value={who} onChange={setWho} placeholder={who.length === 0 ? "Choose" : ""} />
      <Checkbox.Group label="Hands" value={wantedHands} onChange={setHands}>
        <Group h={36} gap="sm">
          <Checkbox value="right" label="right" />
          <Checkbox value="left" label="left" />
        </Group>
      </Checkbox.Group>
      <Button type="submit" disabled={!isReady} loading={change.isPending}>
        Give {formatCount(frames.length, "frame")} to {who.length || "…"}
      </Button>
    </form>
  );
}
