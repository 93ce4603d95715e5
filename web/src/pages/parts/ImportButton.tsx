import { useNavigate } from "react-router";
import { sendIncoming } from "../../state/incoming";
import { ChooseFiles } from "./ChooseFiles";

/** Choose a recording without dragging. */
export function ImportButton({ label = "Import a recording" }: { label?: string }) {
  const navigate = useNavigate();
  return (
    <ChooseFiles
      label={label}
      folder="A folder"
      what="to import"
      testId="choose"
      onFiles={(chosen) => {
        void sendIncoming(chosen);
        void navigate("/imports/new");
      }}
    />
  );
}
