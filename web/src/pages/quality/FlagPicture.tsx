import { useEffect } from "react";
import { colorUrl, depthPictureUrl } from "../../api/recordings";
import type { Flag, Recording } from "../../api/types";
import { EDGES, HAND_COLORS, jointColor } from "../../model/joints";
import classes from "./LabelCheck.module.css";

export type PictureState = "waiting" | "here" | "missing";

interface FlagPictureProps {
  recording: Recording;
  flag: Pick<Flag, "camera" | "frame" | "hand" | "points" | "joints">;
  /** Told once the image under the label has come, or does not come. */
  onState: (state: PictureState) => void;
}

/** The hand over its image, cut out around it, or the whole image without one; the joints that are meant are ringed. */
export function FlagPicture({ recording, flag, onState }: FlagPictureProps) {
  const camera = recording.cameras.find((one) => one.id === flag.camera);
  const placed = flag.points.filter(([, , v]) => v > 0);
  const isEmpty = !camera;
  useEffect(() => {
    // Without a camera there is no image to wait for.
    if (isEmpty) onState("here");
  }, [isEmpty, onState]);
  if (!camera) return <div className={classes.picture} />;
  const [xs, ys] = placed.length > 0 ? [placed.map(([x]) => x), placed.map(([, y]) => y)] : [[0, camera.width - 1], [0, camera.height - 1]];
  const [left, top, right, bottom] = [Math.min(...xs), Math.min(...ys), Math.max(...xs), Math.max(...ys)];
  const width = Math.max(right - left, (bottom - top) * (4 / 3), 60) * (placed.length > 0 ? 1.35 : 1);
  const height = width * 0.75;
  const unit = width / 240;
  const box = [(left + right - width) / 2 + 0.5, (top + bottom - height) / 2 + 0.5, width, height].join(" ");
  return (
    <svg className={classes.picture} viewBox={box} role="img" aria-label={`${flag.hand} hand in frame ${flag.frame}`}>
      <image
        href={(camera.has_color ? colorUrl : depthPictureUrl)(recording, flag.camera, flag.frame)}
        x={0}
        y={0}
        width={camera.width}
        height={camera.height}
        onLoad={() => onState("here")}
        onError={() => onState("missing")}
      />
      <g transform="translate(0.5 0.5)" fill="none" strokeLinecap="round">
        {EDGES.map(([from, to]) => {
          const [a, b] = [flag.points[from], flag.points[to]];
          if (!a || !b || a[2] === 0 || b[2] === 0) return null;
          const dashes = a[2] === 1 || b[2] === 1 ? `${4 * unit} ${4 * unit}` : undefined;
          return <line key={`${from}-${to}`} x1={a[0]} y1={a[1]} x2={b[0]} y2={b[1]} stroke={jointColor(to)} strokeWidth={1.75 * unit} strokeDasharray={dashes} />;
        })}
        {flag.points.map(([x, y, v], joint) => (v > 0 ? <circle key={joint} cx={x} cy={y} r={2.5 * unit} fill={v === 2 ? jointColor(joint) : "#0008"} stroke={v === 2 ? "#111" : jointColor(joint)} strokeWidth={unit} /> : null))}
        {flag.joints.map((joint) => {
          const point = flag.points[joint];
          return point && point[2] > 0 ? (
            <g key={joint}>
              <circle cx={point[0]} cy={point[1]} r={7 * unit} stroke="#000" strokeOpacity={0.6} strokeWidth={4 * unit} />
              <circle cx={point[0]} cy={point[1]} r={7 * unit} stroke={HAND_COLORS[flag.hand]} strokeWidth={2 * unit} />
            </g>
          ) : null;
        })}
      </g>
    </svg>
  );
}
