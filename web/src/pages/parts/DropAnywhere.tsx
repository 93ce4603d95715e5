import { Stack, Text } from "@mantine/core";
import { IconUpload } from "@tabler/icons-react";
import { useEffect, useState } from "react";
import { useNavigate } from "react-router";
import { readDrop } from "../../actions/readDrop";
import { sendIncoming } from "../../state/incoming";
import classes from "./DropAnywhere.module.css";

/** Some pages take drops themselves, such as those of labels. */
const isTaken = (): boolean => document.querySelector("[data-takes-drops]") !== null;

const holdsFiles = (event: DragEvent): boolean => !isTaken() && (event.dataTransfer?.types.includes("Files") ?? false);

/** Files, folders and archives may be dropped on any page. */
export function DropAnywhere() {
  const [isOver, setOver] = useState(false);
  const navigate = useNavigate();
  useEffect(() => {
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
    const drop = async (event: DragEvent): Promise<void> => {
      if (!holdsFiles(event) || !event.dataTransfer) return;
      event.preventDefault();
      depth = 0;
      setOver(false);
      const files = await readDrop(event.dataTransfer);
      if (files.length === 0) return;
      void sendIncoming(files);
      void navigate("/imports/new");
    };
    const take = (event: DragEvent): void => void drop(event);
    window.addEventListener("dragenter", enter);
    window.addEventListener("dragleave", leave);
    window.addEventListener("dragover", over);
    window.addEventListener("drop", take);
    return () => {
      window.removeEventListener("dragenter", enter);
      window.removeEventListener("dragleave", leave);
      window.removeEventListener("dragover", over);
      window.removeEventListener("drop", take);
    };
  }, [navigate]);

  if (!isOver) return null;
  return (
    <div className={classes.overlay}>
      <Stack align="center" gap="sm" className={classes.sheet}>
        <IconUpload size={48} stroke={1.5} aria-hidden />
        <Text size="xl" fw={600}>
          Drop to import
        </Text>
        <Text className="quiet">A recording folder, depth and colour images, videos with their calibration, or a .zip of these.</Text>
      </Stack>
    </div>
  );
}
