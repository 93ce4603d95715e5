import { Group, NumberInput, Radio, Select, Stack, Text, TextInput } from "@mantine/core";
import { FormDialog } from "../parts/Dialog";
import { useState } from "react";
import { useNavigate } from "react-router";
import type { Evaluate, HandModel } from "../../api/handModels";
import { mayStart, useJobCheck } from "../../api/jobChecks";
import { useStartJob, type LoopWish } from "../../api/startJob";
import { useScanCollections } from "../../api/scans";
import { EvaluateChoice } from "./EvaluateChoice";
import { LeaveOut } from "./LeaveOut";
import { LOCAL_SHAPES, LocalShapesChoice } from "./LocalShapesChoice";
import { ToCurate } from "./ToCurate";

const EVERY = "";

/** The loop of the paper as one button: register, choose, train, register again. */
export function LoopDialog({ isOpen, onClose, model }: { isOpen: boolean; onClose: () => void; model?: HandModel | undefined }) {
  const collections = useScanCollections().data ?? [];
  const start = useStartJob();
  const navigate = useNavigate();
  const [name, setName] = useState(model?.name ?? "");
  const [by, setBy] = useState<"verdict" | "decisions">("verdict");
  const [rounds, setRounds] = useState(1);
  const [collection, setCollection] = useState(EVERY);
  const [leaveOut, setLeaveOut] = useState<string[]>([]);
  const [evaluate, setEvaluate] = useState<Evaluate>("quick");
  const [hasLocalShapes, setHasLocalShapes] = useState(false);
  const wish: LoopWish = {
    kind: "loop",
    name: name.trim() || "Hand model",
    by,
    rounds: by === "decisions" ? 1 : rounds,
    leave_out_subjects: leaveOut,
    evaluate: leaveOut.length > 0 ? evaluate : "no",
    ...(hasLocalShapes ? { options: { num_local_shapes: LOCAL_SHAPES } } : {}),
    ...(collection ? { collection } : {}),
    ...(model ? { model_id: model.id } : {}),
  };
  const check = useJobCheck(wish, isOpen);
  const submit = (): void => start.mutate(wish, { onSuccess: (job) => void navigate(`/jobs/${job.id}`) });
  return (
    <FormDialog title="Register, train, register again" size={600} isOpen={isOpen} onClose={onClose} onSubmit={submit} verb="Start" isBusy={start.isPending} isReady={mayStart(check)} check={check.data} failure={start.error} help={by === "decisions" ? <ToCurate collection={collection} /> : undefined}>
      <Text size="sm" className="quiet">
        {model ? `Scans are registered with ${model.name}` : "Scans are registered with the first model"}, a better one is trained from what is chosen, and all scans are registered again with that. It goes on when the browser is closed.
      </Text>
      <TextInput label="Name of the models" description="The round is added" placeholder="Hand model" maxLength={200} value={name} onChange={(event) => setName(event.currentTarget.value)} data-autofocus />
      <Radio.Group label="Learn from" value={by} onChange={(value) => setBy(value)}>
        <Stack gap="sm" mt="sm">
          <Radio value="verdict" label="What the program calls good, and nobody has rejected" />
          <Radio value="decisions" label="What people have accepted so far: one round, then its registrations wait for review" />
        </Stack>
      </Radio.Group>
      <Group grow gap="md" align="flex-start">
        <NumberInput label="Rounds" min={1} max={10} allowDecimal={false} value={by === "decisions" ? 1 : rounds} disabled={by === "decisions"} onChange={(value) => setRounds(Number(value) || 1)} />
        <Select label="Collection" allowDeselect={false} value={collection} data={[{ value: EVERY, label: "Every collection" }, ...collections.map((one) => one.name)]} onChange={(value) => setCollection(value ?? EVERY)} />
      </Group>
      <LeaveOut collections={collections} collection={collection} value={leaveOut} onChange={setLeaveOut} />
      <LocalShapesChoice value={hasLocalShapes} onChange={setHasLocalShapes} />
      <EvaluateChoice value={evaluate} onChange={setEvaluate} hasPeople={leaveOut.length > 0} />
    </FormDialog>
  );
}
