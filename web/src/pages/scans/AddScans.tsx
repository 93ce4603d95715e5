import { Button } from "@mantine/core";
import { IconUpload } from "@tabler/icons-react";
import { useRef } from "react";
import { readChoice } from "../../actions/readDrop";
import { hasRole, useMe } from "../../state/me";
import { chooseScans } from "../../state/scanUpload";
import { DropTarget } from "../parts/DropTarget";

/** Choose scans without dragging; leads add scans. */
export function AddScansButton({ label }: { label: string }) {
  const input = useRef<HTMLInputElement>(null);
  if (!hasRole(useMe(), "lead")) return null;
  return (
    <>
      <Button leftSection={<IconUpload size={16} aria-hidden />} onClick={() => input.current?.click()}>
        {label}
      </Button>
      <input
        ref={input}
        type="file"
        multiple
        hidden
        accept=".ply,.obj,.stl,.json,.zip"
        aria-label="Choose scans to add"
        data-testid="choose-scans"
        onChange={(event) => {
          const chosen = event.target.files ? readChoice(event.target.files) : [];
          event.target.value = "";
          chooseScans(chosen);
        }}
      />
    </>
  );
}

/** Scans and folders of them may be dropped anywhere on the page. */
export function ScanDrops() {
  const mayAdd = hasRole(useMe(), "lead");
  return (
    <div data-takes-drops>
      {mayAdd && <DropTarget title="Drop to add scans" hint="PLY, OBJ or STL files, folders of them, or a .zip; perhaps with a scans.json." onFiles={chooseScans} />}
    </div>
  );
}
