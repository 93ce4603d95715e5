import { Group, Select, Text } from "@mantine/core";
import { Link } from "react-router";
import { useCalibrations } from "../../api/calibrations";
import { useTakeCameras } from "../../api/imports";
import type { Import } from "../../api/types";
import { formatAgo, formatCount } from "../../model/format";
import { Refusal } from "../parts/Refusal";

const OWN = "";

/** For videos of several cameras: the cameras of a calibration that was made in the studio, instead of a file beside them. */
export function TakenCameras({ checked }: { checked: Import }) {
  const finished = useCalibrations().data?.filter(({ result }) => result !== null) ?? [];
  const take = useTakeCameras(checked.id);
  const taken = checked.calibration_id ?? OWN;
  const choices = finished.map(({ id, name, result, created_at: made }) => ({ value: id, label: `${name}: ${formatCount(result?.cameras.length ?? 0, "camera")}, ${formatAgo(made)}` }));
  return (
    <section className="card" style={{ padding: 16 }} aria-label="Cameras of these videos">
      <Group align="flex-end" gap="md">
        <Select
          label="Cameras of these videos"
          description="A calibration made in the studio, with the same names or the same order of cameras, or a file that came along"
          data={[{ value: OWN, label: "As the files say" }, ...choices]}
          value={taken}
          allowDeselect={false}
          disabled={take.isPending}
          flex={1}
          onChange={(value) => value !== null && take.mutate(value === OWN ? null : value)}
        />
        <Text size="sm" pb={8}>
          <Link to="/calibrations/new" style={{ color: "var(--accent-text)" }}>
            Calibrate cameras from a filmed board
          </Link>
        </Text>
      </Group>
      {take.error && <Refusal error={take.error} after="Nothing was changed." />}
    </section>
  );
}
