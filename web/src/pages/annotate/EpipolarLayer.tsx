import { Group, Line, Text } from "react-konva";
import { toScreen, type Point, type View } from "../../canvas/view";
import { epipolarCurve, type Curve } from "../../model/epipolar";
import { jointColor } from "../../model/joints";
import { isPlaced, keyText } from "../../model/pose";
import { useHover } from "../../state/pointer";
import { useAnnotating } from "./annotating";
import { useCameras } from "./cameras";
import type { LayerProps } from "./mounts";

function CurveShape({ curve, view, color, label, isFaint = false }: { curve: Curve; view: View; color: string; label: string; isFaint?: boolean }) {
  if (curve.length < 2) return null;
  const on = curve.map((point) => toScreen(view, point));
  const points = on.flatMap(({ x, y }) => [x, y]);
  const middle: Point = on[Math.floor(on.length / 2)] ?? { x: 0, y: 0 };
  const half = on.length === 2 && on[1] ? { x: (middle.x + (on[0]?.x ?? 0)) / 2, y: (middle.y + (on[0]?.y ?? 0)) / 2 } : middle;
  return (
    <Group listening={false}>
      <Line points={points} stroke="#000" strokeWidth={3} opacity={0.4} />
      <Line points={points} stroke={color} strokeWidth={1.25} opacity={isFaint ? 0.75 : 1} dash={isFaint ? [2, 5] : [10, 4]} />
      {!isFaint && <Text x={half.x + 6} y={half.y - 16} text={label} fontSize={11} fontFamily="Inter Variable, sans-serif" fill={color} stroke="#000" strokeWidth={3} fillAfterStrokeEnabled />}
    </Group>
  );
}

/** Where what is under the cursor in another camera's picture can be in this one; on its own, because it moves with the cursor. */
function CursorCurve({ view, camera }: LayerProps) {
  const { recording, hover } = useAnnotating();
  const here = useHover(hover);
  const from = here && here.camera !== camera.id ? recording.cameras.find((one) => one.id === here.camera) : undefined;
  return from && here ? <CurveShape curve={epipolarCurve(from, here.pixel, camera)} view={view} color="#fff" label="" isFaint /> : null;
}

/** Epipolar lines of the active joint, from every camera that has it, and of the cursor. */
export function EpipolarLayer({ view, camera }: LayerProps) {
  const { recording, state, pose } = useAnnotating();
  const { areLinesShown } = useCameras();
  if (!areLinesShown || recording.cameras.length < 2) return null;
  const corner = { x: view.x, y: view.y };
  return (
    <Group listening={false} clipX={corner.x} clipY={corner.y} clipWidth={camera.width * view.scale} clipHeight={camera.height * view.scale}>
      {recording.cameras.map((other) => {
        if (other.id === camera.id) return null;
        const mark = (other.id === state.camera ? pose : state.poses[keyText({ camera: other.id, frame: state.frame, hand: state.hand })])?.[state.joint];
        return isPlaced(mark) && <CurveShape key={other.id} curve={epipolarCurve(other, mark, camera)} view={view} color={jointColor(state.joint)} label={other.id} />;
      })}
      <CursorCurve view={view} camera={camera} />
    </Group>
  );
}
