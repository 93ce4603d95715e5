import { useElementSize } from "@mantine/hooks";
import { IconArrowsDiagonal, IconArrowsDiagonalMinimize2 } from "@tabler/icons-react";
import { useEffect } from "react";
import type { Camera } from "../../api/types";
import { usePictures } from "../../canvas/usePictures";
import { decidedCount, keyText } from "../../model/pose";
import { useHint } from "../../state/keys";
import { arrangementFor } from "../../state/viewOptions";
import { useAnnotating } from "./annotating";
import classes from "./CameraGrid.module.css";
import { useCameras } from "./cameras";
import { Pane } from "./Pane";

/** Frames loaded in the direction of travel by all panes together. */
const AHEAD = 16;

/** One camera's picture among others. */
export function CameraPane({ camera }: { camera: Camera }) {
  const { recording, state, pose, range, options } = useAnnotating();
  const { shown, large, setLarge, tellSize } = useCameras();
  const { ref, width, height } = useElementSize();
  useEffect(() => tellSize(camera.id, { width, height }), [tellSize, camera.id, width, height]);

  // Two pictures of each of several cameras would be too small to see anything.
  const wanted = options.arrangement === "side" ? "color" : options.arrangement;
  const arrangement = arrangementFor(camera, wanted);
  const isActive = camera.id === state.camera;
  const isLarge = large === camera.id;
  const ahead = Math.max(2, Math.round(AHEAD / shown.length));
  const pictures = usePictures(
    recording,
    camera,
    state.frame,
    { color: arrangement !== "depth", depth: arrangement !== "color", palette: options.palette },
    isActive ? range : null,
    ahead,
  );
  const layers = [
    ...(arrangement !== "depth" ? [{ picture: pictures.color, opacity: 1 }] : []),
    ...(arrangement !== "color" ? [{ picture: pictures.depth, opacity: arrangement === "over" ? options.depthOpacity : 1 }] : []),
  ];
  const marked = decidedCount(isActive ? pose : state.poses[keyText({ camera: camera.id, frame: state.frame, hand: state.hand })]);
  const hint = useHint();
  const enlarge = `${isLarge ? "As large as the others" : "Enlarge"} ${camera.id}`;
  return (
    <div ref={ref} className={classes.pane} data-active={isActive} data-camera={camera.id}>
      <Pane
        camera={camera}
        label={arrangement === "depth" ? "Depth" : "Colour"}
        layers={layers}
        pictures={pictures}
        overlay={
          <div className={classes.label} data-over-picture>
            <b>{camera.id}</b>
            <span className={classes.count}>
              {pictures.setback ? "picture not loaded" : `${marked}/21`}
              {isActive && " · active"}
            </span>
            <button type="button" className={classes.button} aria-label={enlarge} aria-pressed={isLarge} title={hint(enlarge, "views.large")} onClick={() => setLarge(isLarge ? null : camera.id)}>
              {isLarge ? <IconArrowsDiagonalMinimize2 size={14} aria-hidden /> : <IconArrowsDiagonal size={14} aria-hidden />}
            </button>
          </div>
        }
      />
    </div>
  );
}
