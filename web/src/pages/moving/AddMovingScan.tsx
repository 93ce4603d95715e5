import { Button, Menu } from "@mantine/core";
import { IconChevronDown, IconFiles, IconFolder, IconUpload } from "@tabler/icons-react";
import { useRef, type ChangeEvent } from "react";
import { readChoice } from "../../actions/readDrop";
import { hasRole, useMe } from "../../state/me";
import { chooseMovingScan } from "../../state/movingUpload";
import { DropTarget } from "../parts/DropTarget";
import { For } from "../parts/For";
import { tellEmpty } from "../parts/tellEmpty";

/** Choose a folder of scans, or files, without dragging; leads add. */
export function AddMovingScanButton({ label }: { label: string }) {
  const files = useRef<HTMLInputElement>(null);
  const folder = useRef<HTMLInputElement>(null);
  const take = (event: ChangeEvent<HTMLInputElement>): void => {
    const chosen = event.target.files ? readChoice(event.target.files) : [];
    event.target.value = "";
    if (chosen.length === 0) return tellEmpty();
    chooseMovingScan(chosen);
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
            A folder of scans …
          </Menu.Item>
          <Menu.Item leftSection={<IconFiles size={16} aria-hidden />} onClick={() => files.current?.click()}>
            Files or a .zip …
          </Menu.Item>
        </Menu.Dropdown>
      </Menu>
      <input ref={files} type="file" multiple hidden accept=".ply,.obj,.stl,.zip" onChange={take} data-testid="choose-moving-files" aria-label="Choose scans of a moving person" />
      <input
        ref={(element) => {
          folder.current = element;
          element?.setAttribute("webkitdirectory", "");
        }}
        type="file"
        multiple
        hidden
        onChange={take}
        data-testid="choose-moving-folder"
        aria-label="Choose a folder of scans of a moving person"
      />
    </For>
  );
}

/** A folder may be dropped anywhere on the page. */
export function MovingDrops() {
  const mayAdd = hasRole(useMe(), "lead");
  return (
    <div data-takes-drops>
      {mayAdd && <DropTarget title="Drop to add a moving scan" hint="A folder of PLY, OBJ or STL files of one person, one a frame, or a .zip of it." onFiles={chooseMovingScan} />}
    </div>
  );
}
