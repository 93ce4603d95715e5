import { Text } from "@mantine/core";
import type { ImportReport } from "../../api/types";
import { formatNumber } from "../../model/format";

/** Where the depth unit puts the scene, to see whether it is right; without a unit, where the usual ones would. */
export function DepthPreview({ report, hint }: { report: ImportReport; hint: string }) {
  const depth = report.cameras.find((camera) => camera.depth)?.depth;
  if (hint) {
    return (
      <Text size="sm" className="quiet">
        Depth unit: {hint.charAt(0).toLowerCase() + hint.slice(1)}
      </Text>
    );
  }
  if (!depth || depth.nearest_m === null || depth.nearest_m === undefined) return null;
  return (
    <Text size="sm" data-testid="depth-preview">
      The nearest thing is <b>{formatNumber(depth.nearest_m, 2)} m</b> away; depth reaches from {formatNumber(depth.percentiles_m[0], 2)} to {formatNumber(depth.percentiles_m.at(-1), 2)} m. Is that where the hand was?
    </Text>
  );
}
