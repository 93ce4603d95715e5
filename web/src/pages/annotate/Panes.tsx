import type { Camera } from "../../api/types";
import { usePictures } from "../../canvas/usePictures";
import { CameraGrid } from "./CameraGrid";
import { Pane } from "./Pane";
import { useAnnotation, useArrangement, useCamera, useOpenRecording, useOption, usePage, useShownCameras } from "./reading";
import { useTellPictures } from "./useTellPictures";

/** The pictures of the active camera in the chosen arrangement, or those of several cameras. */
export function Panes() {
  const camera = useCamera();
  return useShownCameras().length > 1 ? <CameraGrid /> : <OneCamera camera={camera} />;
}

function OneCamera({ camera }: { camera: Camera }) {
  const arrangement = useArrangement();
  const opacity = useOption("depthOpacity");
  // Depth is large: it is fetched where it is seen, and its values are known there.
  const wanted = { color: arrangement !== "depth", depth: arrangement !== "color", palette: useOption("palette") };
  const pictures = usePictures(useOpenRecording(), camera, useAnnotation((state) => state.frame), wanted, usePage((page) => page.range));
  useTellPictures(pictures, true);
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
      return show("Depth over colour", [color, { ...depth, opacity }]);
    case "side":
      return [show("Colour", [color]), show("Depth", [depth])];
  }
}
