import { UnstyledButton } from "@mantine/core";
import { useEffect, useMemo, useState, type RefObject } from "react";
import { overlayUrl, unknownUrl, useTrackJoints } from "../../api/tracks";
import type { Camera, Recording, Track } from "../../api/types";
import { ImagePane } from "../../canvas/ImagePane";
import { TrackShape } from "../../canvas/TrackShape";
import { useOverlay } from "../../canvas/useOverlay";
import { usePictures } from "../../canvas/usePictures";
import type { View } from "../../canvas/view";
import { createPointerStore } from "../../state/pointer";
import type { Overlays } from "./TrackPictures";
import classes from "./TrackReview.module.css";

interface TrackImageProps {
  track: Track;
  recording: Recording;
  camera: Camera;
  frame: number;
  overlays: Overlays;
  onStep: (by: 1 | -1) => void;
  /** One of several pictures: it is named, and a click on the name shows it alone. */
  onChoose: (() => void) | undefined;
  ready: RefObject<Record<string, boolean>>;
}

/** What the camera saw, with the fitted mesh and joints over it. */
export function TrackImage({ track, recording, camera, frame, overlays, onStep, onChoose, ready }: TrackImageProps) {
  const [view, setView] = useState<View | null>(null);
  const [pointer] = useState(createPointerStore);
  const pictures = usePictures(recording, camera, frame, { color: camera.has_color, depth: !camera.has_color, palette: "grey" }, null);
  const overlay = useOverlay("mesh", overlays.mesh ? overlayUrl(track.id, camera.id, frame) : null);
  const unknown = useOverlay("unknown", overlays.unknown ? unknownUrl(track.id, camera.id, frame) : null);
  const joints = useTrackJoints(track.id, camera.id).data;
  // What lies over the picture is of the picture's own frame.
  const { shownFrame } = pictures;
  const row = useMemo(() => joints?.frames.indexOf(shownFrame ?? -1) ?? -1, [joints, shownFrame]);
  useEffect(() => setView(null), [camera.id]);

  const layers = [
    { picture: camera.has_color ? pictures.color : pictures.depth, opacity: 1 },
    { picture: shownFrame === frame ? unknown.picture : null, opacity: 0.85 },
    { picture: shownFrame === frame ? overlay.picture : null, opacity: 0.75 },
  ];
  const failure = overlay.failure ?? unknown.failure;
  ready.current[camera.id] = !pictures.isStale || pictures.setback !== null;
  return (
    <div className={classes.image}>
      <ImagePane
        label={onChoose ? `Image of ${camera.id} of frame ${frame} with the fitted hand` : `Image of frame ${frame} with the fitted hand`}
        camera={camera}
        layers={layers}
        view={view}
        onView={setView}
        isTouchLooking
        onSwipe={onStep}
        brightness={1}
        contrast={1}
        pointer={pointer}
        cursorLabel=""
        isMagnified={false}
        frame={frame}
        shownFrame={shownFrame}
        setback={pictures.setback}
        onRetry={pictures.retry}
        overlay={
          <>
            {onChoose && (
              <UnstyledButton className={classes.pictureName} data-over-picture title={`Show ${camera.id} alone`} onClick={onChoose}>
                {camera.id}
              </UnstyledButton>
            )}
            {failure && (
              <span className={classes.note} role="alert">
                {failure.message}
              </span>
            )}
          </>
        }
      >
        {(shown) => overlays.skeleton && joints && row >= 0 && <TrackShape names={joints.joint_names} points={joints.points[row] ?? []} view={shown} />}
      </ImagePane>
    </div>
  );
}
