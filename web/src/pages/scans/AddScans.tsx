import { Button } from "@mantine/core";
import { IconUpload } from "@tabler/icons-react";
import { useEffect, useRef, useState } from "react";
import { readChoice, readDrop } from "../../actions/readDrop";
import { hasRole, useMe } from "../../state/me";
import { chooseScans } from "../../state/scanUpload";
import classes from "./ScansPage.module.css";

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

const holdsFiles = (event: DragEvent): boolean => event.dataTransfer?.types.includes("Files") ?? false;

/** Scans and folders of them may be dropped anywhere on the page. */
export function ScanDrops() {
  const [isOver, setOver] = useState(false);
  const mayAdd = hasRole(useMe(), "lead");
  useEffect(() => {
    if (!mayAdd) return;
    let depth = 0;
    const enter = (event: DragEvent): void => {
      if (!holdsFiles(event)) return;
      depth += 1;
      setOver(true);
    };
    const leave = (): void => {
      depth = Math.max(0, depth - 1);
      if (depth === 0) setOver(false);
    };
    const over = (event: DragEvent): void => {
      if (holdsFiles(event)) event.preventDefault();
    };
    const drop = (event: DragEvent): void => {
      if (!holdsFiles(event) || !event.dataTransfer) return;
      event.preventDefault();
      depth = 0;
      setOver(false);
      void readDrop(event.dataTransfer).then(chooseScans);
    };
    window.addEventListener("dragenter", enter);
    window.addEventListener("dragleave", leave);
    window.addEventListener("dragover", over);
    window.addEventListener("drop", drop);
    return () => {
      window.removeEventListener("dragenter", enter);
      window.removeEventListener("dragleave", leave);
      window.removeEventListener("dragover", over);
      window.removeEventListener("drop", drop);
    };
  }, [mayAdd]);
  return (
    <div data-takes-drops>
      {isOver && (
        <div className={classes.overlay}>
          <div className={classes.sheet}>
            <IconUpload size={48} stroke={1.5} aria-hidden />
            <strong>Drop to add scans</strong>
            <span className="quiet">PLY, OBJ or STL files, folders of them, or a .zip; perhaps with a scans.json.</span>
          </div>
        </div>
      )}
    </div>
  );
}
