import type { Camera } from "../../api/types";
import { Group, Line, Text } from "../../canvas/shapes";
import { toScreen, type Point, type View } from "../../canvas/view";
import { epipolarCurve, type Curve } from "../../model/epipolar";
import { jointColor } from "../../model/joints";
import { isPlaced, keyText } from "../../model/pose";
import { activePose } from "../../state/annotator";
import { useSelect } from "../../state/useStore";
import { useAnnotating } from "./annotating";
import type { LayerProps } from "./mounts";
import { useAnnotation, useOpenRecording, useOption } from "./reading";

/** Beside the line, a little inside of where it leaves the picture on the left or the top: far from the hand. */
function labelPlace(on: readonly Point[]): Point {
  const [first, last] = [on[0] ?? { x: 0, y: 0 }, on.at(-1) ?? { x: 0, y: 0 }];
  const [from, to] = first.x <= last.x ? [first, last] : [last, first];
  const length = Math.hypot(to.x - from.x, to.y - from.y) || 1;
  const inside = Math.min(28, length / 4) / length;
  return { x: from.x + inside * (to.x - from.x) + 4, y: from.y + inside * (to.y - from.y) + (to.y > from.y ? -16 : 4) };
}

function CurveShape({ curve, view, color, label, isFaint = false }: { curve: Curve; view: View; color: string; label: string; isFaint?: boolean }) {
  if (curve.length < 2) return null;
  const on = curve.map((point) => toScreen(view, point));
  const points = on.flatMap(({ x, y }) => [x, y]);
  const at = labelPlace(on);
  return (
    <Group listening={false}>
      <Line points={points} stroke="#000" strokeWidth={3} opacity={0.4} />
      <Line points={points} stroke={color} strokeWidth={1.25} opacity={isFaint ? 0.75 : 1} dash={isFaint ? [2, 5] : [10, 4]} />
      {!isFaint && <Text x={at.x} y={at.y} text={label} fontSize={11} fontFamily="Inter Variable, sans-serif" fill={color} stroke="#000" strokeWidth={3} fillAfterStrokeEnabled />}
    </Group>
  );
}

/** Nothing outside of the image. */
const clipTo = (camera: LayerProps["camera"], view: View) => ({ clipX: view.x, clipY: view.y, clipWidth: camera.width * view.scale, clipHeight: camera.height * view.scale });

/** Where what is under the cursor in another camera's picture can be in this one; drawn apart, because it moves with the cursor. */
export function CursorCurve({ view, camera }: Omit<LayerProps, "frame">) {
  const { hover } = useAnnotating();
  const { cameras } = useOpenRecording();
  const here = useSelect(hover, (now) => (now?.camera === camera.id ? null : now));
  const from = here ? cameras.find((one) => one.id === here.camera) : undefined;
  if (!useOption("areLinesShown") || !from || !here) return null;
  return (
    <Group listening={false} {...clipTo(camera, view)}>
      <CurveShape curve={epipolarCurve(from, here.pixel, camera)} view={view} color="#fff" label="" isFaint />
    </Group>
  );
}

/** The line of the active joint of the active hand, as it is marked in another camera's picture. */
function JointCurve({ of, view, camera, frame }: LayerProps & { of: Camera }) {
  const joint = useAnnotation((state) => state.joint);
  const mark = useAnnotation((state) => {
    const isHere = of.id === state.camera && frame === state.frame;
    return (isHere ? activePose(state) : state.poses[keyText({ camera: of.id, frame, hand: state.hand })])?.[state.joint];
  });
  return isPlaced(mark) ? <CurveShape curve={epipolarCurve(of, mark, camera)} view={view} color={jointColor(joint)} label={of.id} /> : null;
}

/** Epipolar lines of the active joint, from every camera that has it. */
export function EpipolarLayer({ view, camera, frame }: LayerProps) {
  const { cameras } = useOpenRecording();
  if (!useOption("areLinesShown") || cameras.length < 2) return null;
  return (
    <Group listening={false} {...clipTo(camera, view)}>
      {cameras
        .filter(({ id }) => id !== camera.id)
        .map((other) => (
          <JointCurve key={other.id} of={other} view={view} camera={camera} frame={frame} />
        ))}
    </Group>
  );
}
