import { Checkbox } from "@mantine/core";
import type { RefObject } from "react";
import type { Camera, Recording, Track } from "../../api/types";
import { TrackImage } from "./TrackImage";
import classes from "./TrackReview.module.css";

/** What lies over the pictures. */
export interface Overlays {
  readonly mesh: boolean;
  readonly skeleton: boolean;
  readonly unknown: boolean;
}

interface TrackPicturesProps {
  track: Track;
  recording: Recording;
  /** One, or all side by side. */
  cameras: readonly Camera[];
  frame: number;
  overlays: Overlays;
  onOverlays: (overlays: Overlays) => void;
  onStep: (by: 1 | -1) => void;
  onChoose: (camera: string) => void;
  /** Is told by the camera's id whether its picture is that of the frame, so that playing leaves none out. */
  ready: RefObject<Record<string, boolean>>;
}

/** What the cameras saw, with the fitted meshes and joints over it. */
export function TrackPictures({ track, recording, cameras, frame, overlays, onOverlays, onStep, onChoose, ready }: TrackPicturesProps) {
  const isOne = cameras.length === 1;
  return (
    <div className={classes.pictures}>
      <div className={classes.imageTools} data-over-picture={isOne || undefined}>
        <Checkbox size="xs" label="Mesh" checked={overlays.mesh} onChange={(event) => onOverlays({ ...overlays, mesh: event.currentTarget.checked })} />
        <Checkbox size="xs" label="Skeleton" checked={overlays.skeleton} onChange={(event) => onOverlays({ ...overlays, skeleton: event.currentTarget.checked })} />
        <Checkbox
          size="xs"
          label={
            <>
              Unknown things <i className={classes.unknown} aria-hidden />
            </>
          }
          title="What the run left out near the hands: held things without a model, sleeves, what hides the hand. Seen in the depth camera that was tracked in."
          checked={overlays.unknown}
          onChange={(event) => onOverlays({ ...overlays, unknown: event.currentTarget.checked })}
        />
      </div>
      <div className={classes.grid} style={{ gridTemplateColumns: `repeat(${Math.ceil(Math.sqrt(cameras.length))}, minmax(0, 1fr))` }}>
        {cameras.map((camera) => (
          <TrackImage
            key={isOne ? "one" : camera.id}
            track={track}
            recording={recording}
            camera={camera}
            frame={frame}
            overlays={overlays}
            onStep={onStep}
            onChoose={isOne ? undefined : () => onChoose(camera.id)}
            ready={ready}
          />
        ))}
      </div>
    </div>
  );
}
