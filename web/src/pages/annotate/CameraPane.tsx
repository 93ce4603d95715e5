import { useElementSize } from "@mantine/hooks";
import { IconArrowsDiagonal, IconArrowsDiagonalMinimize2 } from "@tabler/icons-react";
import { useEffect } from "react";
import type { Camera } from "../../api/types";
import { usePictures } from "../../canvas/usePictures";
import { decidedCount } from "../../model/pose";
import { useHint } from "../../state/keys";
import { poseIn } from "../../state/annotator";
import { arrangementFor } from "../../state/viewOptions";
import { useAnnotating } from "./annotating";
import classes from "./CameraGrid.module.css";
import { Pane } from "./Pane";
import { useAnnotation, useLargeCamera, useOpenRecording, useOption, usePage, useShownCameras } from "./reading";
import { useTellPictures } from "./useTellPictures";

/** Frames loaded in the direction of travel by all panes together. */
const AHEAD = 16;

/** One camera's picture among others. */
export function CameraPane({ camera }: { camera: Camera }) {
  const { sizes, show } = useAnnotating();
  const { ref, width, height } = useElementSize();
  useEffect(() => void sizes.set(camera.id, { width, height }), [sizes, camera.id, width, height]);

  // Two pictures of each of several cameras would be too small to see anything.
  const chosen = useOption("arrangement");
  const arrangement = arrangementFor(camera, chosen === "side" ? "color" : chosen);
  const isActive = useAnnotation((state) => state.camera === camera.id);
  const isLarge = useLargeCamera() === camera.id;
  const ahead = Math.max(2, Math.round(AHEAD / useShownCameras().length));
  const pictures = usePictures(
    useOpenRecording(),
    camera,
    useAnnotation((state) => state.frame),
    { color: arrangement !== "depth", depth: arrangement !== "color", palette: useOption("palette") },
    usePage((page) => (isActive ? page.range : null)),
    ahead,
  );
  useTellPictures(pictures, isActive);
  const depthOpacity = useOption("depthOpacity");
  const layers = [
    ...(arrangement !== "depth" ? [{ picture: pictures.color, opacity: 1 }] : []),
    ...(arrangement !== "color" ? [{ picture: pictures.depth, opacity: arrangement === "over" ? depthOpacity : 1 }] : []),
  ];
  const marked = useAnnotation((state) => decidedCount(poseIn(state, camera.id)));
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
            <button type="button" className={classes.button} aria-label={enlarge} aria-pressed={isLarge} title={hint(enlarge, "views.large")} onClick={() => show({ largeCamera: isLarge ? null : camera.id })}>
              {isLarge ? <IconArrowsDiagonalMinimize2 size={14} aria-hidden /> : <IconArrowsDiagonal size={14} aria-hidden />}
            </button>
          </div>
        }
      />
    </div>
  );
}
