import { Button, Group, SimpleGrid, Text, Title } from "@mantine/core";
import { IconDownload, IconUsers } from "@tabler/icons-react";
import type { ReactNode } from "react";
import { Link, useParams, useSearchParams } from "react-router";
import { agreementFile, useAgreement, type AgreementReport, type Spread } from "../../api/teams";
import { formatMeasure, formatNumber } from "../../model/format";
import { describeLeftOut, INDEPENDENT } from "../../model/source";
import { EmptyState } from "../parts/EmptyState";
import { Fact } from "../parts/Fact";
import { Failure } from "../parts/Failure";
import { LeftOut } from "../parts/LeftOut";
import { PageSkeleton } from "../parts/PageSkeleton";
import { SourceFilter } from "../parts/SourceFilter";
import { useTitle } from "../parts/useTitle";
import classes from "./projects.module.css";

const px = (value: number | null | undefined): string => formatNumber(value, 2);
const share = (value: number | null | undefined): string => (value === null || value === undefined ? "–" : `${(100 * value).toFixed(1)} %`);
const signed = (value: number | null): string => (value === null ? "–" : `${value >= 0 ? "+" : "−"}${Math.abs(value).toFixed(2)}`);

/** How well people agree who marked the same frames without seeing each other. */
export default function AgreementPage() {
  const { projectId, setId } = useParams();
  const [address, setAddress] = useSearchParams();
  const sources = address.get("sources")?.split(",") ?? [INDEPENDENT];
  const choose = (chosen: readonly string[]): void => setAddress(chosen.join() === INDEPENDENT ? {} : { sources: chosen.join(",") }, { replace: true });
  const { data: report, error, refetch } = useAgreement(setId, sources);
  useTitle(report ? `Agreement: ${report.name}` : "Agreement");
  if (error) {
    return (
      <Failure what="The agreement could not be shown" error={error} safe="What was marked is untouched." onRetry={() => void refetch()}>
        <Button variant="default" component={Link} to={`/projects/${projectId}`}>
          To the project
        </Button>
      </Failure>
    );
  }
  if (!report || !setId) return <PageSkeleton />;
  const hasMeasures = report.overall.samples > 0;
  return (
    <div className="page">
      <Group justify="space-between" align="flex-start" mb="lg" wrap="nowrap">
        <div style={{ minWidth: 0 }}>
          <Title order={1} className="few-lines">
            Agreement: {report.name}
          </Title>
          <Text className="quiet">
            <Link to={`/recordings/${report.sequence_id}`} style={{ color: "inherit" }}>
              {report.recording}
            </Link>
            {report.waiting.length > 0 && ` · not submitted yet, and left out: ${report.waiting.join(", ")}`}
          </Text>
        </div>
        <Group gap="sm" wrap="nowrap">
          <SourceFilter chosen={sources} onChange={choose} />
          {hasMeasures && (["html", "csv", ""] as const).map((kind) => (
            <Button key={kind} size="xs" variant="default" component="a" href={agreementFile(setId, kind, sources)} download={`agreement.${kind || "json"}`} leftSection={<IconDownload size={14} aria-hidden />}>
              {kind ? kind.toUpperCase() : "JSON"}
            </Button>
          ))}
        </Group>
      </Group>
      {!hasMeasures && <NothingYet report={report} projectId={projectId} />}
      {hasMeasures && <Measures report={report} />}
      <LeftOut sources={report.sources} onSources={choose} />
      {hasMeasures && <Tables report={report} />}
    </div>
  );
}

/** Before two people have marked the same joint there is nothing to compare, and no table of dashes says so better. */
function NothingYet({ report, projectId }: { report: AgreementReport; projectId: string | undefined }) {
  const submitted = report.annotators.map((one) => one.name);
  const areMissing = submitted.length < 2;
  return (
    <EmptyState
      icon={<IconUsers size={48} stroke={1.25} />}
      title="Nothing to compare yet"
      action={
        <Button variant="default" component={Link} to={`/projects/${projectId}`}>
          To the project
        </Button>
      }
    >
      {areMissing
        ? `At least two people must submit their work; ${submitted.length === 0 ? "nobody has" : `only ${submitted[0]} has`} so far.`
        : `No joint counts that two people have placed. ${describeLeftOut(report.sources) ? "Those below were left out." : "They may have called them outside the image."}`}
    </EmptyState>
  );
}

function Measures({ report }: { report: AgreementReport }) {
  return (
    <SimpleGrid cols={{ base: 2, md: 4 }}>
      <Fact label="Standard deviation along an axis">{formatMeasure(report.overall.std_px, "px", 2)}</Fact>
      <Fact label="As a distance">{formatMeasure(report.radial_px, "px", 2)}</Fact>
      <Fact label="Object keypoint similarity">{formatNumber(report.oks, 3)}</Fact>
      <Fact label="Four annotators of [T16]">{report.t16_std_px} px</Fact>
    </SimpleGrid>
  );
}

