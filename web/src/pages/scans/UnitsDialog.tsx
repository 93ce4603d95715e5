import { Text } from "@mantine/core";
import { FormDialog } from "../parts/Dialog";
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
    <FormDialog
      title={`Unit of ${formatCount(scans.length, "scan")}`}
      size={560}
      onClose={onClose}
      onSubmit={() => unit !== null && change.mutate({ scans, metresPerUnit: unit }, { onSuccess: onClose })}
      verb="Set the unit"
      isBusy={change.isPending}
      isReady={unit !== null && bad.length === 0}
      failure={change.error}
      failed="The scans before it have the new unit."
    >
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
    </FormDialog>
  );
}
