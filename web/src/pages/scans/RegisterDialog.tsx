import { Radio, Select, Stack, Text } from "@mantine/core";
import { FormDialog } from "../parts/Dialog";
import { useState } from "react";
import { useNavigate } from "react-router";
import { useHandModels } from "../../api/handModels";
import { mayStart, useJobCheck } from "../../api/jobChecks";
import { useStartJob, type RegisterWish } from "../../api/startJob";
import { formatCount } from "../../model/format";

interface RegisterDialogProps {
  isOpen: boolean;
  onClose: () => void;
  /** These scans; none are all of the collection. */
  scanIds: readonly string[];
  collection?: string | undefined;
  /** The model that is offered first; without one the newest trained. */
  modelId?: string | undefined;
}

const ONLY = [
  { value: "new", label: "Scans that this model has not registered with their present crop" },
  { value: "not_accepted", label: "Scans whose newest registration nobody has accepted" },
  { value: "all", label: "All, again" },
] as const;

/** Start registering: which scans, by which model. */
export function RegisterDialog({ isOpen, onClose, scanIds, collection, modelId }: RegisterDialogProps) {
  const models = (useHandModels().data ?? []).filter((model) => model.registers);
  const start = useStartJob();
  const navigate = useNavigate();
  const [model, setModel] = useState<string | null>(null);
  const [only, setOnly] = useState<string>("new");
  const newest = models.filter((one) => one.kind === "trained").sort((a, b) => (b.created_at ?? "").localeCompare(a.created_at ?? ""))[0];
  const chosen = model ?? modelId ?? newest?.id ?? models[0]?.id ?? "";
  const wish: RegisterWish = {
    kind: "register",
    ...(scanIds.length > 0 ? { scan_ids: [...scanIds], only: "all" } : { only: only as "new" }),
    ...(scanIds.length === 0 && collection ? { collection } : {}),
    ...(chosen ? { model_id: chosen } : {}),
  };
  const check = useJobCheck(wish, isOpen && chosen !== "");
  const submit = (): void => start.mutate(wish, { onSuccess: (job) => void navigate(`/jobs/${job.id}`) });
  return (
    <FormDialog title="Register scans" size={560} isOpen={isOpen} onClose={onClose} onSubmit={submit} verb="Register" isBusy={start.isPending} isReady={mayStart(check)} check={check.data} failure={start.error}>
      <Text size="sm" className="quiet">
        The template of a hand model is fitted to every scan, without a manual start. The program judges each result; then people accept or reject it.
      </Text>
      <Select
        label="Hand model"
        value={chosen}
        allowDeselect={false}
        data={models.map((one) => ({ value: one.id, label: one.round > 0 ? `${one.name} (round ${one.round})` : one.name }))}
        onChange={setModel}
      />
      {scanIds.length > 0 ? (
        <Text size="sm">{formatCount(scanIds.length, "chosen scan")}.</Text>
      ) : (
        <Radio.Group label={collection ? `Scans of “${collection}”` : "Scans of every collection"} value={only} onChange={setOnly}>
          <Stack gap="sm" mt="sm">
            {ONLY.map(({ value, label }) => (
              <Radio key={value} value={value} label={label} />
            ))}
          </Stack>
        </Radio.Group>
      )}
    </FormDialog>
  );
}
