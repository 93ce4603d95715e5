import { Checkbox, Loader, Stack, Text } from "@mantine/core";
import { useEffect, useState, type SyntheticEvent } from "react";
import { shareKeys } from "../../actions/shareKeys";
import { LAYERS, type Layer, type Viewer } from "../../api/tracks";
import { countOf } from "../../model/evidence";
import { formatName } from "../../model/format";
import { Failure } from "../parts/Failure";
import { EvidenceCard } from "./EvidenceCard";
import classes from "./TrackReview.module.css";

type ShownLayers = Record<Layer, boolean>;

interface ViewerFrameProps {
  viewer: Viewer;
  /** The frame that is wanted. */
  frame: number;
  layers: ShownLayers;
  /** Terms whose correspondences were switched; the others are shown. */
  terms: Record<string, boolean>;
  onLayers: (layers: ShownLayers) => void;
  onTerms: (terms: Record<string, boolean>) => void;
}

const HELP: Partial<Record<Layer, string>> = {
  correspondences: "What each term matches: a line from the model to the data",
  detections: "Fingertips found in the image, and the finger each was assigned to",
  collisions: "Triangles that cross, and vertices that are inside another part",
  contacts: "Finger parts within 10 mm of the object, and whether it is held",
  unknown: "What the run left out near the hands: held things without a model, sleeves, what hides the hand",
  cameras: "Every camera of the recording; in a track of several colour cameras the rays along which they saw the joints",
  distances: "The meshes in colours of their distance to the measured points",
};

/** The 3D viewer, with its layers above it under their own names. */
export function ViewerFrame({ viewer, frame, layers, terms, onLayers, onTerms }: ViewerFrameProps) {
  const { session, told, isBusy, failure, retry } = viewer;
  const [isLoaded, setLoaded] = useState(false);
  useEffect(() => setLoaded(false), [session?.id]);
  const load = (event: SyntheticEvent<HTMLIFrameElement>): void => {
    setLoaded(true);
    if (event.currentTarget.contentWindow) shareKeys(event.currentTarget.contentWindow);
  };

  return (
    <section className={classes.viewer} aria-label="3D view">
      <div className={classes.layers} role="group" aria-label="Layers of the 3D view">
        {LAYERS.map((name) => {
          const count = layers[name] ? countOf(told, name) : null;
          return (
            <Checkbox
              key={name}
              size="xs"
              styles={{ label: { paddingInlineStart: 4 } }}
              title={HELP[name]}
              label={
                <>
                  {formatName(name)}
                  {count !== null && <span className={classes.count}>{count}</span>}
                </>
              }
              aria-label={formatName(name)}
              checked={layers[name]}
              onChange={(event) => onLayers({ ...layers, [name]: event.currentTarget.checked })}
            />
          );
        })}
      </div>
      <div className={classes.stage}>
        {session && !failure && <iframe className={classes.page3d} src={session.url} title="3D view of the track" onLoad={load} />}
        {session && !failure && isLoaded && (
          <EvidenceCard told={told} layers={layers} isBusy={isBusy} terms={terms} onTerms={onTerms} />
        )}
        {session && !failure && isLoaded && told && told.frame !== frame && (
          <span className={`${classes.note} ${classes.late}`} role="status">
            waiting for frame {frame} in 3D; you see frame {told.frame}
          </span>
        )}
        {failure && (
          <div className={classes.waiting} style={{ background: "var(--mantine-color-body)" }}>
            <Failure what="The 3D view could not be opened" error={failure} safe="The image, the curves and the timeline work without it." onRetry={retry} />
          </div>
        )}
        {!failure && !isLoaded && (
          <div className={classes.waiting} role="status">
            <Stack align="center" gap="sm">
              <Loader />
              <Text size="sm" c="gray.4">
                Opening the 3D view
              </Text>
            </Stack>
          </div>
        )}
      </div>
    </section>
  );
}
