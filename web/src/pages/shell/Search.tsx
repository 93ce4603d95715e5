import { Spotlight, spotlight, type SpotlightActionData } from "@mantine/spotlight";
import { IconBriefcase, IconChartBar, IconChecks, IconHandFinger, IconHandStop, IconPencil, IconRoute, IconRun, IconScan, IconSearch, IconVideo } from "@tabler/icons-react";
import { useNavigate } from "react-router";
import { useRecordings } from "../../api/recordings";
import { useTracks } from "../../api/tracks";
import { formatCount } from "../../model/format";

export const openSearch = (): void => spotlight.open();

/** Ctrl+K: to any recording, its annotator, its tracks, or a page. */
export function Search() {
  const navigate = useNavigate();
  const recordings = useRecordings().data ?? [];
  const tracks = useTracks().data ?? [];
  const go = (to: string) => () => void navigate(to);
  const nameOf = (id: string): string => recordings.find((recording) => recording.id === id)?.name ?? "";

  const actions: SpotlightActionData[] = [
    ...recordings.flatMap((recording) => [
      {
        id: recording.id,
        label: recording.name,
        description: `Recording, ${formatCount(recording.frame_count, "frame")}`,
        leftSection: <IconVideo size={18} aria-hidden />,
        onClick: go(`/recordings/${recording.id}`),
      },
      {
        id: `${recording.id}/annotate`,
        label: `Annotate ${recording.name}`,
        leftSection: <IconPencil size={18} aria-hidden />,
        onClick: go(`/recordings/${recording.id}/annotate`),
      },
    ]),
    ...tracks.map((track) => ({
      id: track.id,
      label: track.name,
      description: `Track of ${nameOf(track.sequence_id)}`,
      leftSection: <IconRoute size={18} aria-hidden />,
      onClick: go(`/tracks/${track.id}`),
    })),
    { id: "page/recordings", label: "Recordings", leftSection: <IconHandFinger size={18} aria-hidden />, onClick: go("/recordings") },
    { id: "page/tracks", label: "Tracks", leftSection: <IconRoute size={18} aria-hidden />, onClick: go("/tracks") },
    { id: "page/scans", label: "Scans", leftSection: <IconScan size={18} aria-hidden />, onClick: go("/scans") },
    { id: "page/moving", label: "Moving scans", leftSection: <IconRun size={18} aria-hidden />, onClick: go("/scans/moving") },
    { id: "page/curate", label: "Curate registrations", leftSection: <IconChecks size={18} aria-hidden />, onClick: go("/curate") },
    { id: "page/models", label: "Hand models", leftSection: <IconHandStop size={18} aria-hidden />, onClick: go("/models") },
    { id: "page/evaluations", label: "Evaluations", leftSection: <IconChartBar size={18} aria-hidden />, onClick: go("/evaluations") },
    { id: "page/jobs", label: "Jobs", leftSection: <IconBriefcase size={18} aria-hidden />, onClick: go("/jobs") },
  ];

  return (
    <Spotlight
      attributes={{ content: { "aria-label": "Search" } }}
      actions={actions}
      shortcut={null}
      limit={8}
      nothingFound="No recording or page of that name"
      searchProps={{ leftSection: <IconSearch size={18} aria-hidden />, placeholder: "Search recordings, tracks and pages", "aria-label": "Search" }}
    />
  );
}
