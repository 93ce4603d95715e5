import { Button, Collapse, Group, Select, Stack, Text, Title } from "@mantine/core";
import { useDisclosure } from "@mantine/hooks";
import { IconUpload } from "@tabler/icons-react";
import { useEffect, useRef, useState } from "react";
import { readChoice, readDrop } from "../../actions/readDrop";
import type { DroppedFile } from "../../api/imports";
import { useCheckLabels, useLabelFormats, type LabelImportOptions } from "../../api/labels";
import type { Recording } from "../../api/types";
import { formatCount } from "../../model/format";
import classes from "./LabelsPage.module.css";
import { LabelReport } from "./LabelReport";
import { Refusal } from "../parts/Refusal";

const ANY = "";

/** Labels out of other programs: dropped on the page, looked at, then taken in when somebody says so. */
export function ImportCard({ recording }: { recording: Recording }) {
  const formats = useLabelFormats().data;
  const check = useCheckLabels(recording.id);
  const [files, setFiles] = useState<readonly DroppedFile[]>([]);
  const [options, setOptions] = useState<LabelImportOptions>({});
  const [areOptionsShown, optionsShown] = useDisclosure(false);
  const [isOver, setOver] = useState(false);
  const input = useRef<HTMLInputElement>(null);
  const { mutate } = check;

  const look = (chosen: readonly DroppedFile[], wanted: LabelImportOptions): void => {
    if (chosen.length === 0) return;
    setFiles(chosen);
    mutate({ files: chosen, options: wanted });
  };
  const latest = useRef({ look, options });
  latest.current = { look, options };

  useEffect(() => {
    const holdsFiles = (event: DragEvent): boolean => event.dataTransfer?.types.includes("Files") ?? false;
    const over = (event: DragEvent): void => {
      if (!holdsFiles(event)) return;
      event.preventDefault();
      setOver(true);
    };
    const leave = (event: DragEvent): void => {
      if (!event.relatedTarget) setOver(false);
    };
    const drop = (event: DragEvent): void => {
      if (!holdsFiles(event) || !event.dataTransfer) return;
      event.preventDefault();
      setOver(false);
      void readDrop(event.dataTransfer).then((found) => latest.current.look(found, latest.current.options));
    };
    window.addEventListener("dragover", over);
    window.addEventListener("dragleave", leave);
    window.addEventListener("drop", drop);
    return () => {
      window.removeEventListener("dragover", over);
      window.removeEventListener("dragleave", leave);
      window.removeEventListener("drop", drop);
    };
  }, []);

  const change = (patch: LabelImportOptions): void => {
    const next = { ...options, ...patch };
    setOptions(next);
    look(files, next);
  };
  const forget = (): void => {
    setFiles([]);
    check.reset();
  };

  return (
    <section className="card" aria-label="Import" style={{ padding: 16 }} data-takes-drops>
      <Stack gap="sm">
        <Title order={2}>Import</Title>
        <button type="button" className={classes.drop} data-over={isOver} onClick={() => input.current?.click()}>
          <IconUpload size={24} stroke={1.5} aria-hidden />
          <Text size="sm" fw={600}>
            {isOver ? "Drop to check the labels" : files.length > 0 ? formatCount(files.length, "file") : "Drop labels on this page, or choose files"}
          </Text>
          <Text size="xs" className="quiet" ta="center">
            COCO, COCO-WholeBody, FreiHAND, InterHand2.6M, DeepLabCut CSV, T16, annotations.json, or a .zip. Nothing is stored before you confirm.
          </Text>
        </button>
        <input ref={input} type="file" multiple hidden aria-label="Choose labels to import" data-testid="choose-labels" onChange={(event) => {
          const chosen = event.target.files ? readChoice(event.target.files) : [];
          event.target.value = "";
          look(chosen, options);
        }} />
        <Button size="compact-sm" variant="subtle" onClick={optionsShown.toggle} aria-expanded={areOptionsShown} style={{ alignSelf: "flex-start" }}>
          What the files may not say
        </Button>
        <Collapse expanded={areOptionsShown}>
          <Stack gap="sm">
            <Select label="Format" data={[{ value: ANY, label: "Recognise it" }, ...(formats?.items ?? []).map((item) => ({ value: item.name, label: item.title }))]} value={options.format ?? ANY} onChange={(value) => change({ format: value || null })} allowDeselect={false} />
            <Group grow gap="sm">
              <Select label="Hand" data={[{ value: ANY, label: "In the files" }, { value: "right", label: "Right" }, { value: "left", label: "Left" }]} value={options.hand ?? ANY} onChange={(value) => change({ hand: (value || null) })} allowDeselect={false} />
              <Select label="Camera" data={[{ value: ANY, label: "In the files" }, ...recording.cameras.map((camera) => ({ value: camera.id, label: camera.id }))]} value={options.camera ?? ANY} onChange={(value) => change({ camera: value || null })} allowDeselect={false} />
            </Group>
            <Group grow gap="sm">
              <Select label="Top-left pixel's centre" data={[{ value: ANY, label: "The format's" }, { value: "0", label: "0" }, { value: "0.5", label: "0.5" }]} value={options.pixel_centre === null || options.pixel_centre === undefined ? ANY : String(options.pixel_centre)} onChange={(value) => change({ pixel_centre: value ? (Number(value) as 0 | 0.5) : null })} allowDeselect={false} />
              <Select label="Joints' order" data={[{ value: ANY, label: "In the files" }, ...(formats?.joint_orders ?? []).map((order) => ({ value: order, label: order }))]} value={options.joint_order ?? ANY} onChange={(value) => change({ joint_order: value || null })} allowDeselect={false} />
            </Group>
          </Stack>
        </Collapse>
        {check.isPending && (
          <Text size="sm" className="quiet" role="status">
            Checking the labels …
          </Text>
        )}
        {check.error && (
          <Refusal error={check.error} after="Nothing was stored." />
        )}
        {check.data && !check.isPending && <LabelReport recording={recording} report={check.data} upload={{ files, options }} onDone={forget} onStale={() => look(files, options)} />}
      </Stack>
    </section>
  );
}
