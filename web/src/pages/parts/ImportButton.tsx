import { Button, Menu } from "@mantine/core";
import { IconChevronDown, IconFiles, IconFolder, IconUpload } from "@tabler/icons-react";
import { useRef, type ChangeEvent } from "react";
import { useNavigate } from "react-router";
import { readChoice } from "../../actions/readDrop";
import { sendIncoming } from "../../state/incoming";
import { For } from "./For";
import { tellEmpty } from "./tellEmpty";

/** Choose files or a folder without dragging. */
export function ImportButton({ label = "Import a recording" }: { label?: string }) {
  const files = useRef<HTMLInputElement>(null);
  const folder = useRef<HTMLInputElement>(null);
  const navigate = useNavigate();
  const take = (event: ChangeEvent<HTMLInputElement>): void => {
    const chosen = event.target.files ? readChoice(event.target.files) : [];
    event.target.value = "";
    if (chosen.length === 0) return tellEmpty();
    void sendIncoming(chosen);
    void navigate("/imports/new");
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
          <Menu.Item leftSection={<IconFolder size={16} aria-hidden />} onClick={() => folder.current?.click()}>
            A folder …
          </Menu.Item>
          <Menu.Item leftSection={<IconFiles size={16} aria-hidden />} onClick={() => files.current?.click()}>
            Files or a .zip …
          </Menu.Item>
        </Menu.Dropdown>
      </Menu>
      <input ref={files} type="file" multiple hidden onChange={take} data-testid="choose-files" aria-label="Choose files to import" />
      <input
        ref={(element) => {
          folder.current = element;
          element?.setAttribute("webkitdirectory", "");
        }}
        type="file"
        multiple
        hidden
        onChange={take}
        data-testid="choose-folder"
        aria-label="Choose a folder to import"
      />
    </For>
  );
}
