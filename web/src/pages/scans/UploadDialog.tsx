import { Button, Group, Loader, Modal, NumberInput, Progress, ScrollArea, Select, Stack, Text, TextInput, Title } from "@mantine/core";
import { useQueryClient } from "@tanstack/react-query";
import { useEffect, useState } from "react";
import { scanKeys, useScanCollections, type ScansAdded } from "../../api/scans";
import type { Side } from "../../api/types";
import { formatBytes, formatCount } from "../../model/format";
import { endScanUpload, sendChosenScans, useScanUpload } from "../../state/scanUpload";

const ASK = "";

function Result({ result, onDone }: { result: ScansAdded; onDone: () => void }) {
  return (
    <Stack gap="md">
      <Text size="sm">
        {formatCount(result.added.length, "scan")} added
        {result.known.length > 0 ? `, ${result.known.length} there already` : ""}
        {result.refused.length > 0 ? `, ${result.refused.length} refused` : ""}.
      </Text>
      {result.notes.map((note) => (
        <Text key={note} size="sm" className="quiet">
          {note}
        </Text>
      ))}
      {result.refused.length > 0 && (
        <ScrollArea.Autosize mah={240} tabIndex={0} aria-label="Refused files">
          <Stack gap="sm" role="alert">
            {result.refused.map(({ file, detail }) => (
              <div key={file} style={{ overflowWrap: "anywhere" }}>
                <Text size="sm" fw={600}>
                  {file}
                </Text>
                <Text size="xs" c="var(--bad-text)">
                  {detail.replace(`${file}: `, "")}
                </Text>
              </div>
            ))}
          </Stack>
        </ScrollArea.Autosize>
      )}
      <Group justify="flex-end">
        <Button onClick={onDone} data-autofocus>
          Done
        </Button>
      </Group>
    </Stack>
  );
}

/** What dropped scans do not say of themselves, then their way to the server, then what became of each. */
export function UploadDialog() {
  const upload = useScanUpload();
  const collections = useScanCollections().data ?? [];
  const client = useQueryClient();
  const [collection, setCollection] = useState("");
  const [subject, setSubject] = useState("");
  const [pose, setPose] = useState("");
  const [side, setSide] = useState<string>(ASK);
  const [unit, setUnit] = useState<string | number>("");
  const hasResult = Boolean(upload?.result);
  useEffect(() => {
    if (hasResult) void client.invalidateQueries({ queryKey: scanKeys.all });
  }, [hasResult, client]);
  if (!upload) return null;
  const isSending = upload.sent !== null && !upload.result;
  const send = (): void =>
    void sendChosenScans({
      ...(collection.trim() ? { collection: collection.trim() } : {}),
      ...(subject.trim() ? { subject: subject.trim() } : {}),
      ...(pose.trim() ? { pose: pose.trim() } : {}),
      ...(side === ASK ? {} : { side: side as Side }),
      ...(typeof unit === "number" && unit > 0 ? { metres_per_unit: unit } : {}),
    });
  return (
    <Modal opened onClose={endScanUpload} closeOnClickOutside={false} size={560} title={<Title order={2}>Add scans</Title>}>
      {upload.result ? (
        <Result result={upload.result} onDone={endScanUpload} />
      ) : isSending ? (
        <Stack gap="md">
          <Group gap="sm">
            {upload.sent === 1 && <Loader size="sm" />}
            <Text size="sm">{upload.sent === 1 ? "Every file is opened and checked." : `Sending ${formatCount(upload.files.length, "file")}, ${formatBytes(upload.bytes)}.`}</Text>
          </Group>
          <Progress value={100 * (upload.sent ?? 0)} animated={upload.sent === 1} aria-label="Part of the files sent" />
          <Group justify="flex-end">
            <Button variant="default" onClick={endScanUpload}>
              Cancel
            </Button>
          </Group>
        </Stack>
      ) : (
        <form
          onSubmit={(event) => {
            event.preventDefault();
            send();
          }}
        >
          <Stack gap="md">
            <Text size="sm" className="quiet">
              {formatCount(upload.files.length, "file")}, {formatBytes(upload.bytes)}. A scans.json among them says for each scan whose hand it is; the fields below hold for all others.
            </Text>
            <TextInput label="Collection" description="Scans that belong together" placeholder="scans" list="scan-collections" maxLength={200} value={collection} onChange={(event) => setCollection(event.currentTarget.value)} data-autofocus />
            <datalist id="scan-collections">
              {collections.map(({ name }) => (
                <option key={name} value={name} />
              ))}
            </datalist>
            <Group grow gap="md">
              <TextInput label="Subject" description="Whose hand" maxLength={100} value={subject} onChange={(event) => setSubject(event.currentTarget.value)} />
              <TextInput label="Pose" description="When all show the same" maxLength={100} value={pose} onChange={(event) => setPose(event.currentTarget.value)} />
            </Group>
            <Group grow gap="md" align="flex-start">
              <Select label="Hand" description="When it is known" data={[{ value: ASK, label: "Find out" }, { value: "right", label: "Right" }, { value: "left", label: "Left" }]} value={side} onChange={(value) => setSide(value ?? ASK)} allowDeselect={false} />
              <NumberInput label="Metres in one unit" description="0.001 for millimetres" placeholder="Find out" min={0} max={1000} decimalScale={9} value={unit} onChange={setUnit} />
            </Group>
            {upload.failure && (
              <Text size="sm" c="var(--bad-text)" role="alert" style={{ overflowWrap: "anywhere" }}>
                {upload.failure.message} Nothing was stored; try again.
              </Text>
            )}
            <Group justify="flex-end" gap="sm">
              <Button variant="default" onClick={endScanUpload}>
                Cancel
              </Button>
              <Button type="submit">Add {formatCount(upload.files.length, "file")}</Button>
            </Group>
          </Stack>
        </form>
      )}
    </Modal>
  );
}
