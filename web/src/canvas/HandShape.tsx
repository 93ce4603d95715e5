import { memo } from "react";
import { Circle, Group, Line, Rect, Text } from "./shapes";
import type { Side } from "../api/types";
import { EDGES, HAND_COLORS, jointColor, jointLabel } from "../model/joints";
import { isPlaced, isShown, type Pose, type Visibility } from "../model/pose";
import { toScreen, type Point, type View } from "./view";

interface HandShapeProps {
  pose: Pose;
  hand: Side;
  view: View;
  /** The joint to mark, or -1. */
  active: number;
  isFaint?: boolean;
  areNamesShown?: boolean;
}

const RADIUS = 5;

function Mark({ hand, x, y, radius, ...style }: { hand: Side; x: number; y: number; radius: number; fill?: string; stroke: string; strokeWidth: number; dash?: number[] }) {
  return hand === "right" ? (
    <Circle x={x} y={y} radius={radius} {...style} />
  ) : (
    <Rect x={x - radius * 0.9} y={y - radius * 0.9} width={radius * 1.8} height={radius * 1.8} {...style} />
  );
}

/** Where a joint was before it went outside, so that it can be fetched back. */
function Cross({ x, y, color }: { x: number; y: number; color: string }) {
  const arm = RADIUS - 1;
  return (
    <Group x={x} y={y} opacity={0.85}>
      {[
        [-arm, -arm, arm, arm],
        [arm, -arm, -arm, arm],
      ].flatMap((points) => [
        <Line key={`under ${points.join()}`} points={points} stroke="#000" strokeWidth={4} lineCap="round" opacity={0.6} />,
        <Line key={points.join()} points={points} stroke={color} strokeWidth={2} lineCap="round" />,
      ])}
    </Group>
  );
}

interface BoneProps {
  from: Point;
  to: Point;
  color: string;
  isHidden: boolean;
}

const Bone = memo(function Bone({ from, to, color, isHidden }: BoneProps) {
  const points = [from.x, from.y, to.x, to.y];
  return (
    <Group>
      <Line points={points} stroke="#000" strokeWidth={4} opacity={0.45} lineCap="round" />
      <Line points={points} stroke={color} strokeWidth={2} lineCap="round" {...(isHidden ? { dash: [5, 5] } : {})} />
    </Group>
  );
}, sameBone);

const samePoint = (a: Point, b: Point): boolean => a.x === b.x && a.y === b.y;

function sameBone(a: BoneProps, b: BoneProps): boolean {
  return samePoint(a.from, b.from) && samePoint(a.to, b.to) && a.color === b.color && a.isHidden === b.isHidden;
}

interface JointProps {
  joint: number;
  x: number;
  y: number;
  visibility: Visibility;
  hand: Side;
  isActive: boolean;
  hasName: boolean;
}

const Joint = memo(function Joint({ joint, x, y, visibility, hand, isActive, hasName }: JointProps) {
  const isOccluded = visibility === 1;
  const color = jointColor(joint);
  return (
    <Group>
      {isActive && <Mark hand={hand} x={x} y={y} radius={RADIUS + 5} stroke={HAND_COLORS[hand]} strokeWidth={2.5} />}
      {visibility === 0 ? (
        <Cross x={x} y={y} color={color} />
      ) : (
        <Mark
          hand={hand}
          x={x}
          y={y}
          radius={RADIUS}
          fill={isOccluded ? "rgba(0,0,0,0.35)" : color}
          stroke={isOccluded ? color : "#111"}
          strokeWidth={isOccluded ? 2 : 1.25}
          {...(isOccluded ? { dash: [3, 2.5] } : {})}
        />
      )}
      {hasName && (
        <Text x={x + 9} y={y - 6} text={jointLabel(joint)} fontSize={12} fontFamily="Inter Variable, sans-serif" fill="#fff" stroke="#000" strokeWidth={3} fillAfterStrokeEnabled />
      )}
    </Group>
  );
});

/**
 * A hand by hand: fingers in their hues; the right one round, the left one square; occluded joints hollow and dashed, outside
 * ones crosses where they were. A drag draws the joint that moves and its bones again, and nothing else of the hand.
 */
export function HandShape({ pose, hand, view, active, isFaint = false, areNamesShown = false }: HandShapeProps) {
  const at = pose.map((point) => toScreen(view, point));
  return (
    <Group opacity={isFaint ? 0.45 : 1} listening={false}>
      {EDGES.map(([from, to]) => {
        const [a, b] = [at[from], at[to]];
        if (!a || !b || !isPlaced(pose[from]) || !isPlaced(pose[to])) return null;
        return <Bone key={`${from}-${to}`} from={a} to={b} color={jointColor(to)} isHidden={pose[from]?.v === 1 || pose[to]?.v === 1} />;
      })}
      {pose.map((point, joint) => {
        const place = at[joint];
        if (!place || !isShown(point)) return null;
        return <Joint key={joint} joint={joint} x={place.x} y={place.y} visibility={point.v} hand={hand} isActive={joint === active} hasName={areNamesShown} />;
      })}
    </Group>
  );
}

/** Another version of a hand, to compare with: violet and dashed, as everything that is only suggested. */
export function GhostShape({ pose, view }: { pose: Pose; view: View }) {
  const at = pose.map((point) => toScreen(view, point));
  return (
    <Group listening={false}>
      {EDGES.map(([from, to]) => {
        const [a, b] = [at[from], at[to]];
        if (!a || !b || !isPlaced(pose[from]) || !isPlaced(pose[to])) return null;
        return <Line key={`${from}-${to}`} points={[a.x, a.y, b.x, b.y]} stroke="#b08cff" strokeWidth={2} dash={[6, 4]} />;
      })}
      {pose.map((point, joint) => {
        const place = at[joint];
        return place && isPlaced(point) ? <Circle key={joint} {...place} radius={4} stroke="#b08cff" strokeWidth={2} dash={[3, 2]} /> : null;
      })}
    </Group>
  );
}
