import { Button, CloseButton, Group, SimpleGrid, Skeleton, TextInput, Title } from "@mantine/core";
import { IconCamera, IconHandFinger, IconSearch } from "@tabler/icons-react";
import { Link, useSearchParams } from "react-router";
import { useRecordings } from "../../api/recordings";
import { formatCount } from "../../model/format";
import { EmptyState } from "../parts/EmptyState";
import { Failure } from "../parts/Failure";
import { ImportButton } from "../parts/ImportButton";
import { RecordingCard } from "./RecordingCard";
import { useTitle } from "../parts/useTitle";

const COLUMNS = { base: 2, sm: 3, lg: 4, xl: 5 };

export function RecordingsPage() {
  useTitle("Recordings");
  const { data, error, refetch } = useRecordings();
  const [address, setAddress] = useSearchParams();
  const search = address.get("search") ?? "";
  const setSearch = (text: string): void => setAddress(text ? { search: text } : {}, { replace: true });
  const found = data?.filter((recording) => recording.name.toLowerCase().includes(search.trim().toLowerCase()));

  if (error && !data) {
    return <Failure what="The recordings could not be loaded" error={error} safe="They are untouched on the server's disk." onRetry={() => void refetch()} />;
  }
  if (data?.length === 0) {
    return (
      <div className="page">
        <Title order={1}>Recordings</Title>
        <EmptyState icon={<IconHandFinger size={56} stroke={1.25} />} title="No recordings yet" action={<ImportButton label="Import the first recording" />}>
          Drop a folder, files or a .zip anywhere on this page: a recording folder, depth and colour images of an RGB-D camera, or several
          videos with their calibration. You see a report of what was found before anything is stored. Cameras without a calibration:{" "}
          <Link to="/calibrations" style={{ color: "var(--accent-text)" }}>
            calibrate them from a filmed board
          </Link>
          .
        </EmptyState>
      </div>
    );
  }
  return (
    <div className="page">
      <Group mb="lg" justify="space-between">
        <Group align="baseline" gap="md">
          <Title order={1}>Recordings</Title>
          {data && <span className="quiet">{formatCount(data.length, "recording")}</span>}
        </Group>
        <Group gap="sm">
          <TextInput
            value={search}
            onChange={(event) => setSearch(event.currentTarget.value)}
            placeholder="Filter by name"
            aria-label="Filter recordings by name"
            leftSection={<IconSearch size={16} aria-hidden />}
            rightSection={search && <CloseButton size="sm" aria-label="Clear the filter" onClick={() => setSearch("")} />}
            w={240}
          />
          <Button variant="default" component={Link} to="/calibrations" leftSection={<IconCamera size={16} aria-hidden />}>
            Cameras
          </Button>
          <ImportButton label="Import" />
        </Group>
      </Group>
      {found?.length === 0 ? (
        <EmptyState icon={<IconSearch size={48} stroke={1.25} />} title={`Nothing is called “${search}”`}>
          {formatCount(data?.length ?? 0, "recording")} in all. Clear the filter to see them.
        </EmptyState>
      ) : (
        <SimpleGrid cols={COLUMNS} spacing="md">
          {found
            ? found.map((recording) => <RecordingCard key={recording.id} recording={recording} />)
            : Array.from({ length: 8 }, (_, index) => <Skeleton key={index} height={280} radius="lg" />)}
        </SimpleGrid>
      )}
    </div>
  );
}
