import { Button, Checkbox, Group, NumberInput, SegmentedControl, Select, SimpleGrid, Stack, Text, Title } from "@mantine/core";
import { IconDownload } from "@tabler/icons-react";
import { useDebouncedValue } from "@mantine/hooks";
import { useState } from "react";
import { askBoardFault, boardUrl, type BoardOptions, type CalibrationForm } from "../../api/calibrations";
import { formatNumber } from "../../model/format";
import classes from "./calibrations.module.css";

interface BoardFormProps {
  form: CalibrationForm;
  board: BoardOptions;
  onChange: (board: BoardOptions) => void;
}

const plain = (name: string): string => name.replace(/^DICT_/, "");

/** A picture of the board as it is described, or why there is no such board. */
function BoardPicture({ board }: { board: BoardOptions }) {
  const [settled] = useDebouncedValue(board, 250);
  const address = boardUrl(settled, "png");
  const [fault, setFault] = useState<{ address: string; said: string } | null>(null);
  const ask = (): void => void askBoardFault(settled).then((said) => setFault({ address, said }));
  if (fault?.address === address)
    return (
      <Text size="sm" c="var(--bad-text)" role="alert" mih={240}>
        {fault.said}
      </Text>
    );
  return <img key={address} src={address} alt={`The board: ${board.columns} by ${board.rows}`} className={classes.board} onError={ask} />;
}

/** Which board was filmed; printed from here it is the same. */
export function BoardForm({ form, board, onChange }: BoardFormProps) {
  const set = (change: Partial<BoardOptions>): void => onChange({ ...board, ...change });
  const number = (name: "columns" | "rows" | "square_mm" | "marker_mm", label: string) => (
    <NumberInput
      label={label}
      value={board[name]}
      min={name === "marker_mm" ? 0 : 1}
      max={name === "columns" || name === "rows" ? 40 : 1000}
      allowDecimal={name.endsWith("mm")}
      decimalScale={4}
      clampBehavior="strict"
      onChange={(value) => typeof value === "number" && set({ [name]: value })}
    />
  );
  const kind = form.boards.find((choice) => choice.board.kind === board.kind);
  const hasMarkers = board.kind !== "checkerboard";
  const isGrid = board.kind === "apriltag";
  const gap = isGrid ? board.square_mm - board.marker_mm : 0;
  const size = [board.columns, board.rows].map((count) => formatNumber(count * board.square_mm - gap, 0));
  return (
    <Stack gap="md" className={`card ${classes.card}`} component="section" aria-label="The board">
      <Group justify="space-between" wrap="nowrap">
        <Title order={2}>The board</Title>
        <Button component="a" href={boardUrl(board, "pdf")} download variant="default" size="compact-sm" leftSection={<IconDownload size={14} aria-hidden />}>
          Print (PDF)
        </Button>
      </Group>
      <BoardPicture board={board} />
      <Text size="xs" className="quiet">
        {size.join(" x ")} mm. Print at 100 %, measure the line below the board, and glue the sheet to something flat.
      </Text>
      <div>
        <SegmentedControl
          fullWidth
          aria-label="Kind of board"
          value={board.kind}
          data={form.boards.map((choice) => ({ value: choice.board.kind, label: choice.label }))}
          onChange={(value) => {
            const chosen = form.boards.find((choice) => choice.board.kind === value);
            if (chosen) onChange(chosen.board);
          }}
        />
        <Text size="xs" className="quiet" mt={4}>
          {kind?.about}
        </Text>
      </div>
      <SimpleGrid cols={2} spacing="sm">
        {number("columns", isGrid ? "Tags across" : "Squares across")}
        {number("rows", isGrid ? "Tags down" : "Squares down")}
        {number("square_mm", isGrid ? "From tag to tag, mm" : "Square, mm")}
        {hasMarkers && number("marker_mm", isGrid ? "Tag, mm" : "Marker, mm")}
      </SimpleGrid>
      {hasMarkers && (
        <Select
          label="Markers"
          description="OpenCV’s family"
          searchable
          allowDeselect={false}
          data={form.dictionaries.map((value) => ({ value, label: plain(value) }))}
          value={board.dictionary}
          onChange={(dictionary) => dictionary && set({ dictionary })}
        />
      )}
      <Group gap="md">
        <Checkbox label="White on black" checked={board.inverted} onChange={(event) => set({ inverted: event.currentTarget.checked })} />
        {board.kind === "charuco" && <Checkbox label="Drawn before OpenCV 4.6" checked={board.legacy} onChange={(event) => set({ legacy: event.currentTarget.checked })} />}
      </Group>
    </Stack>
  );
}
