import { Button, NumberInput, Select, Stack, Table, Text, TextInput, Title } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { useState } from "react";
import { Link } from "react-router";
import { assignmentAddress, useAssignments, usePeople, useProjectRecordings, useTeamChange, type Assignment, type Project } from "../../api/teams";
import { Awaited } from "../parts/Awaited";
import { offerUndo, tellFailure } from "../parts/undo";
import classes from "./projects.module.css";
import { EditAssignment } from "./EditAssignment";
import { StateBadge } from "./StateBadge";
import { WorkProgress, workText } from "../parts/WorkProgress";

/** Who marks which frames, person by person, and how far they are. */
export function ProjectAssignments({ project, mayChange }: { project: Project; mayChange: boolean }) {
  const query = useAssignments({ project: project.id });
  const { data } = query;
  const people = [...new Set(data?.map((one) => one.account))].sort();
  return (
    <section className={classes.section} aria-label="Assignments">
      <Title order={2} mb="sm">
        Assignments
      </Title>
      {!data && <Awaited what="The assignments" query={query} />}
      {data?.length === 0 && (
        <Text className="quiet">
          {project.archived_at
            ? "An archived project shows no assignments. Restore it to see them."
            : `No frames are assigned yet. ${mayChange ? "Assign a range below; what is submitted is locked until it is reviewed." : "A lead assigns them."}`}
        </Text>
      )}
      <Stack gap="sm">
        {people.map((person) => (
          <PersonWork key={person} person={person} work={data?.filter((one) => one.account === person) ?? []} mayChange={mayChange} />
        ))}
      </Stack>
      {mayChange && data && <Assign project={project} />}
    </section>
  );
}

function PersonWork({ person, work, mayChange }: { person: string; work: readonly Assignment[]; mayChange: boolean }) {
  const change = useTeamChange();
  const [edited, setEdited] = useState<string | null>(null);
  const done = work.reduce((sum, one) => sum + one.frames_done, 0);
  const partial = work.reduce((sum, one) => sum + one.frames_partial, 0);
  const frames = work.reduce((sum, one) => sum + one.frames, 0);
  const withdraw = async (one: Assignment): Promise<void> => {
    await change.mutateAsync({ method: "DELETE", path: `/assignments/${one.id}`, revision: one.revision });
    offerUndo("The assignment was withdrawn; the joints stay.", () => change.mutateAsync({ method: "POST", path: `/assignments/${one.id}/restore` }));
  };
  return (
    <div className={`card ${classes.frame}`} data-testid="person">
      <div className={classes.work}>
        <Text fw={600} className={`one-line ${classes.words}`}>
          {person}
        </Text>
        <div className={classes.progress} style={{ width: 240 }}>
          <WorkProgress done={done} partial={partial} total={frames} />
          <Text size="xs" className="quiet" mt={4}>
            {workText(done, partial, frames)}
          </Text>
        </div>
      </div>
      <Table verticalSpacing="sm" horizontalSpacing="md">
        <Table.Tbody>
          {work.map((one) =>
            one.id === edited ? (
              <Table.Tr key={one.id}>
                <Table.Td colSpan={4}>
                  <EditAssignment assignment={one} onDone={() => setEdited(null)} />
                </Table.Td>
              </Table.Tr>
            ) : (
              <Table.Tr key={one.id}>
                <Table.Td w={128}>
                  <StateBadge state={one.state} />
                </Table.Td>
                <Table.Td>
                  <Link to={assignmentAddress(one, one.state === "open" || one.state === "returned" ? one.next_frame : one.frame_first)} className={classes.link} style={{ fontSize: 14 }}>
                    {one.recording}, {one.replica_set ? `${one.replica_set} (blind)` : `frames ${one.frame_first}–${one.frame_last}`}
                  </Link>
                  {one.note && (
                    <Text size="xs" className="quiet">
                      {one.note}
                    </Text>
                  )}
                </Table.Td>
                <Table.Td ta="right" style={{ whiteSpace: "nowrap" }}>
                  {one.open_comments > 0 && `${one.open_comments} to resolve · `}
                  {one.frames_done} of {one.frames}
                  {one.frames_partial > 0 && `, ${one.frames_partial} begun`}
                </Table.Td>
                {mayChange && (
                  <Table.Td w={176} ta="right" style={{ whiteSpace: "nowrap" }}>
                    <>
                      <Button size="compact-xs" variant="subtle" color="gray" aria-label={`Change the work of ${person} on ${one.recording}`} onClick={() => setEdited(one.id)}>
                        Change
                      </Button>
                      <Button size="compact-xs" variant="subtle" color="gray" aria-label={`Withdraw the work of ${person} on ${one.recording}`} onClick={() => void withdraw(one).catch(tellFailure)}>
                        Withdraw
                      </Button>
                    </>
                  </Table.Td>
                )}
              </Table.Tr>
            ),
          )}
        </Table.Tbody>
      </Table>
    </div>
  );
}

function Assign({ project }: { project: Project }) {
  const recordings = useProjectRecordings(project.id).data ?? [];
  const people = usePeople().data ?? [];
  const change = useTeamChange();
  const [recording, setRecording] = useState<string | null>(null);
  const [person, setPerson] = useState<string | null>(null);
  const [range, setRange] = useState<{ first: number | string; last: number | string }>({ first: 0, last: "" });
  const [note, setNote] = useState("");
  const chosen = recordings.find((one) => one.id === recording) ?? (recordings.length === 1 ? recordings[0] : undefined);
  const last = range.last === "" ? (chosen?.frame_count ?? 1) - 1 : range.last;
  return (
    <form
      className={`card ${classes.form}`}
      aria-label="Give frames to somebody"
      onSubmit={(event) => {
        event.preventDefault();
        if (!chosen || !person) return;
        change.mutate(
          { method: "POST", path: `/projects/${project.id}/assignments`, body: { sequence_id: chosen.id, account_id: person, frame_first: Number(range.first), frame_last: Number(last), note } },
          {
            onSuccess: () => setRange({ first: Number(last) + 1 < chosen.frame_count ? Number(last) + 1 : 0, last: "" }),
            onError: (failure) => notifications.show({ color: "red", title: "Nothing was assigned", message: failure.message }),
          },
        );
      }}
    >
      <Select label="Recording" w={240} data={recordings.map((one) => ({ value: one.id, label: one.name }))} value={chosen?.id ?? null} onChange={setRecording} placeholder="Choose" />
      <NumberInput label="First frame" w={96} min={0} max={(chosen?.frame_count ?? 1) - 1} hideControls value={range.first} onChange={(first) => setRange({ ...range, first })} />
      <NumberInput label="Last frame" w={96} min={0} max={(chosen?.frame_count ?? 1) - 1} hideControls value={last} onChange={(value) => setRange({ ...range, last: value })} />
      <Select label="Person" w={200} searchable data={people.map((one) => ({ value: one.id, label: `${one.name} (${one.role})` }))} value={person} onChange={setPerson} placeholder="Choose" />
      <TextInput label="Note" w={240} maxLength={4000} value={note} onChange={(event) => setNote(event.currentTarget.value)} placeholder="What to watch for" />
      <Button type="submit" disabled={!chosen || !person} loading={change.isPending}>
        Assign
      </Button>
    </form>
  );
}
