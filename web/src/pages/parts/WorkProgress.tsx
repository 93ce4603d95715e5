import { Progress, type ProgressRootProps } from "@mantine/core";

interface WorkProgressProps extends Pick<ProgressRootProps, "w" | "size" | "my"> {
  done: number;
  /** Begun, and not done. */
  partial: number;
  total: number;
}

/** Frames done, solid, and behind them those that were begun, striped. */
export function WorkProgress({ done, partial, total, ...look }: WorkProgressProps) {
  const share = (count: number): number => (100 * count) / Math.max(1, total);
  return (
    <Progress.Root {...look}>
      <Progress.Section value={share(done)} aria-label={`${done} of ${total} frames done`} />
      {partial > 0 && <Progress.Section value={share(partial)} striped color="teal.3" aria-label={`${partial} of ${total} frames begun`} />}
    </Progress.Root>
  );
}

export const workText = (done: number, partial: number, total: number): string => `${done} of ${total} ${total === 1 ? "frame" : "frames"} done${partial > 0 ? `, ${partial} begun` : ""}`;
