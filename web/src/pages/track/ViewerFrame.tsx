import { Checkbox, Group, Loader, Stack, Text } from "@mantine/core";
import { useEffect, useState } from "react";
import type { Shown, useViewer } from "../../api/tracks";
import { formatName } from "../../model/format";
import { Failure } from "../parts/Failure";
import classes from "./TrackReview.module.css";

type Layers = Omit<Shown, "dark">;

interface ViewerFrameProps {
  viewer: ReturnType<typeof useViewer>;
  layers: Layers;
  onLayers: (layers: Layers) => void;
}

const NAMES = ["cloud", "mesh", "skeleton", "correspondences"] as const;

/** The 3D viewer, with its layers above it under their own names. */
export function ViewerFrame({ viewer, layers, onLayers }: ViewerFrameProps) {
  const { session, terms, failure, retry } = viewer;
  const [isLoaded, setLoaded] = useState(false);
  const [hasKeys, setHasKeys] = useState(false);
  useEffect(() => setLoaded(false), [session?.id]);
  useEffect(() => {
    // Keys typed into the 3D view do not reach this page; say so instead of seeming broken.
    const look = (): void => setHasKeys(document.activeElement?.tagName === "IFRAME");
    const later = (): void => void setTimeout(look, 0);
    window.addEventListener("blur", later);
    window.addEventListener("focus", later);
    return () => {
      window.removeEventListener("blur", later);
      window.removeEventListener("focus", later);
    };
  }, []);

  return (
    <section className={classes.viewer} aria-label="3D view">
      <div className={classes.layers}>
        {NAMES.map((name) => (
          <Checkbox key={name} size="xs" label={formatName(name)} checked={layers[name]} onChange={(event) => onLayers({ ...layers, [name]: event.currentTarget.checked })} />
        ))}
        {layers.correspondences && (
          <Group gap="sm" wrap="nowrap" style={{ overflow: "hidden" }}>
            {terms.map((term) => (
              <Text key={term.name} size="xs" className="quiet one-line">
                <span style={{ color: term.color }} aria-hidden>
                  ■{" "}
                </span>
                {formatName(term.name).toLowerCase()} {term.count}
              </Text>
            ))}
          </Group>
        )}
        {hasKeys && (
          <Text size="xs" ml="auto" className="quiet one-line">
            keys go to the 3D view; click outside it to bring them back
          </Text>
        )}
      </div>
      <div className={classes.stage}>
        {session && !failure && <iframe className={classes.page3d} src={session.url} title="3D view of the track" onLoad={() => setLoaded(true)} />}
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
