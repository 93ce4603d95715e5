import { Button } from "@mantine/core";
import { IconDownload } from "@tabler/icons-react";
import { modelFileUrl, type HandModel } from "../../api/handModels";

/** The model as a file. */
export function ModelDownloads({ model }: { model: HandModel }) {
  if (model.kind === "default" || !model.created_at) return null;
  return (
    <Button variant="default" component="a" href={modelFileUrl(model.id)} download leftSection={<IconDownload size={16} aria-hidden />}>
      Download
    </Button>
  );
}
