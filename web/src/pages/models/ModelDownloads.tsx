import { Button, Menu } from "@mantine/core";
import { IconChevronDown, IconDownload } from "@tabler/icons-react";
import { manoFileUrl, modelFileUrl, reportFileUrl, type HandModel } from "../../api/handModels";

/** The model as a file: for Handloom, or as MANO for either hand; and its report. */
export function ModelDownloads({ model }: { model: HandModel }) {
  if (model.kind === "default") return null;
  return (
    <Menu position="bottom-end">
      <Menu.Target>
        <Button variant="default" leftSection={<IconDownload size={16} aria-hidden />} rightSection={<IconChevronDown size={14} aria-hidden />}>
          Download
        </Button>
      </Menu.Target>
      <Menu.Dropdown>
        {model.created_at && (
          <Menu.Item component="a" href={modelFileUrl(model.id)} download>
            The model (.npz), for Handloom
          </Menu.Item>
        )}
        {model.has_report && (
          <Menu.Item component="a" href={reportFileUrl(model.id)} download>
            The report (.html), with its plots
          </Menu.Item>
        )}
        <Menu.Item component="a" href={manoFileUrl(model.id, "right")} download>
          MANO file, right hand
        </Menu.Item>
        <Menu.Item component="a" href={manoFileUrl(model.id, "left")} download>
          MANO file, left hand
        </Menu.Item>
      </Menu.Dropdown>
    </Menu>
  );
}
