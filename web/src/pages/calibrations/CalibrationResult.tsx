import { Button, Group, Menu, SimpleGrid, Stack, Text, Title } from "@mantine/core";
import { IconChevronDown, IconCircleCheck, IconDownload } from "@tabler/icons-react";
import { calibrationFileUrl, usePlacedBoards, type BoardOptions, type Calibration, type CalibrationResult as Result } from "../../api/calibrations";
import { formatCount } from "../../model/format";
import { Awaited } from "../parts/Awaited";
import { Fact } from "../parts/Fact";
import { Sentences } from "../parts/Sentences";
import { BoardPlot } from "./BoardPlot";
import classes from "./calibrations.module.css";
import { Cameras3d } from "./Cameras3d";
import { CameraTable, sayResidual } from "./CameraTable";
import { Coverage } from "./Coverage";

const FILES: Readonly<Record<string, string>> = {
  "cameras.toml": "Anipose (.toml)",
  "cameras.yaml": "OpenCV (.yaml)",
  "colmap.zip": "COLMAP’s text (.zip)",
  "report.json": "The report, for programs (.json)",
  "report.txt": "The report, for people (.txt)",
  "board.toml": "The board (.toml)",
};

/** The cameras and the report as files. */
export function Downloads({ id, result }: { id: string; result: Result }) {
  return (
    <Menu position="bottom-end">
      <Menu.Target>
        <Button leftSection={<IconDownload size={16} aria-hidden />} rightSection={<IconChevronDown size={14} aria-hidden />}>
          Download
        </Button>
      </Menu.Target>
      <Menu.Dropdown>
        {result.files.map((name) => (
          <Menu.Item key={name} component="a" href={calibrationFileUrl(id, name)} download>
            {FILES[name] ?? name}
          </Menu.Item>
        ))}
      </Menu.Dropdown>
    </Menu>
  );
}

/** m; between the tags of a grid is a gap, but not outside the last ones. */
function measureBoard({ kind, columns, rows, square_mm: square, marker_mm: marker }: BoardOptions): [number, number] {
  const gap = kind === "apriltag" ? square - marker : 0;
  return [(columns * square - gap) / 1000, (rows * square - gap) / 1000];
}

/** What was found: how good it is first, then each camera, then where everything stands and was seen. */
export function CalibrationResult({ calibration, result }: { calibration: Calibration; result: Result }) {
  const placed = usePlacedBoards(calibration.id);
  const boards = placed.data;
  const { fitted, left_out: leftOut, by_other_cameras: others } = result.residual_px;
  return (
    <Stack gap="lg">
      <SimpleGrid cols={{ base: 2, md: 4 }} spacing="md">
        <Fact label="By the other cameras, px">{sayResidual(others)}</Fact>
        <Fact label="Left out, px">{sayResidual(leftOut)}</Fact>
        <Fact label="Fitted, px">{sayResidual(fitted)}</Fact>
        <Fact label="Cameras">{result.cameras.length}</Fact>
      </SimpleGrid>
      <Text size="sm" className="quiet">
        Root mean square / median. Fitted looks good on every calibration. Left out are moments the cameras were not fitted to; by the other cameras is the same, the board placed by the others alone: what triangulating a hand will meet. {result.board}.
      </Text>
      {result.warnings.length > 0 ? (
        <Sentences title={`${formatCount(result.warnings.length, "thing")} to look at before using these cameras`} sentences={result.warnings} isProblem={false} />
      ) : (
        <Group gap="sm" className={`card ${classes.card}`}>
          <IconCircleCheck size={18} color="var(--accent-text)" aria-hidden />
          <Text size="sm">Nothing stands out: all cameras agree, are in step, and saw the board in most of their picture.</Text>
        </Group>
      )}
      <section aria-label="Cameras">
        <CameraTable result={result} />
      </section>
      <div className={classes.result}>
        <section aria-label="In space">
          <Title order={2} mb="sm">
            In space
          </Title>
          {boards ? <Cameras3d result={result} boards={boards} boardSize={measureBoard(calibration.options.board)} /> : <Awaited what="The places of the board" query={placed} height={360} />}
        </section>
        <section aria-label="By moment">
          <Title order={2} mb="sm">
            By moment, px by second
          </Title>
          {boards ? <BoardPlot result={result} boards={boards} /> : <Awaited what="The places of the board" query={placed} height={360} />}
        </section>
      </div>
      <Coverage id={calibration.id} result={result} />
    </Stack>
  );
}
