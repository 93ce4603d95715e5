import { Button, Menu } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { IconChevronDown, IconDownload, IconFileExport } from "@tabler/icons-react";
import { allFrames, smplhFileUrl, useExportBody, type BodyFormat, type BodyFrame, type Population } from "../../api/bodies";
import type { OpenMotion } from "./useMotion";

/** More frames than this are exported by the command line. */
const MOST = 3000;

interface BodyMenusProps {
  population: Population;
  shape: readonly number[];
  frame: BodyFrame;
  open: OpenMotion | null;
}

/** What is shown as a file, and the model for other programs. */
export function BodyMenus({ population, shape, frame, open }: BodyMenusProps) {
  const exporting = useExportBody();
  const save = (format: BodyFormat): void => {
    const frames = format === "glb" && open ? allFrames(open.motion) : [frame];
    exporting.mutate(
      { population, format, shape, frames, fps: open?.motion.fps ?? 30 },
      { onError: (failure) => notifications.show({ color: "red", title: "Not exported", message: failure.message, autoClose: false }) },
    );
  };
  const isTooLong = (open?.motion.poses.length ?? 0) > MOST;
  return (
    <>
      <Menu position="bottom-end">
        <Menu.Target>
          <Button variant="default" loading={exporting.isPending} leftSection={<IconFileExport size={16} aria-hidden />} rightSection={<IconChevronDown size={14} aria-hidden />}>
            Export
          </Button>
        </Menu.Target>
        <Menu.Dropdown>
          <Menu.Item onClick={() => save("obj")}>This pose as OBJ</Menu.Item>
          <Menu.Item onClick={() => save("ply")}>This pose as PLY</Menu.Item>
          <Menu.Item disabled={isTooLong} onClick={() => save("glb")}>
            {open ? "The motion as animated glTF (.glb)" : "This pose as glTF (.glb)"}
          </Menu.Item>
          {isTooLong && <Menu.Label>Motions of more than {MOST.toLocaleString("en")} frames: “handloom body pose”</Menu.Label>}
        </Menu.Dropdown>
      </Menu>
      <Menu position="bottom-end">
        <Menu.Target>
          <Button variant="default" leftSection={<IconDownload size={16} aria-hidden />} rightSection={<IconChevronDown size={14} aria-hidden />}>
            Download the model
          </Button>
        </Menu.Target>
        <Menu.Dropdown>
          <Menu.Item component="a" href={smplhFileUrl(population, "npz")} download>
            SMPL-H file for smplx (.npz)
          </Menu.Item>
          <Menu.Item component="a" href={smplhFileUrl(population, "pkl")} download>
            SMPL-H file for smplx (.pkl)
          </Menu.Item>
        </Menu.Dropdown>
      </Menu>
    </>
  );
}
