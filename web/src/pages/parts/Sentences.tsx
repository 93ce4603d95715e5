import { Group, List, Text } from "@mantine/core";
import { IconAlertTriangle, IconCircleX } from "@tabler/icons-react";
import { Details } from "./Refusal";
import classes from "./Sentences.module.css";

/** More than this are folded. */
const SHOWN = 4;

interface SentencesProps {
  title: string;
  sentences: readonly string[];
  isProblem: boolean;
}

/** Problems or warnings as they were written for people. */
export function Sentences({ title, sentences, isProblem }: SentencesProps) {
  if (sentences.length === 0) return null;
  const Icon = isProblem ? IconCircleX : IconAlertTriangle;
  return (
    <section className={`card ${classes.box}`} data-problem={isProblem} aria-label={title}>
      <Group gap="sm" mb={4} wrap="nowrap" className={classes.title}>
        <Icon size={18} aria-hidden />
        <Text fw={600}>{title}</Text>
      </Group>
      <List size="sm" spacing={4} withPadding>
        {sentences.slice(0, SHOWN).map((sentence) => (
          <List.Item key={sentence} style={{ overflowWrap: "anywhere" }}>
            {sentence}
          </List.Item>
        ))}
      </List>
      {sentences.length > SHOWN && <Details sentences={sentences.slice(SHOWN)} />}
    </section>
  );
}
