import { Button, Group, Menu, Skeleton, Stack, Text, Title } from "@mantine/core";
import { Dialog } from "../parts/Dialog";
import { useDisclosure } from "@mantine/hooks";
import { IconDownload, IconListCheck } from "@tabler/icons-react";
import { useSearchParams } from "react-router";
import { isChosen, readChoice, REPORTS, reportUrl, useComparison, writeChoice, type Comparison, type EvaluationChoice, type JudgedTrack } from "../../api/evaluations";
import { formatCount } from "../../model/format";
import { EmptyState } from "../parts/EmptyState";
import { Failure } from "../parts/Failure";
import { LeftOut } from "../parts/LeftOut";
import { useTitle } from "../parts/useTitle";
import { ErrorCurves } from "./ErrorCurves";
import { Filters } from "./Filters";
import { JointTable, PixelLegend } from "./JointTable";
import { MethodTable } from "./MethodTable";
import { Lineage, ParameterTable } from "./Provenance";
import { SummaryTable } from "./SummaryTable";
import { TrackChooser } from "./TrackChooser";
import { WorstFrames } from "./WorstFrames";

/** Tracks of one recording are judged by the same labels; the one that holds most of them speaks for all. */
function recordingsOf({ tracks }: Comparison): [string, string, JudgedTrack["sources"]][] {
  const ordered = [...tracks].sort((a, b) => b.left_out_joints - a.left_out_joints);
  const first = (track: JudgedTrack): boolean => ordered.find((other) => other.recording_key === track.recording_key) === track;
  return ordered.filter(first).map((track) => [track.recording_key, track.recording, track.sources]);
}

function Tables({ comparison, choice, onChange }: { comparison: Comparison; choice: EvaluationChoice; onChange: (part: Partial<EvaluationChoice>) => void }) {
  const recordings = new Set(comparison.tracks.map((track) => track.recording_key)).size;
  const hasErrors = comparison.tracks.some((track) => track.error.count > 0);
  return (
    <Stack gap="xl">
      <section aria-label="Error">
        <SummaryTable comparison={comparison} reference={choice.reference} onReference={(reference) => onChange({ reference })} />
        <Text size="sm" className="quiet" mt="sm">
          Distance in the image between marked and tracked joints, px. Lost frames count like any other.
          {comparison.tracks.length > 1 && " Differences are over the joints and frames that both tracks have; below zero is better."}
        </Text>
        {recordingsOf(comparison).map(([recording, name, sources]) => (
          <LeftOut key={recording} {...(recordings > 1 ? { name } : {})} sources={sources} onSources={(chosen) => onChange({ sources: chosen })} />
        ))}
      </section>
      {recordings > 1 && (
        <section aria-label="Recordings">
          <Title order={2} mb="sm">
            Recordings
          </Title>
          <MethodTable comparison={comparison} />
        </section>
      )}
      {hasErrors && (
        <>
          <section aria-label="Curves">
            <Title order={2} mb="sm">
              Curves
            </Title>
            <ErrorCurves comparison={comparison} camera={choice.camera} onWithin={(within) => onChange({ within })} />
          </section>
          <WorstFrames comparison={comparison} />
          <section aria-label="Joints">
            <Group justify="space-between" mb="sm">
              <Title order={2}>Joints</Title>
              <PixelLegend />
            </Group>
            <JointTable comparison={comparison} />
          </section>
        </>
      )}
      <ParameterTable comparison={comparison} />
      <Lineage comparison={comparison} />
    </Stack>
  );
}

/** `?tracks=&recordings=&project=&reference=…` says what is compared; the page keeps it up to date. */
export default function EvaluationsPage() {
  useTitle("Evaluations");
  const [address, setAddress] = useSearchParams();
  const choice = readChoice(address);
  const { data, error, refetch, isPlaceholderData } = useComparison(choice);
  const [isChoosing, chooser] = useDisclosure(false);
  const change = (part: Partial<EvaluationChoice>): void => setAddress(writeChoice({ ...choice, ...part }), { replace: !("tracks" in part) });
  const choose = (tracks: string[]): void => {
    chooser.close();
    const reference = choice.reference && tracks.includes(choice.reference) ? choice.reference : null;
    change({ tracks, recordings: [], project: null, reference });
  };
  const chooseProject = (project: string): void => {
    chooser.close();
    change({ tracks: [], recordings: [], project, reference: null });
  };

  if (!isChosen(choice)) {
    return (
      <div className="page">
        <Title order={1}>Evaluations</Title>
        <Text className="quiet" mb="lg">
          How far tracks are from the joints that people marked, one track or several side by side.
        </Text>
        <TrackChooser initial={[]} onChoose={choose} onProject={chooseProject} />
      </div>
    );
  }
  return (
    <div className="page">
      <Group justify="space-between" wrap="nowrap" mb="sm">
        <div style={{ minWidth: 0 }}>
          <Title order={1}>Evaluation</Title>
          <Text size="sm" className="quiet one-line" mih={20}>
            {data && `${formatCount(data.tracks.length, "track")} of ${formatCount(new Set(data.tracks.map((track) => track.recording_key)).size, "recording")}`}
          </Text>
        </div>
        <Group gap="sm" wrap="nowrap">
          <Button variant="default" leftSection={<IconListCheck size={16} aria-hidden />} onClick={chooser.open}>
            Choose tracks
          </Button>
          <Menu position="bottom-end">
            <Menu.Target>
              <Button leftSection={<IconDownload size={16} aria-hidden />} disabled={!data || data.tracks.length === 0}>
                Report
              </Button>
            </Menu.Target>
            <Menu.Dropdown>
              {REPORTS.map(({ kind, label, help }) => (
                <Menu.Item key={kind} component="a" href={reportUrl(kind, choice)} download>
                  {label}
                  <Text size="xs" className="quiet">
                    {help}
                  </Text>
                </Menu.Item>
              ))}
            </Menu.Dropdown>
          </Menu>
        </Group>
      </Group>
      <Filters choice={choice} comparison={data} onChange={change} />
      {error ? (
        <Failure what="These tracks could not be evaluated" error={error} safe="Tracks and annotations are as they were." onRetry={() => void refetch()}>
          <Button variant="default" onClick={chooser.open}>
            Choose tracks
          </Button>
        </Failure>
      ) : !data ? (
        <Stack gap="lg" role="status" aria-label="Loading">
          <Skeleton height={144} />
          <Skeleton height={296} />
          <Skeleton height={240} />
        </Stack>
      ) : data.tracks.length === 0 ? (
        <EmptyState icon={<IconListCheck size={48} stroke={1.25} />} title="No tracks here yet" action={<Button onClick={chooser.open}>Choose tracks</Button>}>
          None of these recordings has been tracked. Track one of them, or choose other tracks.
        </EmptyState>
      ) : (
        <div aria-busy={isPlaceholderData} style={isPlaceholderData ? { opacity: 0.6 } : undefined}>
          <Tables comparison={data} choice={choice} onChange={change} />
        </div>
      )}
      <Dialog title="Tracks to compare" size={780} isOpen={isChoosing} onClose={chooser.close}>
        <TrackChooser initial={data?.tracks.map((track) => track.key) ?? choice.tracks} onChoose={choose} onProject={chooseProject} />
      </Dialog>
    </div>
  );
}
