import { Checkbox } from "@mantine/core";
import { useEffect, useMemo, useState } from "react";
import { overlayUrl, useTrackJoints } from "../../api/tracks";
import type { Camera, Recording, Track } from "../../api/types";
import { ImagePane } from "../../canvas/ImagePane";
import { TrackShape } from "../../canvas/TrackShape";
import { useOverlay } from "../../canvas/useOverlay";
import { usePictures } from "../../canvas/usePictures";
import type { View } from "../../canvas/view";
import { createPointerStore } from "../../state/pointer";
import classes from "./TrackReview.module.css";

interface TrackImageProps {
  track: Track;
  recording: Recording;
  camera: Camera;
  frame: number;
  isMeshShown: boolean;
  isSkeletonShown: boolean;
  onStep: (by: 1 | -1) => void;
  onMesh: (isShown: boolean) => void;
  onSkeleton: (isShown: boolean) => void;
}

/** What the camera saw, with the fitted mesh and joints over it. */
export function TrackImage({ track, recording, camera, frame, isMeshShown, isSkeletonShown, onStep, onMesh, onSkeleton }: TrackImageProps) {
  const [view, setView] = useState<View | null>(null);
  const [pointer] = useState(createPointerStore);
  const pictures = usePictures(recording, camera, frame, { color: camera.has_color, depth: !camera.has_color, palette: "grey" }, null);
  const overlay = useOverlay(isMeshShown ? overlayUrl(track.id, camera.id, frame) : null);
  const joints = useTrackJoints(track.id, camera.id).data;
  const row = useMemo(() => joints?.frames.indexOf(frame) ?? -1, [joints, frame]);
  useEffect(() => setView(null), [camera.id]);

  const layers = [
    { picture: camera.has_color ? pictures.color : pictures.depth, opacity: 1 },
    { picture: overlay.picture, opacity: 0.75 },
  ];
  const failure = pictures.failure ?? overlay.failure;
  return (
    <div className={classes.image}>
      <ImagePane
        label={`Image of frame ${frame} with the fitted hand`}
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
        isBusy={pictures.isStale || layers[0]?.picture === null}
        overlay={
          <>
            <div className={classes.imageTools} data-over-picture>
              <Checkbox size="xs" label="Mesh" checked={isMeshShown} onChange={(event) => onMesh(event.currentTarget.checked)} />
              <Checkbox size="xs" label="Skeleton" checked={isSkeletonShown} onChange={(event) => onSkeleton(event.currentTarget.checked)} />
            </div>
            {failure && (
              <span className={classes.note} role="alert">
                {failure.message}
              </span>
            )}
          </>
        }
      >
        {(shown) => isSkeletonShown && joints && row >= 0 && <TrackShape names={joints.joint_names} points={joints.points[row] ?? []} view={shown} />}
      </ImagePane>
    </div>
  );
}
