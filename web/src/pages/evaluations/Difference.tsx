import { Text, Tooltip } from "@mantine/core";
import type { PairedDifference } from "../../api/evaluations";
import { formatCount } from "../../model/format";

const signed = (value: number): string => `${value > 0 ? "+" : value < 0 ? "−" : ""}${Math.abs(value).toFixed(2)}`;

/** How far a track is from the reference, and whether that can be chance. */
export function Difference({ paired }: { paired: PairedDifference }) {
  const verdict = paired.high < 0 ? "better" : paired.low > 0 ? "worse" : "no difference seen";
  const color = verdict === "better" ? "var(--object-text)" : verdict === "worse" ? "var(--bad-text)" : undefined;
  const about = `${paired.mean.toFixed(2)} against ${paired.reference_mean.toFixed(2)} px over ${formatCount(paired.joints, "joint")} of ${formatCount(paired.frames, "frame")} that both have; nearer in ${(100 * paired.better).toFixed(0)} %`;
  return (
    <Tooltip label={about} multiline maw={320}>
      <div tabIndex={0}>
        <Text size="sm" fw={600} c={color}>
          <span className="one-line">{signed(paired.difference)} px,</span> {verdict}
        </Text>
        <Text size="xs" className="quiet one-line">
          95 %: {signed(paired.low)} to {signed(paired.high)}
        </Text>
      </div>
    </Tooltip>
  );
}
