import { Button, Group, Modal, Stack, Text, Title } from "@mantine/core";
import { useState } from "react";
import { scanThumbnailUrl, useChangeUnits, type Scan } from "../../api/scans";
import { formatCount, formatRough } from "../../model/format";
import { formatUnit, judgeSize } from "../../model/scanUnit";
import { HandForScale } from "./HandForScale";
import { UnitField } from "./UnitField";

const FILLED = 0.88;

/** One unit for several scans, shown by the first of them beside a hand. */
export function UnitsDialog({ scans, onClose }: { scans: readonly Scan[]; onClose: () => void }) {
  const change = useChangeUnits();
  const [unit, setUnit] = useState<number | null>(scans[0]?.metres_per_unit ?? null);
  const known = scans.filter((scan) => scan.metres_per_unit !== null);
  const one = known[0];
  const lengthOf = (scan: Scan): number => ((unit ?? 0) / (scan.metres_per_unit ?? 1)) * (scan.size_m[0] ?? 0);
  const bad = known.filter((scan) => judgeSize(lengthOf(scan)).state === "bad");
  const registered = scans.filter((scan) => scan.registration && scan.metres_per_unit !== unit).length;
  return (
    <Modal opened onClose={onClose} size={560} title={<Title order={2}>Unit of {formatCount(scans.length, "scan")}</Title>}>
      <Stack gap="md">
        {one && unit !== null && (
          <>
            <Text size="sm" className="one-line">
              {one.name}, with {formatUnit(unit)}:
            </Text>
            <HandForScale picture={scanThumbnailUrl(one)} pictureSide={lengthOf(one) / FILLED} length={lengthOf(one)} />
          </>
        )}
        <UnitField value={unit} units={one?.metres_per_unit ? (one.size_m[0] ?? 0) / one.metres_per_unit : null} onChange={setUnit} />
        {registered > 0 && (
          <Text size="sm" className="quiet">
            {formatCount(registered, "scan is", "scans are")} registered at another size: these registrations no longer count.
          </Text>
        )}
        {bad.length > 0 && (
          <Text size="sm" c="var(--bad-text)" role="status">
            {formatCount(bad.length, "scan", "scans")} would have a size that no hand has, such as {bad[0]?.name}: {formatRough(100 * lengthOf(bad[0] as Scan))} cm.
          </Text>
        )}
        {change.error && (
          <Text size="sm" c="var(--bad-text)" role="alert" style={{ overflowWrap: "anywhere" }}>
            {change.error.message} The scans before it have the new unit.
          </Text>
        )}
        <Group justify="flex-end" gap="sm">
          <Button variant="default" onClick={onClose}>
            Cancel
          </Button>
          <Button disabled={unit === null || bad.length > 0} loading={change.isPending} onClick={() => unit !== null && change.mutate({ scans, metresPerUnit: unit }, { onSuccess: onClose })}>
            Set the unit
          </Button>
        </Group>
      </Stack>
    </Modal>
  );
}
