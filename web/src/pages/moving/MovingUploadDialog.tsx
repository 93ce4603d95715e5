import { Button, Group, NumberInput, Select, Stack, Text, TextInput } from "@mantine/core";
import { useState } from "react";
import { useNavigate } from "react-router";
import { movingKeys, type MovingScanAdded } from "../../api/movingScans";
import { formatCount } from "../../model/format";
import { endMovingUpload, sendChosenMovingScan, useMovingUpload } from "../../state/movingUpload";
import { FaultList } from "../parts/FaultList";
import { FilesDialog } from "../parts/FilesDialog";

const FIND_OUT = "";
const UNITS = [
  { value: FIND_OUT, label: "Find out" },
  { value: "1", label: "Metres" },
  { value: "0.01", label: "Centimetres" },
  { value: "0.001", label: "Millimetres" },
  { value: "0.0254", label: "Inches" },
];

function Result({ added: { moving_scan: scan, is_known }, onDone }: { added: MovingScanAdded; onDone: () => void }) {
  const navigate = useNavigate();
  const open = (): void => {
    onDone();
    void navigate(`/scans/moving/${scan.id}`);
  };
  return (
    <Stack gap="md">
      <Text size="sm" style={{ overflowWrap: "anywhere" }}>
        {is_known ? `The same frames are there already as “${scan.name}”.` : `“${scan.name}” has ${formatCount(scan.frame_count, "frame")}.`}
        {scan.is_unit_guessed && !is_known && ` One unit of its files is ${(1000 * scan.metres_per_unit).toLocaleString("en")} mm, as a person’s size tells.`}
      </Text>
      {scan.problems.length > 0 && (
        <>
          <Text size="sm" c="var(--warn-text)">
            {formatCount(scan.problems.length, "frame")} cannot be used; the others can be played and registered.
          </Text>
          <FaultList label="Frames that cannot be used" faults={scan.problems.map(({ frame, name, detail }) => ({ name: `Frame ${frame}, ${name}`, detail }))} />
        </>
      )}
      {scan.notes.map((note) => (
        <Text key={note} size="sm" className="quiet">
          {note}
        </Text>
      ))}
      <Group justify="flex-end" gap="sm">
        <Button variant="default" onClick={onDone}>
          Done
        </Button>
        <Button onClick={open} data-autofocus>
          Open
        </Button>
      </Group>
    </Stack>
  );
}

/** What chosen scans of a moving person do not say of themselves. */
export function MovingUploadDialog() {
  const upload = useMovingUpload();
  const [name, setName] = useState("");
  const [subject, setSubject] = useState("");
  const [fps, setFps] = useState<number | string>(60);
  const [unit, setUnit] = useState(FIND_OUT);
  if (!upload) return null;
  const send = (): void =>
    void sendChosenMovingScan({
      ...(name.trim() ? { name: name.trim() } : {}),
      ...(subject.trim() ? { subject: subject.trim() } : {}),
      ...(typeof fps === "number" ? { fps } : {}),
      ...(unit === FIND_OUT ? {} : { metres_per_unit: Number(unit) }),
    });
  return (
    <FilesDialog
      title="Add a moving scan"
      size={560}
      upload={upload}
      hint="The scans of one person, one file a frame, in the order of their names. One file alone is a single scan of a person."
      reading="Every frame is opened and checked."
      changes={movingKeys.all}
      onEnd={endMovingUpload}
      onSend={typeof fps === "number" && fps > 0 ? send : null}
      verb={`Add ${formatCount(upload.files.length, "file")}`}
      result={(added) => <Result added={added} onDone={endMovingUpload} />}
    >
      <TextInput label="Name" description="Left empty: that of the folder" maxLength={200} value={name} onChange={(event) => setName(event.currentTarget.value)} data-autofocus />
      <Group grow gap="md" align="flex-start">
        <TextInput label="Subject" description="Who is scanned" maxLength={100} value={subject} onChange={(event) => setSubject(event.currentTarget.value)} />
        <NumberInput label="Frames per second" description="Of the scanner" min={0.1} max={1000} value={fps} onChange={setFps} />
        <Select label="Unit" description="Of the files" data={UNITS} value={unit} allowDeselect={false} onChange={(value) => setUnit(value ?? FIND_OUT)} />
      </Group>
    </FilesDialog>
  );
}
