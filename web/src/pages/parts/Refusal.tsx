import { List, Text } from "@mantine/core";
import { ApiError } from "../../api/client";
import classes from "./Refusal.module.css";

interface RefusalProps {
  error: Error;
  /** What is safe: "Nothing was stored." */
  after?: string;
}

/** What came, what is needed and what to do, in one sentence; what else was found is folded. */
export function Refusal({ error, after }: RefusalProps) {
  const found = error instanceof ApiError ? error.body["details"] : undefined;
  return (
    <div role="alert" className={classes.box}>
      <Text size="sm" c="var(--bad-text)">
        {error.message} {after}
      </Text>
      {Array.isArray(found) && found.length > 0 && <Details sentences={found.map(String)} />}
    </div>
  );
}

/** Sentences for those who want to know. */
export function Details({ sentences }: { sentences: readonly string[] }) {
  return (
    <details className={classes.details}>
      <summary>Details</summary>
      <List size="sm" spacing={4}>
        {sentences.map((sentence) => (
          <List.Item key={sentence}>{sentence}</List.Item>
        ))}
      </List>
    </details>
  );
}
