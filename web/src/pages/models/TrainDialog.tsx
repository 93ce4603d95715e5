import { Checkbox, Group, Radio, Select, Stack, Text, TextInput } from "@mantine/core";
import { FormDialog } from "../parts/Dialog";
import { useDebouncedValue } from "@mantine/hooks";
import { useState } from "react";
import { useNavigate } from "react-router";
import { useHandModels, useTrainingPreview, type Evaluate, type TrainingRule } from "../../api/handModels";
import { mayStart, useJobCheck } from "../../api/jobChecks";
import { useStartJob, type TrainWish } from "../../api/startJob";
import { useScanCollections } from "../../api/scans";
import { formatCount } from "../../model/format";
import { EvaluateChoice } from "./EvaluateChoice";
import { LeaveOut } from "./LeaveOut";
import { LOCAL_SHAPES, LocalShapesChoice } from "./LocalShapesChoice";
import { ToCurate } from "./ToCurate";

const EVERY = "";

interface TrainDialogProps {
  isOpen: boolean;
  onClose: () => void;
  /** Begin from this model's registrations only. */
  modelId?: string | undefined;
}

/** Which registrations to learn from, under which name; what they are is kept for good before training begins. */
export function TrainDialog({ isOpen, onClose, modelId }: TrainDialogProps) {
  const collections = useScanCollections().data ?? [];
  const models = useHandModels().data ?? [];
  const train = useStartJob();
  const navigate = useNavigate();
  const [name, setName] = useState("");
  const [by, setBy] = useState<"decisions" | "verdict">("decisions");
  const [needsTwo, setNeedsTwo] = useState(false);
  const [collection, setCollection] = useState(EVERY);
  const [leaveOut, setLeaveOut] = useState<string[]>([]);
  const [evaluate, setEvaluate] = useState<Evaluate>("quick");
  const [hasLocalShapes, setHasLocalShapes] = useState(false);
  const rule: TrainingRule = {
    by,
    collections: collection ? [collection] : [],
    needs_two: needsTwo && by === "decisions",
    verdicts: [],
    leave_out_subjects: leaveOut,
    ...(modelId ? { model_id: modelId } : {}),
  };
  const [settled] = useDebouncedValue(rule, 200);
  const preview = useTrainingPreview(settled, isOpen);
  const model = models.find((one) => one.id === modelId);
  const wish: TrainWish = {
    kind: "train",
    rule,
    name: name.trim() || "Hand model",
    ...(hasLocalShapes ? { options: { num_local_shapes: LOCAL_SHAPES } } : {}),
    ...(leaveOut.length > 0 ? { evaluate, test_subjects: leaveOut } : {}),
    ...(modelId ? { model_id: modelId } : {}),
  };
  const check = useJobCheck(wish, isOpen);
  const submit = (): void => train.mutate(wish, { onSuccess: (job) => void navigate(`/jobs/${job.id}`) });
  return (
    <FormDialog title="Train a hand model" size={600} isOpen={isOpen} onClose={onClose} onSubmit={submit} verb="Train" isBusy={train.isPending} isReady={mayStart(check)} check={check.data} failure={train.error} help={by === "decisions" ? <ToCurate collection={collection} /> : undefined}>
      <TextInput label="Name of the model" placeholder="Hand model" maxLength={200} value={name} onChange={(event) => setName(event.currentTarget.value)} data-autofocus />
      <Radio.Group label="Learn from" value={by} onChange={(value) => setBy(value)}>
        <Stack gap="sm" mt="sm">
          <Radio value="decisions" label="What people have accepted" />
          <Radio value="verdict" label="What the program itself calls good, and nobody has rejected" />
        </Stack>
      </Radio.Group>
      {by === "decisions" && <Checkbox label="Only what two people have accepted" checked={needsTwo} onChange={(event) => setNeedsTwo(event.currentTarget.checked)} />}
      <Group grow gap="md" align="flex-start">
        <Select
          label="Collection"
          allowDeselect={false}
          value={collection}
          data={[{ value: EVERY, label: "Every collection" }, ...collections.map((one) => one.name)]}
          onChange={(value) => setCollection(value ?? EVERY)}
        />
        <LeaveOut collections={collections} collection={collection} value={leaveOut} onChange={setLeaveOut} />
      </Group>
      <LocalShapesChoice value={hasLocalShapes} onChange={setHasLocalShapes} />
      <EvaluateChoice value={evaluate} onChange={setEvaluate} hasPeople={leaveOut.length > 0} />
      {model && (
        <Text size="sm" className="quiet">
          Only registrations by {model.name}.
        </Text>
      )}
      <Text size="sm" role="status" fw={600}>
        {preview.data
          ? `${formatCount(preview.data.registrations, "registration")} of ${formatCount(preview.data.subjects, "subject")}, ${preview.data.mirrored} of left hands; ${preview.data.undecided} are still undecided.`
          : preview.error
            ? preview.error.message
            : "Counting …"}
      </Text>
    </FormDialog>
  );
}