function Tables({ report }: { report: AgreementReport }) {
  const scale = Math.max(0.01, ...[...report.joints, ...report.annotators].map((one) => one.spread.std_px ?? 0));
  return (
    <div className={classes.columns} style={{ marginTop: 24 }}>
      <Box title="Annotators" note={report.are_separable ? "The noise of each one, and where they mark against the mean of the others." : "Two annotators cannot be separated: each is given the noise that they share."}>
        <Bars label="Annotator" last="Bias x, y, px" scale={scale} rows={report.annotators.map((one) => [one.name, one.spread, `${signed(one.bias_x_px)}, ${signed(one.bias_y_px)}`])} />
      </Box>
      <Box title="States" note="Joints that everybody calls visible, or occluded, and those about which they differ.">
        <Bars label="State" last="" scale={scale} rows={Object.entries(report.states).map(([name, spread]) => [name, spread, ""])} />
      </Box>
      <Box title="Joints">
        <Bars label="Joint" last="State differs" scale={scale} rows={report.joints.map((one) => [one.joint.replace("_", " "), one.spread, share(one.state_disagreement)])} />
      </Box>
      <div>
        <Pairs report={report} />
        <Worst report={report} />
      </div>
    </div>
  );
}

function Box({ title, note, children }: { title: string; note?: string; children: ReactNode }) {
  return (
    <section className={`card ${classes.box}`} aria-label={title} style={{ marginBottom: 16 }}>
      <Title order={2}>{title}</Title>
      {note && (
        <Text size="xs" className="quiet" mb="sm">
          {note}
        </Text>
      )}
      {children}
    </section>
  );
}

function Bars({ label, last, rows, scale }: { label: string; last: string; rows: readonly (readonly [string, Spread, string])[]; scale: number }) {
  return (
    <table className={classes.bars}>
      <thead>
        <tr>
          <th scope="col">{label}</th>
          <td className={classes.barCell} />
          <th scope="col">Std, px</th>
          <th scope="col">Joints</th>
          {last ? <th scope="col">{last}</th> : <td />}
        </tr>
      </thead>
      <tbody>
        {rows.map(([name, spread, more]) => (
          <tr key={name}>
            <th scope="row">{name}</th>
            <td className={classes.barCell}>
              {spread.std_px !== null && <div className={classes.bar} style={{ width: `${(100 * spread.std_px) / scale}%` }} aria-hidden />}
            </td>
            <td>{px(spread.std_px)}</td>
            <td>{spread.samples}</td>
            <td>{more}</td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}

function Pairs({ report }: { report: AgreementReport }) {
  if (report.pairs.length === 0) return null;
  return (
    <Box title="Pairs">
      <table className={classes.bars}>
        <thead>
          <tr>
            <th scope="col">Two annotators</th>
            <td />
            <th scope="col">Mean distance, px</th>
            <th scope="col">OKS</th>
            <th scope="col">State differs</th>
          </tr>
        </thead>
        <tbody>
          {report.pairs.map((pair) => (
            <tr key={`${pair.first}/${pair.second}`}>
              <th scope="row">
                {pair.first}, {pair.second}
              </th>
              <td />
              <td>{px(pair.mean_px)}</td>
              <td>{formatNumber(pair.oks, 3)}</td>
              <td>{share(pair.state_disagreement)}</td>
            </tr>
          ))}
        </tbody>
      </table>
    </Box>
  );
}

/** One link for each annotator: their version in the annotator at this place. */
function Worst({ report }: { report: AgreementReport }) {
  if (report.worst.length === 0) return null;
  return (
    <Box title="Where they differ most" note="Open a frame as each of them marked it.">
      <table className={classes.bars}>
        <thead>
          <tr>
            <th scope="col">Frame</th>
            <td />
            <th scope="col">Std, px</th>
            <th scope="col">Versions</th>
          </tr>
        </thead>
        <tbody>
          {report.worst.slice(0, 15).map((place) => (
            <tr key={`${place.frame}/${place.camera}/${place.hand}`}>
              <th scope="row">
                {place.frame}, {place.camera}, {place.hand}
              </th>
              <td />
              <td>{px(place.spread.std_px)}</td>
              <td>
                {report.annotators.map((one) => {
                  const address = new URLSearchParams({ frame: String(place.frame), camera: place.camera, hand: place.hand, replica: one.assignment_id });
                  return (
                    <Link key={one.assignment_id} to={`/recordings/${report.sequence_id}/annotate?${address}`} style={{ marginLeft: 12, color: "var(--accent-text)" }}>
                      {one.name}
                    </Link>
                  );
                })}
              </td>
            </tr>
          ))}
        </tbody>
      </table>
    </Box>
  );
}
