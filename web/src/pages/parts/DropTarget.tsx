import { Stack, Text } from "@mantine/core";
import { IconUpload } from "@tabler/icons-react";
import { useEffect, useRef, useState } from "react";
import { readDrop } from "../../actions/readDrop";
import type { DroppedFile } from "../../api/imports";
import classes from "./DropTarget.module.css";
import { tellEmpty } from "./tellEmpty";

interface DropTargetProps {
  title: string;
  /** What may be dropped. */
  hint: string;
  /** Asked at every event: another part of the page may take drops now. */
  isOpen?: () => boolean;
  onFiles: (files: DroppedFile[]) => void;
}

/** The whole window takes files, folders and archives, and says so while they are held over it. */
export function DropTarget({ title, hint, isOpen, onFiles }: DropTargetProps) {
  const [isOver, setOver] = useState(false);
  const current = useRef({ isOpen, onFiles });
  current.current = { isOpen, onFiles };
  useEffect(() => {
    let depth = 0;
    const isMeant = (event: DragEvent): boolean => (current.current.isOpen?.() ?? true) && (event.dataTransfer?.types.includes("Files") ?? false);
    const listening = {
      dragenter: (event: DragEvent) => {
        if (!isMeant(event)) return;
        depth += 1;
        setOver(true);
      },
      dragleave: () => {
        depth = Math.max(0, depth - 1);
        if (depth === 0) setOver(false);
      },
      dragover: (event: DragEvent) => {
        if (isMeant(event)) event.preventDefault();
      },
      drop: (event: DragEvent) => {
        if (!isMeant(event) || !event.dataTransfer) return;
        event.preventDefault();
        depth = 0;
        setOver(false);
        void readDrop(event.dataTransfer).then((files) => (files.length > 0 ? current.current.onFiles(files) : tellEmpty()));
      },
    };
    const each = Object.entries(listening) as [keyof typeof listening, (event: DragEvent) => void][];
    each.forEach(([name, listen]) => window.addEventListener(name, listen));
    return () => each.forEach(([name, listen]) => window.removeEventListener(name, listen));
  }, []);
  if (!isOver) return null;
  return (
    <div className={classes.overlay}>
      <Stack align="center" gap="sm" className={classes.sheet}>
        <IconUpload size={48} stroke={1.5} aria-hidden />
        <Text size="xl" fw={600}>
          {title}
        </Text>
        <Text className="quiet">{hint}</Text>
      </Stack>
    </div>
  );
}
