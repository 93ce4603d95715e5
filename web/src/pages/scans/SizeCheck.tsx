import { Badge, Checkbox, Group, Stack, Text } from "@mantine/core";
import type { ScansMeasured } from "../../api/scans";
import { formatCount, formatRough } from "../../model/format";
import { formatSize, isGuess, judgeSize, unitOf, type SizeLimits, type UnitAnswers } from "../../model/scanUnit";
import { HandForScale } from "./HandForScale";
import classes from "./SizeCheck.module.css";
import { UnitField } from "./UnitField";

interface SizeCheckProps {
  measured: ScansMeasured;
  answers: UnitAnswers;
  /** Of the file that is shown beside the hand. */
  shown: number;
  isOnlyThis: boolean;
  isConfirmed: boolean;
  onAnswers: (answers: UnitAnswers) => void;
  onShow: (index: number) => void;
  onOnlyThis: (isOnly: boolean) => void;
  onConfirm: (isConfirmed: boolean) => void;
}

export const limitsOf = ({ hand_lengths_m: [least = 0, most = 0], longest_scene_m: scene }: ScansMeasured): SizeLimits => ({ hand: [least, most], scene });

/** How large the chosen scans would be, beside a hand, and the unit that makes them so. */
export function SizeCheck({ measured, answers, shown, isOnlyThis, isConfirmed, onAnswers, onShow, onOnlyThis, onConfirm }: SizeCheckProps) {
  const { files } = measured;
  const one = files[shown] ?? files[0];
  if (!one) return null;
  const unit = unitOf(one, answers);
  const guesses = files.filter((file) => isGuess(file, answers)).length;
  const length = unit === null ? null : unit * (one.size_units[0] ?? 0);
  const verdict = length === null ? null : judgeSize(length, limitsOf(measured));
  const isListed = one.metres_per_unit !== null;
  const change = (metres: number): void => onAnswers(isOnlyThis ? { ...answers, own: { ...answers.own, [one.file]: metres } } : { all: metres, own: {} });
  return (
    <section aria-label="Unit and size" className={classes.section}>
      <div className={classes.columns}>
        <ul className={classes.files} aria-label="Scans in it">
          {files.map((file, index) => {
            const its = unitOf(file, answers);
            const state = its === null ? "bad" : judgeSize(its * (file.size_units[0] ?? 0), limitsOf(measured)).state;
            return (
              <li key={file.file}>
                <button type="button" className={classes.file} aria-current={file === one} onClick={() => onShow(index)}>
                  <span className="one-line" title={file.file}>
                    {file.file}
                  </span>
                  <span className={classes.size} data-state={state}>
                    {its === null ? "unit unknown" : formatSize(file.size_units.map((side) => side * its))}
                    {state === "bad" && its !== null ? ", no hand’s size" : state === "crop" ? ", to be cropped" : ""}
                  </span>
                </button>
              </li>
            );
          })}
        </ul>
        {length !== null && unit !== null ? (
          <HandForScale picture={one.picture} pictureSide={one.picture_units * unit} length={length} />
        ) : (
          <Text size="sm" className="quiet" p="md">
            It is {formatRough(one.size_units[0] ?? 0)} units long. In no usual unit is that a hand: say the unit, and it is shown here beside one.
          </Text>
        )}
      </div>
      {isListed ? (
        <Text size="sm">The unit of this scan comes from its scans.json.</Text>
      ) : (
        <UnitField key={isOnlyThis ? one.file : ""} value={unit} units={one.size_units[0] ?? null} onChange={change} />
      )}
      {files.length > 1 && !isListed && <Checkbox size="xs" label={`Change the unit of ${one.file} alone`} checked={isOnlyThis} onChange={(event) => onOnlyThis(event.currentTarget.checked)} />}
      {verdict && verdict.state !== "good" && (
        <Text size="sm" c={verdict.state === "bad" ? "var(--bad-text)" : "var(--warn-text)"} role="status">
          {verdict.text}
        </Text>
      )}
      {guesses > 0 && (
        <Stack gap={4} className={classes.guess}>
          <Group gap="sm" wrap="nowrap" align="flex-start">
            <Badge color="yellow" variant="outline" c="var(--mantine-color-text)" style={{ flex: "none" }}>
              Guess
            </Badge>
            <Text size="sm">
              {files.length === 1 ? "The file does not say its unit" : `${formatCount(guesses, "file does", "files do")} not say the unit`}: it was guessed from the size. Is the scan as long as that hand should be? With a forearm it is longer than the hand beside it.
            </Text>
          </Group>
          <Checkbox label={files.length === 1 ? "The size is right" : "The sizes are right"} checked={isConfirmed} onChange={(event) => onConfirm(event.currentTarget.checked)} />
        </Stack>
      )}
    </section>
  );
}
