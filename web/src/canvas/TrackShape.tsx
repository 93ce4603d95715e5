import { Circle, Group, Line, Rect } from "./shapes";
import { EDGES, jointColor, JOINTS, OBJECT_COLOR } from "../model/joints";
import { toScreen, type View } from "./view";

interface TrackShapeProps {
  names: readonly string[];
  /** px by joint; null behind the camera */
  points: readonly (readonly (number | null)[])[];
  view: View;
}

/** The fitted joints of one frame: thin and hollow, so that they are never taken for marks made by a person. */
export function TrackShape({ names, points, view }: TrackShapeProps) {
  const at = new Map<string, { x: number; y: number }>();
  names.forEach((name, index) => {
    const [x, y] = points[index] ?? [];
    if (typeof x === "number" && typeof y === "number") at.set(name, toScreen(view, { x, y }));
  });
  const hands = [...new Set(names.filter((name) => name.includes("/")).map((name) => name.slice(0, name.indexOf("/"))))];
  return (
    <Group listening={false}>
      {hands.map((hand) => (
        <Group key={hand}>
          {EDGES.map(([from, to]) => {
            const [a, b] = [at.get(`${hand}/${JOINTS[from]}`), at.get(`${hand}/${JOINTS[to]}`)];
            return a && b ? <Line key={`${from}-${to}`} points={[a.x, a.y, b.x, b.y]} stroke={jointColor(to)} strokeWidth={1.75} opacity={0.95} /> : null;
          })}
          {JOINTS.map((joint, index) => {
            const place = at.get(`${hand}/${joint}`);
            if (!place) return null;
            const style = { fill: "#101215", stroke: jointColor(index), strokeWidth: 1.5 };
            return hand === "left" ? (
              <Rect key={joint} x={place.x - 3} y={place.y - 3} width={6} height={6} {...style} />
            ) : (
              <Circle key={joint} {...place} radius={3.25} {...style} />
            );
          })}
        </Group>
      ))}
      {names
        .filter((name) => name.includes(":"))
        .map((name) => {
          const place = at.get(name);
          return place ? <Circle key={name} {...place} radius={3} fill={OBJECT_COLOR} /> : null;
        })}
    </Group>
  );
}
