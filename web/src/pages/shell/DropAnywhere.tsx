import { useNavigate } from "react-router";
import { sendIncoming } from "../../state/incoming";
import { DropTarget } from "../parts/DropTarget";

/** Some pages take drops themselves, such as those of labels and scans. */
const isFree = (): boolean => document.querySelector("[data-takes-drops]") === null;

/** Files, folders and archives may be dropped on any page. */
export function DropAnywhere() {
  const navigate = useNavigate();
  return (
    <DropTarget
      title="Drop to import"
      hint="A recording folder, depth and colour images, videos with their calibration, or a .zip of these."
      isOpen={isFree}
      onFiles={(files) => {
        void sendIncoming(files);
        void navigate("/imports/new");
      }}
    />
  );
}
