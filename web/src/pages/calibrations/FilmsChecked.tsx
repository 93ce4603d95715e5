import { Button, Group, Stack, Table, Text, Title } from "@mantine/core";
import { useState } from "react";
import { useCalibrationForm, useCheckFilms, type Calibration, type FilmReport } from "../../api/calibrations";
import { mayStart, useJobCheck } from "../../api/jobChecks";
import { useStartJob } from "../../api/startJob";
import { formatNumber } from "../../model/format";
import { hasRole, useMe } from "../../state/me";
import { Awaited } from "../parts/Awaited";
import { For } from "../parts/For";
import { Obstacles } from "../parts/Obstacles";
import { Refusal } from "../parts/Refusal";
import { Sentences } from "../parts/Sentences";
import { BoardForm } from "./BoardForm";
import classes from "./calibrations.module.css";
import { OptionsForm } from "./OptionsForm";

function Films({ cameras }: { cameras: FilmReport["cameras"] }) {
  return (
    <div className={`card ${classes.table}`}>
      <Table verticalSpacing="xs" horizontalSpacing="md">
        <Table.Thead>
          <Table.Tr>
            <Table.Th>Camera</Table.Th>
            <Table.Th>Film</Table.Th>
            <Table.Th ta="right">Frames</Table.Th>
            <Table.Th ta="right">A second</Table.Th>
            <Table.Th ta="right">Lasts, s</Table.Th>
            <Table.Th ta="right">Size, px</Table.Th>
          </Table.Tr>
        </Table.Thead>
        <Table.Tbody>
          {cameras.map(({ name, kind, frames, fps, width, height }) => (
            <Table.Tr key={name}>
              <Table.Td className={classes.name} title={name}>
                {name}
              </Table.Td>
              <Table.Td>{kind}</Table.Td>
              <Table.Td ta="right">{frames || "–"}</Table.Td>
              <Table.Td ta="right">{formatNumber(fps || null, 2)}</Table.Td>
              <Table.Td ta="right">{formatNumber(fps && frames ? frames / fps : null, 2)}</Table.Td>
              <Table.Td ta="right">
                {width} x {height}
              </Table.Td>
            </Table.Tr>
          ))}
        </Table.Tbody>
      </Table>
    </div>
  );
}

/** What was found in the films before the board is looked for, the options to mend it, and the start. */
export function FilmsChecked({ calibration }: { calibration: Calibration }) {
  const query = useCalibrationForm();
  const form = query.data;
  const [draft, setDraft] = useState(calibration.options);
  const check = useCheckFilms(calibration.id);
  const start = useStartJob();
  const { report } = calibration;
  const me = useMe();
  const isLead = hasRole(me, "lead");
  const isChanged = JSON.stringify(draft) !== JSON.stringify(calibration.options);
  const wish = { kind: "calibrate" as const, calibration_id: calibration.id };
  const obstacles = useJobCheck(wish, report.problems.length === 0 && hasRole(me, "reviewer"));
  const count = report.problems.length;
  return (
    <div className={classes.columns}>
      <Stack gap="md">
        <Sentences title={count === 1 ? "One thing must be fixed" : `${count} things must be fixed`} sentences={report.problems} isProblem />
        <Sentences title="Worth knowing" sentences={report.notes} isProblem={false} />
        {report.cameras.length > 0 && (
          <section aria-label="Films">
            <Title order={2} mb="sm">
              Films
            </Title>
            <Films cameras={report.cameras} />
            <Text size="xs" className="quiet" mt={4}>
              {report.lenses.length > 0 ? `Known lenses, kept as they are: ${report.lenses.join(", ")}. ` : ""}The first camera’s frame is the world. Every frame is looked at: a minute from four cameras takes about three.
            </Text>
          </section>
        )}
        <fieldset disabled={!isLead} className={classes.fields}>
          <OptionsForm options={draft} onChange={setDraft} />
        </fieldset>
      </Stack>
      <fieldset disabled={!isLead} className={classes.fields}>
        {form ? <BoardForm form={form} board={draft.board} onChange={(board) => setDraft({ ...draft, board })} /> : <Awaited what="The form" query={query} height={640} />}
      </fieldset>
      <Stack gap="md">
        {check.error && <Refusal error={check.error} after="Nothing was changed." />}
        {!isChanged && <Obstacles check={count === 0 ? obstacles.data : undefined} failure={start.error} />}
        {!isLead && (
          <Text size="sm" className="quiet">
            A lead describes the board and the cameras’ clocks.
          </Text>
        )}
        <Group justify="flex-end" gap="sm">
          <For role="lead">
            <Button variant={isChanged || count > 0 ? "filled" : "default"} loading={check.isPending} disabled={!isChanged} onClick={() => check.mutate(draft)}>
              Check again
            </Button>
          </For>
          <For role="reviewer">
            <Button loading={start.isPending} disabled={isChanged || count > 0 || !mayStart(obstacles)} onClick={() => start.mutate(wish)}>
              Calibrate
            </Button>
          </For>
        </Group>
      </Stack>
    </div>
  );
}
