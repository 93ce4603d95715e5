import { Text, Title } from "@mantine/core";
import { useMemo, useState } from "react";
import { Plot } from "../../canvas/Plot";
import type { Curve } from "../../canvas/series";
import { formatCount, formatDuration, formatName, formatNumber } from "../../model/format";
import { trackStyle } from "../../model/trackStyle";
import type { ComponentCurve, HeldOutStudy, NamedValue, TrainingReport } from "../../model/trainingReport";
import classes from "./Models.module.css";

interface Line {
  readonly label: string;
  readonly curve: ComponentCurve;
  readonly scale?: number;
}

/** Curves over the number of components, or of passes; a click reads the values there. */
function Curves({ title, note, axis, unit, digits, lines }: { title: string; note: string; axis: string; unit: string; digits: number; lines: readonly Line[] }) {
  const [at, setAt] = useState<number | null>(null);
  const shown = useMemo(() => lines.filter(({ curve }) => curve.values.length > 0), [lines]);
  const places = useMemo(() => [...new Set(shown.flatMap(({ curve }) => curve.components))].sort((a, b) => a - b), [shown]);
  const curves = useMemo(
    () =>
      shown.map(({ label, curve, scale = 1 }, place): Curve => {
        const { color, dash } = trackStyle(place);
        const values = places.map((component) => {
          const found = curve.values[curve.components.indexOf(component)];
          return found === undefined ? null : scale * found;
        });
        return { label, unit, values, color, ...(dash ? { dash } : {}), axis, digits, hasDots: curve.values.length <= MOST_DOTS };
      }),
    [shown, places, axis, unit, digits],
  );
  if (shown.length === 0) return null;
  const common = Math.min(...shown.map(({ curve }) => curve.components.at(-1) ?? 0));
  return (
    <section className={`card ${classes.plot}`} aria-label={title}>
      <div className={classes.plotTitle}>
        <Title order={3}>{title}</Title>
        <Text size="xs" className="quiet">
          {note}
        </Text>
      </div>
      <Plot label={title} frames={places} curves={curves} lost={NONE} frame={at ?? common} onSeek={setAt} joinsAll />
    </section>
  );
}

const NONE: readonly number[] = [];

/** More of them would only thicken the line. */
const MOST_DOTS = 24;

function Bars({ title, note, rows, show }: { title: string; note: string; rows: readonly NamedValue[]; show: (value: number) => string }) {
  if (rows.length === 0) return null;
  const most = Math.max(...rows.map((row) => row.value), 1e-9);
  return (
    <section className="card" aria-label={title} style={{ padding: "12px 16px" }}>
      <Title order={3}>{title}</Title>
      <Text size="xs" className="quiet" mb="sm">
        {note}
      </Text>
      <table className={classes.bars}>
        <thead className="visually-hidden">
          <tr>
            <th scope="col">Name</th>
            <td />
            <th scope="col">Value</th>
          </tr>
        </thead>
        <tbody>
          {rows.slice(0, 12).map((row) => (
            <tr key={row.name}>
              <th scope="row">
                {formatName(row.name)}
                {row.count !== null && <span className="quiet"> ({row.count})</span>}
              </th>
              <td aria-hidden>
                <div className={classes.bar} style={{ width: `${(100 * row.value) / most}%` }} />
              </td>
              <td>{show(row.value)}</td>
            </tr>
          ))}
        </tbody>
      </table>
      {rows.length > 12 && (
        <Text size="xs" className="quiet" mt={4}>
          The 12 largest of {rows.length}.
        </Text>
      )}
    </section>
  );
}

const mm = (value: number): string => `${formatNumber(value, 2)} mm`;
const mm3 = (value: number): string => `${formatNumber(value, 3)} mm`;

/** How good a trained model is, as plots: [R17] Fig. 12 to 14 and what is beside them in a report. */
export function ReportPlots({ report }: { report: TrainingReport }) {
  const compactness = useMemo(
    () => [
      { label: "Shape space", curve: report.shapeCompactness, scale: 100 },
      { label: "Pose space", curve: report.poseCompactness, scale: 100 },
    ],
    [report],
  );
  const shapes = useMemo(() => [{ label: "People left out in turn", curve: report.shapeGeneralisation }], [report]);
  const passes = useMemo(() => [{ label: "To its registrations", curve: { components: report.roundsMm.map((_, at) => at + 1), values: report.roundsMm } }], [report]);
  return (
    <>
      <HeldOut study={report.heldOut} />
      <section aria-label="What it has learnt">
        <Title order={2} mb="sm">
          What it has learnt
        </Title>
        <div className={classes.plots}>
          <Curves title="Compactness" note="Variance explained by this many components" axis="Variance, %" unit="%" digits={1} lines={compactness} />
          <Curves title="Generalisation of shapes" note="Mean error of templates, by number of shape components" axis="Mean error, mm" unit="mm" digits={2} lines={shapes} />
          <Curves title="Passes" note="Distance of the model to what it learns from after each pass" axis="Distance, mm" unit="mm" digits={3} lines={passes} />
          <Bars title="By hand" note="Distance to the registrations, and how many" rows={report.byHand} show={mm} />
          <Bars title="By pose" note="Distance to the registrations, and how many" rows={report.byPose} show={mm} />
          <Bars title="Time" note="Time of each stage of training" rows={report.seconds} show={formatDuration} />
        </div>
      </section>
    </>
  );
}

/** The model on people it has not seen, beside others: or how to get to know that. */
function HeldOut({ study }: { study: HeldOutStudy | null }) {
  const poses = useMemo(() => (study?.poseGeneralisation ?? []).map(({ name, curve }) => ({ label: formatName(name), curve })), [study]);
  return (
    <section aria-label="People kept for testing">
      <Title order={2}>People kept for testing</Title>
      {study ? (
        <>
          <Text size="sm" className="quiet" mb="sm">
            {formatCount(study.scans, "scan")} of {study.people.length === 1 ? "subject" : "subjects"} {study.people.join(", ")}, of whom nothing was learnt. Less is better.
            {study.floorMm !== null && ` Their registrations themselves lie ${mm(study.floorMm)} from the scans.`}
          </Text>
          <div className={classes.plots}>
            <Bars title="Scan to mesh" note="Pose and shape fitted" rows={study.models.scanToMesh} show={mm3} />
            <Bars title="Scan to mesh, own template" note="A template of each person, the pose fitted" rows={study.ownTemplate.scanToMesh} show={mm3} />
            <Bars title="Vertices" note="To those of the registration; pose and shape fitted" rows={study.models.vertices} show={mm3} />
            <Bars title="Vertices, own template" note="To those of the registration; the pose fitted" rows={study.ownTemplate.vertices} show={mm3} />
            <Curves title="Generalisation of poses" note="Scan to mesh, by number of pose components" axis="Scan to mesh, mm" unit="mm" digits={2} lines={poses} />
          </div>
          {study.notCompared.map(({ name, why }) => (
            <Text key={name} size="xs" className="quiet" mt={4}>
              Not compared: {name}. {why}
            </Text>
          ))}
        </>
      ) : (
        <Text size="sm" className={`card ${classes.unknown}`}>
          It was not evaluated on people it has not seen. When you train, or in the loop, leave subjects out and choose to evaluate: their scans then show how the model does with fewer pose components, without its blend shapes, and beside the
          untrained hand.
        </Text>
      )}
    </section>
  );
}
