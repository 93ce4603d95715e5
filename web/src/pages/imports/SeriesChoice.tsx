import { Badge, Group, Radio, SimpleGrid, Text } from "@mantine/core";
import type { ImportQuestion } from "../../api/types";
import { formatCount } from "../../model/format";
import { Thumbnails } from "./ImportPictures";
import classes from "./SeriesChoice.module.css";

interface SeriesChoiceProps {
  importId: string;
  question: ImportQuestion;
  /** Null before somebody chose. */
  chosen: string | null;
  onChoose: (value: string) => void;
}

/** Which series of files is it? Answered by a click on its pictures. */
export function SeriesChoice({ importId, question, chosen, onChoose }: SeriesChoiceProps) {
  return (
    <Radio.Group
      label={question.label}
      description={question.ask}
      value={chosen ?? ""}
      onChange={onChoose}
      withAsterisk={question.is_required}
      error={question.is_required && chosen === null ? "Choose one" : undefined}
      data-needed={question.is_required || undefined}
    >
      <SimpleGrid cols={{ base: 1, sm: 2 }} spacing="sm" my="sm">
        {question.choices.map(({ value, label, count, detail, pictures }) => (
          <Radio.Card key={String(value)} value={String(value)} className={classes.card} aria-label={label}>
            <Group gap="sm" mb={pictures.length > 0 ? 8 : 0}>
              <Radio.Indicator size="xs" />
              <Text fw={600}>{label}</Text>
              {count > 0 && (
                <Text size="sm" className="quiet">
                  {formatCount(count, "image")}, {detail}
                </Text>
              )}
              {value === question.proposal && chosen === null && (
                <Badge variant="light" tt="none">
                  a guess: {question.proposed_by}
                </Badge>
              )}
            </Group>
            {pictures.length > 0 && <Thumbnails importId={importId} names={pictures} what={label} />}
          </Radio.Card>
        ))}
      </SimpleGrid>
    </Radio.Group>
  );
}
