import { Button, Group, Loader, NumberInput, Progress, ScrollArea, Select, Stack, Text, TextInput } from "@mantine/core";
import { useQueryClient } from "@tanstack/react-query";
import { useEffect, useState } from "react";
import { useNavigate } from "react-router";
import { movingKeys, type MovingScanAdded } from "../../api/movingScans";
import { formatBytes, formatCount } from "../../model/format";
import { endMovingUpload, sendChosenMovingScan, useMovingUpload } from "../../state/movingUpload";
import { Dialog } from "../parts/Dialog";
import { FormFooter } from "../parts/Obstacles";

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
          <ScrollArea.Autosize mah={240} tabIndex={0} aria-label="Frames that cannot be used">
            <Stack gap="sm" role="alert">
              {scan.problems.map(({ frame, name, detail }) => (
                <div key={frame} style={{ overflowWrap: "anywhere" }}>
                  <Text size="sm" fw={600}>
                    Frame {frame}, {name}
                  </Text>
                  <Text size="xs" c="var(--bad-text)">
                    {detail}
                  </Text>
                </div>
              ))}
            </Stack>
          </ScrollArea.Autosize>
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

/** What chosen scans of a moving person do not say of themselves, then their way to the server, then what became of them. */
export function MovingUploadDialog() {
  const upload = useMovingUpload();
  const client = useQueryClient();
  const [name, setName] = useState("");
  const [subject, setSubject] = useState("");
  const [fps, setFps] = useState<number | string>(60);
  const [unit, setUnit] = useState(FIND_OUT);
  const hasResult = Boolean(upload?.result);
  useEffect(() => {
    if (hasResult) void client.invalidateQueries({ queryKey: movingKeys.all });
  }, [hasResult, client]);
  if (!upload) return null;
  const isSending = upload.sent !== null && !upload.result;
  const isReady = typeof fps === "number" && fps > 0;
  const send = (): void =>
    void sendChosenMovingScan({
      ...(name.trim() ? { name: name.trim() } : {}),
      ...(subject.trim() ? { subject: subject.trim() } : {}),
      ...(typeof fps === "number" ? { fps } : {}),
      ...(unit === FIND_OUT ? {} : { metres_per_unit: Number(unit) }),
    });
  return (
    <Dialog title="Add a moving scan" size={560} onClose={endMovingUpload} isKept>
      {upload.result ? (
        <Result added={upload.result} onDone={endMovingUpload} />
      ) : isSending ? (
        <Stack gap="md">
          <Group gap="sm">
            {upload.sent === 1 && <Loader size="sm" />}
            <Text size="sm">{upload.sent === 1 ? "Every frame is opened and checked." : `Sending ${formatCount(upload.files.length, "file")}, ${formatBytes(upload.bytes)}.`}</Text>
          </Group>
          <Progress value={100 * (upload.sent ?? 0)} animated={upload.sent === 1} aria-label="Part of the files sent" />
          <Group justify="flex-end">
            <Button variant="default" onClick={endMovingUpload}>
              Cancel
            </Button>
          </Group>
        </Stack>
      ) : (
        <form
          onSubmit={(event) => {
            event.preventDefault();
            if (isReady) send();
          }}
        >
          <Stack gap="md">
            <Text size="sm" className="quiet">
              {formatCount(upload.files.length, "file")}, {formatBytes(upload.bytes)}. The scans of one person, one file a frame, in the order of their names. One file alone is a single scan of a person.
            </Text>
            <TextInput label="Name" description="Left empty: that of the folder" maxLength={200} value={name} onChange={(event) => setName(event.currentTarget.value)} data-autofocus />
            <Group grow gap="md" align="flex-start">
              <TextInput label="Subject" description="Who is scanned" maxLength={100} value={subject} onChange={(event) => setSubject(event.currentTarget.value)} />
              <NumberInput label="Frames per second" description="Of the scanner" min={0.1} max={1000} value={fps} onChange={setFps} />
              <Select label="Unit" description="Of the files" data={UNITS} value={unit} allowDeselect={false} onChange={(value) => setUnit(value ?? FIND_OUT)} />
            </Group>
            {upload.failure && (
              <Text size="sm" c="var(--bad-text)" role="alert" style={{ overflowWrap: "anywhere" }}>
                {upload.failure.message} Nothing was stored; try again.
              </Text>
            )}
            <FormFooter>
              <Button variant="default" onClick={endMovingUpload}>
                Cancel
              </Button>
              <Button type="submit" disabled={!isReady}>
                Add {formatCount(upload.files.length, "file")}
              </Button>
            </FormFooter>
          </Stack>
        </form>
      )}
    </Dialog>
  );
}
