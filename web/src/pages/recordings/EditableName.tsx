import { ActionIcon, Group, TextInput, Title, Tooltip } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { IconPencil } from "@tabler/icons-react";
import { useState } from "react";
import { useRenameRecording } from "../../api/recordings";
import type { Recording } from "../../api/types";
import { For } from "../parts/For";

/** A recording's name; the pencil turns it into a field. */
export function EditableName({ recording }: { recording: Recording }) {
  const [draft, setDraft] = useState<string | null>(null);
  const rename = useRenameRecording(recording);
  const keep = (): void => {
    const name = draft?.trim();
    setDraft(null);
    if (!name || name === recording.name) return;
    rename.mutate(name, {
      onError: (failure) => notifications.show({ color: "red", title: "The name was not changed", message: failure.message }),
    });
  };
  if (draft !== null) {
    return (
      <form
        onSubmit={(event) => {
          event.preventDefault();
          keep();
        }}
      >
        <TextInput
          value={draft}
          aria-label="Name of the recording"
          maxLength={200}
          w={480}
          autoFocus
          onChange={(event) => setDraft(event.currentTarget.value)}
          onBlur={keep}
          onKeyDown={(event) => event.key === "Escape" && setDraft(null)}
        />
      </form>
    );
  }
  return (
    <Group gap="sm" wrap="nowrap">
      <Title order={1} className="few-lines" title={recording.name}>
        {rename.isPending ? rename.variables : recording.name}
      </Title>
      <For role="lead">
        <Tooltip label="Rename">
          <ActionIcon aria-label="Rename the recording" onClick={() => setDraft(recording.name)}>
            <IconPencil size={16} />
          </ActionIcon>
        </Tooltip>
      </For>
    </Group>
  );
}
