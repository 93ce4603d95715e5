import type { ReactNode } from "react";
import { Circle, Group, Image, Layer, Line, Rect, Text } from "./shapes";
import type { Camera } from "../api/types";
import type { PointerStore } from "../state/pointer";
import { useStore } from "../state/useStore";
import type { PaneLayer } from "./ImagePane";
import { toScreen, type Size, type View } from "./view";

interface CursorLayerProps {
  pointer: PointerStore;
  view: View;
  camera: Camera;
  label: string;
  layers: readonly PaneLayer[];
  isMagnified: boolean;
  size: Size;
  /** What else moves with the cursor, in this or another picture. */
  children?: ReactNode;
}

const LENS_RADIUS = 88;
const LENS_FACTOR = 4;

/** Cross hairs that follow the pointer in every pane of this camera, and the magnifier. */
export function CursorLayer({ pointer, view, camera, label, layers, isMagnified, size, children }: CursorLayerProps) {
  const pixel = useStore(pointer);
  if (!pixel) return <Layer listening={false}>{children}</Layer>;
  const at = toScreen(view, pixel);
  const arm = 9;
  const gap = 4;
  // Beside the cursor, on the side with room.
  const isRight = at.x < size.width - 140;
  return (
    <Layer listening={false} imageSmoothingEnabled={false}>
      {children}
      {isMagnified ? (
        <Group x={at.x} y={at.y}>
          <Group clipFunc={(context) => context.arc(0, 0, LENS_RADIUS, 0, 2 * Math.PI)}>
            <Rect x={-LENS_RADIUS} y={-LENS_RADIUS} width={2 * LENS_RADIUS} height={2 * LENS_RADIUS} fill="#0b0c0e" />
            {layers.map(({ picture, opacity }, index) =>
              picture ? (
                <Image
                  key={index}
                  image={picture}
                  opacity={opacity}
                  x={(view.x - at.x) * LENS_FACTOR}
                  y={(view.y - at.y) * LENS_FACTOR}
                  width={camera.width * view.scale * LENS_FACTOR}
                  height={camera.height * view.scale * LENS_FACTOR}
                />
              ) : null,
            )}
          </Group>
          <Circle radius={LENS_RADIUS} stroke="#fff" strokeWidth={1.5} />
          <Line points={[-14, 0, -3, 0]} stroke="#fff" strokeWidth={1} />
          <Line points={[3, 0, 14, 0]} stroke="#fff" strokeWidth={1} />
          <Line points={[0, -14, 0, -3]} stroke="#fff" strokeWidth={1} />
          <Line points={[0, 3, 0, 14]} stroke="#fff" strokeWidth={1} />
        </Group>
      ) : (
        <Group x={at.x} y={at.y} opacity={0.9}>
          {[
            [-arm - gap, 0, -gap, 0],
            [gap, 0, arm + gap, 0],
            [0, -arm - gap, 0, -gap],
            [0, gap, 0, arm + gap],
          ].map((points) => (
            <Line key={points.join()} points={points} stroke="#fff" strokeWidth={1} shadowColor="#000" shadowBlur={2} />
          ))}
          {label && (
            <Text
              x={isRight ? 16 : -16 - 120}
              y={12}
              width={120}
              align={isRight ? "left" : "right"}
              text={label}
              fontSize={12}
              fontFamily="Inter Variable, sans-serif"
              fill="#fff"
              stroke="#000"
              strokeWidth={3}
              fillAfterStrokeEnabled
            />
          )}
        </Group>
      )}
    </Layer>
  );
}
