import { Autocomplete, Button, Group, Select, Skeleton, Stack, Text, TextInput } from "@mantine/core";
import { useEffect, useState } from "react";
import { scanKeys, useScanCollections, type ScansAdded, type ScansMeasured } from "../../api/scans";
import type { Side } from "../../api/types";
import { formatCount } from "../../model/format";
import { isGuess, judgeSize, unitOf, writeUnits, type UnitAnswers } from "../../model/scanUnit";
import { endScanUpload, measureChosenScans, sendChosenScans, useScanUpload } from "../../state/scanUpload";
import { FaultList } from "../parts/FaultList";
import { FilesDialog } from "../parts/FilesDialog";
import { limitsOf, SizeCheck } from "./SizeCheck";

const ASK = "";

const NO_ANSWERS: UnitAnswers = { all: null, own: {} };

/** Why the scans cannot be added yet; null when they can. */
function findFault(measured: ScansMeasured | null, answers: UnitAnswers, isConfirmed: boolean): string | null {
  if (!measured) return "The scans are still being measured.";
  if (measured.files.length === 0) return "None of these files is a scan.";
  const units = measured.files.map((one) => unitOf(one, answers));
  const unknown = units.filter((unit) => unit === null).length;
  if (unknown > 0) return `${formatCount(unknown, "scan")} without a unit: choose one.`;
  const bad = measured.files.filter((one, index) => judgeSize((units[index] ?? 0) * (one.size_units[0] ?? 0), limitsOf(measured)).state === "bad").length;
  if (bad > 0) return `${formatCount(bad, "scan has a size", "scans have a size")} that no hand has: correct the unit.`;
  if (!isConfirmed && measured.files.some((one) => isGuess(one, answers))) return "Confirm the guessed size, or choose the unit.";
  return null;
}

const Refused = ({ refused }: { refused: ScansAdded["refused"] }) => (
  <FaultList label="Refused files" faults={refused.map(({ file, detail }) => ({ name: file, detail: detail.replace(`${file}: `, "") }))} />
);

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
      {result.refused.length > 0 && <Refused refused={result.refused} />}
      <Group justify="flex-end">
        <Button onClick={onDone} data-autofocus>
          Done
        </Button>
      </Group>
    </Stack>
  );
}

/** What dropped scans do not say of themselves. */
export function UploadDialog() {
  const upload = useScanUpload();
  const collections = useScanCollections().data ?? [];
  const [collection, setCollection] = useState("");
  const [subject, setSubject] = useState("");
  const [pose, setPose] = useState("");
  const [side, setSide] = useState<string>(ASK);
  const [answers, setAnswers] = useState<UnitAnswers>(NO_ANSWERS);
  const [shown, setShown] = useState(0);
  const [isOnlyThis, setOnlyThis] = useState(false);
  const [isConfirmed, setConfirmed] = useState(false);
  const files = upload?.files;
  useEffect(() => {
    setAnswers(NO_ANSWERS);
    setShown(0);
    setOnlyThis(false);
    setConfirmed(false);
  }, [files]);
  if (!upload) return null;
  const { measured } = upload;
  const send = (): void =>
    void sendChosenScans({
      ...(collection.trim() ? { collection: collection.trim() } : {}),
      ...(subject.trim() ? { subject: subject.trim() } : {}),
      ...(pose.trim() ? { pose: pose.trim() } : {}),
      ...(side === ASK ? {} : { side: side as Side }),
      ...writeUnits(measured?.files ?? [], answers),
    });
  const fault = findFault(measured, answers, isConfirmed);
  return (
    <FilesDialog
      title="Add scans"
      size={720}
      upload={upload}
      hint="A scans.json among them says for each scan whose hand it is; the fields below hold for all others."
      reading="Every file is opened and checked."
      changes={scanKeys.all}
      onEnd={endScanUpload}
      note={
        measured &&
        fault && (
          <Text size="xs" className="quiet" mr="auto" maw={400}>
            {fault}
          </Text>
        )
      }
      onSend={fault === null ? send : null}
      verb={`Add ${measured ? formatCount(measured.files.length, "scan") : formatCount(upload.files.length, "file")}`}
      instead={upload.failure && !measured && <Button onClick={() => void measureChosenScans()}>Try again</Button>}
      result={(result) => <Result result={result} onDone={endScanUpload} />}
    >
      <Autocomplete label="Collection" openOnFocus={false} description="Scans that belong together" placeholder="scans" data={collections.map(({ name }) => name)} maxLength={200} value={collection} onChange={setCollection} data-autofocus />
      <Group grow gap="md">
        <Select label="Hand" description="When it is known" data={[{ value: ASK, label: "Find out" }, { value: "right", label: "Right" }, { value: "left", label: "Left" }]} value={side} onChange={(value) => setSide(value ?? ASK)} allowDeselect={false} />
        <TextInput label="Subject" description="Whose hand" maxLength={100} value={subject} onChange={(event) => setSubject(event.currentTarget.value)} />
        <TextInput label="Pose" description="When all show the same" maxLength={100} value={pose} onChange={(event) => setPose(event.currentTarget.value)} />
      </Group>
      {measured ? (
        <SizeCheck
          measured={measured}
          answers={answers}
          shown={shown}
          isOnlyThis={isOnlyThis}
          isConfirmed={isConfirmed}
          onAnswers={setAnswers}
          onShow={setShown}
          onOnlyThis={setOnlyThis}
          onConfirm={setConfirmed}
        />
      ) : (
        !upload.failure && <Skeleton height={296} role="status" aria-label="The scans are measured" />
      )}
      {measured && measured.refused.length > 0 && <Refused refused={measured.refused} />}
    </FilesDialog>
  );
}
