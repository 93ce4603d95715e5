import { Button, Modal, Radio, Select, Stack, Text, Title } from "@mantine/core";
import { useState } from "react";
import { useNavigate } from "react-router";
import { useHandModels, useStartRegistering } from "../../api/handModels";
import { mayStart, useJobCheck } from "../../api/jobChecks";
import { formatCount } from "../../model/format";
import { FormFooter } from "../parts/Obstacles";

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
  { value: "new", label: "Those that this model has not registered as they are cropped now" },
  { value: "not_accepted", label: "Those whose newest registration nobody has accepted" },
  { value: "all", label: "All, again" },
] as const;

/** Start registering: which scans, by which model. */
export function RegisterDialog({ isOpen, onClose, scanIds, collection, modelId }: RegisterDialogProps) {
  const models = (useHandModels().data ?? []).filter((model) => model.registers);
  const start = useStartRegistering();
  const navigate = useNavigate();
  const [model, setModel] = useState<string | null>(null);
  const [only, setOnly] = useState<string>("new");
  const newest = models.filter((one) => one.kind === "trained").sort((a, b) => (b.created_at ?? "").localeCompare(a.created_at ?? ""))[0];
  const chosen = model ?? modelId ?? newest?.id ?? models[0]?.id ?? "";
  const wish = {
    ...(scanIds.length > 0 ? { scan_ids: [...scanIds], only: "all" as const } : { only: only as "new" }),
    ...(scanIds.length === 0 && collection ? { collection } : {}),
    ...(chosen ? { model_id: chosen } : {}),
  };
  const check = useJobCheck("/jobs/register", wish, isOpen && chosen !== "");
  const submit = (): void => start.mutate(wish, { onSuccess: (job) => void navigate(`/jobs/${job.id}`) });
  return (
    <Modal opened={isOpen} onClose={onClose} size={560} title={<Title order={2}>Register scans</Title>}>
      <form
        onSubmit={(event) => {
          event.preventDefault();
          submit();
        }}
      >
        <Stack gap="md">
          <Text size="sm" className="quiet">
            The template of a hand model is brought onto every scan, without a start by hand. The program judges each result; then people accept or reject it.
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
          <FormFooter check={check.data} failure={start.error}>
            <Button variant="default" onClick={onClose}>
              Cancel
            </Button>
            <Button type="submit" loading={start.isPending} disabled={!mayStart(check)}>
              Register
            </Button>
          </FormFooter>
        </Stack>
      </form>
    </Modal>
  );
}
