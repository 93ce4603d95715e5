import { Button, Group, NumberInput, Select, TextInput } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { useState } from "react";
import { usePeople, useTeamChange, type Assignment } from "../../api/teams";

/** Give work that somebody has to somebody else, or change its frames or note. What was marked stays where it is. */
export function EditAssignment({ assignment, onDone }: { assignment: Assignment; onDone: () => void }) {
  const people = usePeople().data ?? [];
  const change = useTeamChange<Assignment>();
  const [person, setPerson] = useState<string>(assignment.account_id);
  const [first, setFirst] = useState<number | string>(assignment.frame_first);
  const [last, setLast] = useState<number | string>(assignment.frame_last);
  const [note, setNote] = useState(assignment.note);
  const isRange = assignment.replica_set_id === null;
  return (
    <form
      aria-label={`Change the work of ${assignment.account}`}
      onSubmit={(event) => {
        event.preventDefault();
        const frames = isRange ? { frame_first: Number(first), frame_last: Number(last) } : {};
        change.mutate(
          { method: "PATCH", path: `/assignments/${assignment.id}`, revision: assignment.revision, body: { account_id: person, note, ...frames } },
          { onSuccess: onDone, onError: (failure) => notifications.show({ color: "red", title: "Nothing was changed", message: failure.message }) },
        );
      }}
      onKeyDown={(event) => event.key === "Escape" && onDone()}
    >
      <Group gap="sm" align="end" py={4}>
        <Select
          label="Person"
          size="xs"
          w={200}
          searchable
          allowDeselect={false}
          data={people.map((one) => ({ value: one.id, label: `${one.name} (${one.role})` }))}
          value={person}
          onChange={(value) => value && setPerson(value)}
          data-autofocus
        />
        {isRange && (
          <>
            <NumberInput label="First frame" size="xs" w={88} min={0} hideControls value={first} onChange={setFirst} />
            <NumberInput label="Last frame" size="xs" w={88} min={0} hideControls value={last} onChange={setLast} />
          </>
        )}
        <TextInput label="Note" size="xs" w={240} maxLength={4000} value={note} onChange={(event) => setNote(event.currentTarget.value)} />
        <Button type="submit" size="xs" loading={change.isPending} disabled={isRange && (first === "" || last === "")}>
          Save
        </Button>
        <Button size="xs" variant="default" onClick={onDone}>
          Cancel
        </Button>
      </Group>
    </form>
  );
}
