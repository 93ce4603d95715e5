import { Group, NumberInput, Radio, Select, Stack, Switch, Text } from "@mantine/core";
import { useState } from "react";
import { mayStart, useJobCheck } from "../../api/jobChecks";
import { usePersonModels, type MovingRegistration, type MovingScan, type Prior } from "../../api/movingScans";
import { useStartJob, type RegisterMovingWish } from "../../api/startJob";
import { formatCount } from "../../model/format";
import type { Stretch } from "../../model/stretch";
import { FormDialog } from "../parts/Dialog";
import { PRIORS } from "./priors";

interface RegisterMovingDialogProps {
  scan: MovingScan;
  /** Go on from this registration; null begins anew. */
  parent: MovingRegistration | null;
  /** Frames that are offered first. */
  frames: Stretch;
  onClose: () => void;
  onStarted: (jobId: string) => void;
}

/** Frames of a chunk that are offered first. */
const CHUNK = 50;

const POPULATIONS = [
  { value: "neutral", label: "Everybody" },
  { value: "female", label: "Women" },
  { value: "male", label: "Men" },
];

/** Another prior than a registration had is what one wants to try. */
const otherThan = (prior: Prior): Prior => (prior === "mixture" ? "gaussian" : "mixture");

/** Lay the body onto the frames, from the first on or from a frame of an earlier registration on. */
export function RegisterMovingDialog({ scan, parent, frames, onClose, onStarted }: RegisterMovingDialogProps) {
  const start = useStartJob();
  const [first, setFirst] = useState<number | string>(frames.first);
  const [last, setLast] = useState<number | string>(frames.last);
  const [prior, setPrior] = useState<Prior>(parent ? otherThan(parent.prior) : "mixture");
  const [population, setPopulation] = useState<string>("neutral");
  const models = usePersonModels(scan.id).data ?? [];
  const [model, setModel] = useState("");
  const [holds, setHolds] = useState(true);
  const [hasVelocity, setVelocity] = useState(true);
  const [chunk, setChunk] = useState<number | string>(CHUNK);
  const isWhole = [first, last, chunk].every((value) => typeof value === "number");
  const wish: RegisterMovingWish = {
    kind: "register_moving",
    moving_scan_id: scan.id,
    first_frame: Number(first),
    last_frame: Number(last),
    prior,
    holds_hands: holds,
    has_velocity: hasVelocity,
    chunk_frames: Number(chunk),
    ...(parent ? { parent_id: parent.id } : model ? { person_model_id: model } : { population: population as "neutral" }),
  };
  const check = useJobCheck(wish, isWhole);
  const submit = (): void => start.mutate(wish, { onSuccess: (job) => onStarted(job.id) });
  const most = scan.frame_count - 1;
  return (
    <FormDialog
      title={parent ? `Register again from frame ${frames.first}` : "Register the moving scan"}
      size={560}
      onClose={onClose}
      onSubmit={submit}
      verb="Register"
      isBusy={start.isPending}
      isReady={isWhole && mayStart(check)}
      check={check.data}
      failure={start.error}
    >
      <Text size="sm" className="quiet">
        {parent
          ? `The person’s own model and the frame before are those of registration ${parent.number}. It stays as it is; the new one stands beside it.`
          : "The person’s own model is made from the first frames, unless there is one; then the body with both hands is laid onto every frame, each from where the one before ended."}
      </Text>
      <Group grow gap="md">
        <NumberInput label="First frame" min={0} max={most} allowDecimal={false} value={first} onChange={setFirst} />
        <NumberInput label="Last frame" min={0} max={most} allowDecimal={false} value={last} onChange={setLast} />
      </Group>
      <Radio.Group label="What hands are expected to do" value={prior} onChange={(value) => setPrior(value)}>
        <Stack gap="sm" mt="sm">
          {(Object.keys(PRIORS) as Prior[]).map((value) => (
            <Radio key={value} value={value} label={PRIORS[value].label.replace(/^./, (letter) => letter.toUpperCase())} description={PRIORS[value].help} />
          ))}
        </Stack>
      </Radio.Group>
      <Switch checked={holds} onChange={(event) => setHolds(event.currentTarget.checked)} label="A hand that a frame does not show keeps its pose" />
      <Switch checked={hasVelocity} onChange={(event) => setVelocity(event.currentTarget.checked)} label="The pose is held a little to that of the frame before" />
      <NumberInput
        label="Frames of a chunk"
        description="Free workers register chunks side by side; each is then joined to the one before without a seam. 0: all frames one after the other."
        min={0}
        max={5000}
        allowDecimal={false}
        value={chunk}
        onChange={setChunk}
      />
      {!parent && models.length > 0 && (
        <Select
          label="The person’s own model"
          data={[{ value: "", label: "Made from the first frames" }, ...models.map((one) => ({ value: one.id, label: `${one.name}, from ${formatCount(one.frame_count, "frame")}` }))]}
          value={model}
          allowDeselect={false}
          onChange={(value) => setModel(value ?? "")}
        />
      )}
      {!parent && !model && <Select label="Whose shapes the person’s is looked for among" data={POPULATIONS} value={population} allowDeselect={false} onChange={(value) => setPopulation(value ?? "neutral")} />}
    </FormDialog>
  );
}
