import { hasRole, useMe } from "../../state/me";
import { chooseMovingScan } from "../../state/movingUpload";
import { ChooseFiles } from "../parts/ChooseFiles";
import { DropTarget } from "../parts/DropTarget";

/** Choose a folder of scans, or files, without dragging. */
export const AddMovingScanButton = ({ label }: { label: string }) => (
  <ChooseFiles label={label} folder="A folder of scans" what="with scans of a moving person" accept=".ply,.obj,.stl,.zip" testId="choose-moving" onFiles={chooseMovingScan} />
);

/** A folder may be dropped anywhere on the page. */
export function MovingDrops() {
  const mayAdd = hasRole(useMe(), "lead");
  return (
    <div data-takes-drops>
      {mayAdd && <DropTarget title="Drop to add a moving scan" hint="A folder of PLY, OBJ or STL files of one person, one a frame, or a .zip of it." onFiles={chooseMovingScan} />}
    </div>
  );
}
