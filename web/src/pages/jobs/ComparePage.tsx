import { Button, Group, Table, Text, Title } from "@mantine/core";
import { IconArrowsDiff } from "@tabler/icons-react";
import { Link, useSearchParams } from "react-router";
import { useJob, useJobForm } from "../../api/jobs";
import { errorOf, useEvaluation, useTrack } from "../../api/tracks";
import type { Evaluation, Job, Track } from "../../api/types";
import { compareParams } from "../../model/compareJobs";
import { formatAgo, formatCount, formatDuration, formatNumber } from "../../model/format";
import { EmptyState } from "../parts/EmptyState";
import { Failure } from "../parts/Failure";
import { JobBadge } from "../parts/JobRow";
import { PageSkeleton } from "../parts/PageSkeleton";
import { useTitle } from "../parts/useTitle";
import classes from "./ComparePage.module.css";

interface Result {
  label: string;
  of: (job: Job, track: Track | undefined, evaluation: Evaluation | null | undefined) => number | null;
  digits: number;
  unit: string;
}

const RESULTS: Result[] = [
  { label: "Frames", of: (job) => job.frames_done, digits: 0, unit: "" },
  { label: "Lost frames", of: (_, track) => track?.summary.lost ?? null, digits: 0, unit: "" },
  { label: "Error against annotations", of: (_, __, evaluation) => errorOf(evaluation), digits: 2, unit: "px" },
  { label: "Depth residual", of: (_, track) => track?.summary.depth_residual_mm ?? null, digits: 2, unit: "mm" },
  { label: "Silhouette IoU", of: (_, track) => track?.summary.silhouette_iou ?? null, digits: 3, unit: "" },
  { label: "Median of a frame", of: (_, track) => track?.summary.median_ms ?? null, digits: 1, unit: "ms" },
];

const tookOf = (job: Job): number | null => (job.started_at && job.ended_at ? (Date.parse(job.ended_at) - Date.parse(job.started_at)) / 1000 : null);

function RunHead({ job, letter }: { job: Job; letter: string }) {
  return (
    <Table.Th className={classes.run}>
      <Group gap="sm" wrap="nowrap">
        <span className={classes.letter}>{letter}</span>
        <div style={{ minWidth: 0 }}>
          <Link to={`/jobs/${job.id}`} className={`${classes.link} one-line`}>
            {job.title}
          </Link>
          <Text size="xs" className="quiet" fw={400}>
            {formatAgo(job.created_at)}
            {job.created_by_name ? ` by ${job.created_by_name}` : ""}
          </Text>
        </div>
        <JobBadge state={job.state} />
      </Group>
    </Table.Th>
  );
}

function Comparison({ first, second }: { first: Job; second: Job }) {
  const form = useJobForm(true).data;
  const tracks = [useTrack(first.track_id ?? "").data, useTrack(second.track_id ?? "").data] as const;
  const evaluations = [useEvaluation(first.track_id ?? "").data, useEvaluation(second.track_id ?? "").data] as const;
  const rows = compareParams(first, second, form);
  const different = rows.filter((row) => row.isDifferent).length;
  const took = [tookOf(first), tookOf(second)].map((seconds) => (seconds === null ? "–" : formatDuration(seconds)));
  const head = (title: string) => (
    <Table.Thead>
      <Table.Tr>
        <Table.Th w="30%">{title}</Table.Th>
        <RunHead job={first} letter="A" />
        <RunHead job={second} letter="B" />
        <Table.Th w={120} ta="right">
          B − A
        </Table.Th>
      </Table.Tr>
    </Table.Thead>
  );
  return (
    <>
      <section aria-label="Results" className={`card ${classes.frame}`}>
        <Table verticalSpacing={8} horizontalSpacing="md" layout="fixed">
          {head("Results")}
          <Table.Tbody>
            {RESULTS.map(({ label, of, digits, unit }) => {
              const [a, b] = [of(first, tracks[0], evaluations[0]), of(second, tracks[1], evaluations[1])];
              const show = (value: number | null): string => `${formatNumber(value, digits)}${value === null || !unit ? "" : ` ${unit}`}`;
              const difference = a === null || b === null ? null : b - a;
              return (
                <Table.Tr key={label}>
                  <Table.Th scope="row" fw={400}>
                    {label}
                  </Table.Th>
                  <Table.Td>{show(a)}</Table.Td>
                  <Table.Td>{show(b)}</Table.Td>
                  <Table.Td ta="right">{difference === null ? "–" : `${difference > 0 ? "+" : ""}${formatNumber(difference, digits)}`}</Table.Td>
                </Table.Tr>
              );
            })}
            <Table.Tr>
              <Table.Th scope="row" fw={400}>
                Took
              </Table.Th>
              <Table.Td>{took[0]}</Table.Td>
              <Table.Td>{took[1]}</Table.Td>
              <Table.Td />
            </Table.Tr>
          </Table.Tbody>
        </Table>
      </section>
      <section aria-label="Parameters" className={`card ${classes.frame}`}>
        <Table verticalSpacing={8} horizontalSpacing="md" layout="fixed">
          {head(different === 0 ? "Parameters: all alike" : `Parameters: ${formatCount(different, "differs", "differ")}`)}
          <Table.Tbody>
            {rows.map((row) => (
              <Table.Tr key={row.name} className={row.isDifferent ? classes.different : undefined} data-different={row.isDifferent}>
                <Table.Th scope="row" fw={row.isDifferent ? 600 : 400}>
                  {row.label}
                </Table.Th>
                <Table.Td>{row.first}</Table.Td>
                <Table.Td>{row.second}</Table.Td>
                <Table.Td ta="right">{row.isDifferent && <span className={classes.mark}>≠ differs</span>}</Table.Td>
              </Table.Tr>
            ))}
          </Table.Tbody>
        </Table>
      </section>
    </>
  );
}

/** Two runs side by side; the address holds the pair. */
export default function ComparePage() {
  useTitle("Compare two runs");
  const [address, setAddress] = useSearchParams();
  const [a, b] = [address.get("a") ?? "", address.get("b") ?? ""];
  const first = useJob(a);
  const second = useJob(b);
  const failed = first.error ?? second.error;
  if (!a || !b) {
    return (
      <EmptyState
        icon={<IconArrowsDiff size={48} stroke={1.25} />}
        title="Two runs are needed"
        action={
          <Button component={Link} to="/jobs">
            To the jobs
          </Button>
        }
      >
        Tick two jobs in the list and choose “Compare”.
      </EmptyState>
    );
  }
  if (failed && !(first.data && second.data)) return <Failure what="The two runs could not be loaded" error={failed} safe="Nothing of them was changed." />;
  if (!first.data || !second.data) return <PageSkeleton />;
  return (
    <div className="page">
      <Group mb="lg" justify="space-between">
        <Title order={1}>Compare two runs</Title>
        <Button variant="default" onClick={() => setAddress({ a: b, b: a }, { replace: true })}>
          Swap
        </Button>
      </Group>
      <Comparison first={first.data} second={second.data} />
    </div>
  );
}
