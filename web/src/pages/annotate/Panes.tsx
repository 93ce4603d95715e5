import { useAnnotating } from "./annotating";
import { CameraGrid } from "./CameraGrid";
import { useCameras } from "./cameras";
import { Pane } from "./Pane";

/** The pictures of the active camera in the chosen arrangement, or those of several cameras. */
export function Panes() {
  const { camera, pictures, arrangement, options } = useAnnotating();
  const { shown } = useCameras();
  if (shown.length > 1) return <CameraGrid />;
  const color = { picture: pictures.color, opacity: 1 };
  const depth = { picture: pictures.depth, opacity: 1 };
  const show = (label: string, layers: readonly (typeof color)[]) => (
    <Pane key={`${camera.id}/${label}`} camera={camera} label={label} layers={layers} pictures={pictures} />
  );
  switch (arrangement) {
    case "color":
      return show("Colour", [color]);
    case "depth":
      return show("Depth", [depth]);
    case "over":
      return show("Depth over colour", [color, { ...depth, opacity: options.depthOpacity }]);
    case "side":
      return [show("Colour", [color]), show("Depth", [depth])];
  }
}
