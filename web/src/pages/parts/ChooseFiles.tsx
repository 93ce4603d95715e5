import { Button, Menu } from "@mantine/core";
import { IconChevronDown, IconFiles, IconFolder, IconUpload } from "@tabler/icons-react";
import { useRef, type ChangeEvent } from "react";
import { readChoice } from "../../actions/readDrop";
import type { DroppedFile } from "../../api/imports";
import { For } from "./For";
import { tellEmpty } from "./tellEmpty";

interface ChooseFilesProps {
  label: string;
  /** In the menu: "A folder". */
  folder: string;
  /** What the files are for, after "files" and "a folder": "to import". */
  what: string;
  /** Suffixes; all when left out. */
  accept?: string;
  testId: string;
  onFiles: (files: DroppedFile[]) => void;
}

/** Choose files or a folder without dragging; leads add. */
export function ChooseFiles({ label, folder, what, accept, testId, onFiles }: ChooseFilesProps) {
  const files = useRef<HTMLInputElement>(null);
  const folderChoice = useRef<HTMLInputElement>(null);
  const take = (event: ChangeEvent<HTMLInputElement>): void => {
    const chosen = event.target.files ? readChoice(event.target.files) : [];
    event.target.value = "";
    if (chosen.length === 0) return tellEmpty();
    onFiles(chosen);
  };
  return (
    <For role="lead">
      <Menu position="bottom-end" withinPortal>
        <Menu.Target>
          <Button leftSection={<IconUpload size={16} aria-hidden />} rightSection={<IconChevronDown size={14} aria-hidden />}>
            {label}
          </Button>
        </Menu.Target>
        <Menu.Dropdown>
          <Menu.Item leftSection={<IconFolder size={16} aria-hidden />} onClick={() => folderChoice.current?.click()}>
            {folder} …
          </Menu.Item>
          <Menu.Item leftSection={<IconFiles size={16} aria-hidden />} onClick={() => files.current?.click()}>
            Files or a .zip …
          </Menu.Item>
        </Menu.Dropdown>
      </Menu>
      <input ref={files} type="file" multiple hidden {...(accept ? { accept } : {})} onChange={take} data-testid={`${testId}-files`} aria-label={`Choose files ${what}`} />
      <input
        ref={(element) => {
          folderChoice.current = element;
          element?.setAttribute("webkitdirectory", "");
        }}
        type="file"
        multiple
        hidden
        onChange={take}
        data-testid={`${testId}-folder`}
        aria-label={`Choose a folder ${what}`}
      />
    </For>
  );
}
