import { Circle, Group, Line, Rect } from "./shapes";
import type { Side } from "../api/types";
import { EDGES } from "../model/joints";
import { isPlaced, type Pose } from "../model/pose";
import type { SuggestedJoint } from "../model/suggestion";
import { toScreen, type View } from "./view";

interface SuggestShapeProps {
  /** What can be accepted; null where nothing is proposed. */
  open: readonly (SuggestedJoint | null)[];
  /** What is there already, for the lines to it. */
  pose: Pose | undefined;
  hand: Side;
  view: View;
  /** The joint that one key would accept, or -1. */
  active: number;
}

const VIOLET = "#b08cff";

/** What a machine proposes: violet, dashed and small, so that it is never taken for a mark; joints it takes for hidden are hollow. */
export function SuggestShape({ open, pose, hand, view, active }: SuggestShapeProps) {
  const at = open.map((joint, index) => {
    const placed = pose?.[index];
    if (joint) return toScreen(view, { x: joint.px[0], y: joint.px[1] });
    return isPlaced(placed) ? toScreen(view, placed) : null;
  });
  return (
    <Group listening={false}>
      {EDGES.map(([from, to]) => {
        const [a, b] = [at[from], at[to]];
        if (!a || !b || (!open[from] && !open[to])) return null;
        const points = [a.x, a.y, b.x, b.y];
        return (
          <Group key={`${from}-${to}`}>
            <Line points={points} stroke="#000" strokeWidth={3.5} opacity={0.4} />
            <Line points={points} stroke={VIOLET} strokeWidth={2} dash={[5, 4]} />
          </Group>
        );
      })}
      {open.map((joint, index) => {
        const place = at[index];
        if (!joint || !place) return null;
        const fill = joint.guess === "visible" ? VIOLET : "rgba(0,0,0,0.45)";
        const style = { fill, stroke: joint.guess === "visible" ? "#1c1430" : VIOLET, strokeWidth: joint.guess === "visible" ? 1 : 1.5 };
        return (
          <Group key={index}>
            {index === active && <Circle {...place} radius={8} stroke={VIOLET} strokeWidth={2} dash={[4, 3]} />}
            {hand === "right" ? <Circle {...place} radius={3.25} {...style} /> : <Rect x={place.x - 3} y={place.y - 3} width={6} height={6} {...style} />}
          </Group>
        );
      })}
    </Group>
  );
}
