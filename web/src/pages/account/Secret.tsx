import { Alert, Button, CopyButton, Group } from "@mantine/core";
import { IconCheck, IconCopy } from "@tabler/icons-react";
import classes from "./account.module.css";

/** Something that is shown this once. */
export function Secret({ title, text, onDone }: { title: string; text: string; onDone: () => void }) {
  return (
    <Alert title={title} variant="light" color="teal" mb="md">
      <code className={classes.secret} data-testid="secret">
        {text}
      </code>
      <Group mt="sm" gap="sm">
        <CopyButton value={text}>
          {({ copied, copy }) => (
            <Button size="xs" variant="default" leftSection={copied ? <IconCheck size={14} /> : <IconCopy size={14} />} onClick={copy}>
              {copied ? "Copied" : "Copy"}
            </Button>
          )}
        </CopyButton>
        <Button size="xs" variant="subtle" color="gray" onClick={onDone}>
          I have it
        </Button>
      </Group>
    </Alert>
  );
}
