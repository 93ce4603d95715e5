import { GhostShape, HandShape } from "../../canvas/HandShape";
import type { View } from "../../canvas/view";
import { HANDS } from "../../model/joints";
import { fromWire, keyText, type PoseKey } from "../../model/pose";
import type { LayerProps } from "./mounts";
import { useAnnotation, useOption, usePage, usePose, useSaving } from "./reading";

/** A hand as it is stored. */
function StoredHand({ of, view, isFaint }: { of: PoseKey; view: View; isFaint: boolean }) {
  const pose = useAnnotation((state) => state.poses[keyText(of)]);
  return pose && <HandShape pose={pose} hand={of.hand} view={view} active={-1} isFaint={isFaint} />;
}

/** The hand that is worked on, and a version to compare it with. */
function ActiveHand({ view }: { view: View }) {
  const pose = usePose();
  const hand = useAnnotation((state) => state.hand);
  const joint = useAnnotation((state) => state.joint);
  const preview = usePage((page) => page.preview);
  return (
    <>
      <HandShape pose={pose} hand={hand} view={view} active={joint} areNamesShown={useOption("areNamesShown")} />
      {preview && <GhostShape pose={preview} view={view} />}
    </>
  );
}

/** What people marked: the active hand, the other one faint, and versions to compare with as ghosts. */
export function HandsLayer({ view, camera, frame }: LayerProps) {
  const active = useAnnotation((state) => state.hand);
  // Of the picture's own frame, which may be another one than the annotator is at: then nothing in it is being worked on.
  const isActive = useAnnotation((state) => camera.id === state.camera && frame === state.frame);
  const theirs = useSaving((saving) => saving.conflicts.get(keyText({ camera: camera.id, frame, hand: active })));
  if (!useOption("areHandsShown")) return null;
  return (
    <>
      {HANDS.filter((hand) => !isActive || hand !== active).map((hand) => (
        <StoredHand key={hand} of={{ camera: camera.id, frame, hand }} view={view} isFaint={hand !== active} />
      ))}
      {isActive && <ActiveHand view={view} />}
      {theirs?.points && <GhostShape pose={fromWire(theirs.points)} view={view} />}
    </>
  );
}
