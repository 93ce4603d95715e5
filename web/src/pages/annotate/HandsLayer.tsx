import { GhostShape, HandShape } from "../../canvas/HandShape";
import { HANDS } from "../../model/joints";
import { fromWire, keyText } from "../../model/pose";
import { useAnnotating } from "./annotating";
import type { LayerProps } from "./mounts";

/** What people marked: the active hand, the other one faint, and versions to compare with as ghosts. */
export function HandsLayer({ view, camera, frame }: LayerProps) {
  const { state, pose, options, saving, preview } = useAnnotating();
  if (!options.areHandsShown) return null;
  // Of the picture's own frame, which may be another one than the annotator is at: then nothing in it is being worked on.
  const isActive = camera.id === state.camera && frame === state.frame;
  const theirs = saving.conflicts.get(keyText({ camera: camera.id, frame, hand: state.hand }));
  return (
    <>
      {HANDS.filter((hand) => !isActive || hand !== state.hand).map((hand) => {
        const other = state.poses[keyText({ camera: camera.id, frame, hand })];
        return other && <HandShape key={hand} pose={other} hand={hand} view={view} active={-1} isFaint={hand !== state.hand} />;
      })}
      {isActive && <HandShape pose={pose} hand={state.hand} view={view} active={state.joint} areNamesShown={options.areNamesShown} />}
      {theirs?.points && <GhostShape pose={fromWire(theirs.points)} view={view} />}
      {isActive && preview && <GhostShape pose={preview} view={view} />}
    </>
  );
}
