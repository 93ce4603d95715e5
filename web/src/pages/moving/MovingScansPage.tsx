import { Button, Group, Skeleton, Stack, Table, Text, TextInput, Title, Tooltip } from "@mantine/core";
import { useDebouncedCallback } from "@mantine/hooks";
import { IconFilterOff, IconRun, IconSearch } from "@tabler/icons-react";
import { useState } from "react";
import { Link, useSearchParams } from "react-router";
import { movingThumbnailUrl, useMovingScans, type MovingScan } from "../../api/movingScans";
import { formatAgo, formatCount } from "../../model/format";
import { EmptyState } from "../parts/EmptyState";
import { Failure } from "../parts/Failure";
import { Thumbnail } from "../parts/Thumbnail";
import { useTitle } from "../parts/useTitle";
import { ScanKinds } from "../scans/ScanKinds";
import lists from "../scans/ScansPage.module.css";
import { AddMovingScanButton, MovingDrops } from "./AddMovingScan";
import { MovingUploadDialog } from "./MovingUploadDialog";

function Frames({ scan }: { scan: MovingScan }) {
  const [first] = scan.problems;
  if (!first) return <>{scan.frame_count.toLocaleString("en")}</>;
  return (
    <Tooltip label={`${formatCount(scan.problems.length, "frame")} cannot be used, such as ${first.name}: ${first.detail}`} multiline maw={400}>
      <Text size="sm" span c="var(--warn-text)" tabIndex={0}>
        {scan.usable_count.toLocaleString("en")} of {scan.frame_count.toLocaleString("en")}
      </Text>
    </Tooltip>
  );
}

/** Scans of people who move: each a row, however many frames it has. */
export default function MovingScansPage() {
  useTitle("Moving scans");
  const [address, setAddress] = useSearchParams();
  const search = address.get("search") ?? undefined;
  const { data, error, refetch, fetchNextPage, hasNextPage, isFetchingNextPage } = useMovingScans(search);
  const [typed, setTyped] = useState(search ?? "");
  const seek = useDebouncedCallback((text: string) => setAddress(text.trim() ? { search: text.trim() } : {}, { replace: true }), 250);
  const scans = data?.pages.flatMap((page) => page.items) ?? [];
  if (error && !data) return <Failure what="The moving scans could not be loaded" error={error} safe="They are untouched on the server's disk." onRetry={() => void refetch()} />;
  const isEmpty = data !== undefined && scans.length === 0;
  /** Known to be more than the first-use state, so that nothing jumps. */
  const hasList = data !== undefined && !(isEmpty && !search);
  return (
    <div className="page">
      <MovingDrops />
      <MovingUploadDialog />
      <Group mb="md" justify="space-between" wrap="nowrap">
        <Group gap="md" wrap="nowrap">
          <Title order={1}>Scans</Title>
          <ScanKinds here="/scans/moving" />
        </Group>
        {hasList && <AddMovingScanButton label="Add" />}
      </Group>
      {hasList && (
        <div className={lists.filters}>
          <TextInput
            value={typed}
            onChange={(event) => {
              setTyped(event.currentTarget.value);
              seek(event.currentTarget.value);
            }}
            placeholder="Filter by name or subject"
            aria-label="Filter moving scans by name or subject"
            leftSection={<IconSearch size={16} aria-hidden />}
            w={240}
          />
        </div>
      )}
      {!data && (
        <Stack gap="sm" role="status" aria-label="Loading">
          {Array.from({ length: 6 }, (_, index) => (
            <Skeleton key={index} height={40} />
          ))}
        </Stack>
      )}
      {isEmpty && !search && (
        <EmptyState icon={<IconRun size={56} stroke={1.25} />} title="No moving scans yet" action={<AddMovingScanButton label="Add the first one" />}>
          Drop a folder of PLY, OBJ or STL files of one person here, one file a frame. Then register it: the body with both hands is laid onto every frame, you accept or reject by stretch, and take what you accepted to other programs.
        </EmptyState>
      )}
      {isEmpty && search && (
        <EmptyState
          icon={<IconFilterOff size={40} stroke={1.25} />}
          title="No moving scan matches"
          action={
            <Button variant="default" onClick={() => (setTyped(""), setAddress({}, { replace: true }))}>
              Show all
            </Button>
          }
        >
          Change the filter above.
        </EmptyState>
      )}
      {scans.length > 0 && (
        <div className={`card ${lists.frame}`}>
          <Table highlightOnHover verticalSpacing="xs" horizontalSpacing="md">
            <Table.Thead>
              <Table.Tr>
                <Table.Th>Name</Table.Th>
                <Table.Th w={144}>Subject</Table.Th>
                <Table.Th w={112} ta="right">
                  Frames
                </Table.Th>
                <Table.Th w={112} ta="right">
                  Per second
                </Table.Th>
                <Table.Th w={128} ta="right">
                  Points, most
                </Table.Th>
                <Table.Th w={128} ta="right">
                  Registrations
                </Table.Th>
                <Table.Th w={144} ta="right">
                  Accepted
                </Table.Th>
                <Table.Th w={144} ta="right">
                  Added
                </Table.Th>
              </Table.Tr>
            </Table.Thead>
            <Table.Tbody>
              {scans.map((scan) => (
                <Table.Tr key={scan.id}>
                  <Table.Td className={lists.cell} title={scan.name}>
                    <Link to={`/scans/moving/${scan.id}`} className={`${lists.link} ${lists.named}`}>
                      <Thumbnail className={lists.picture} src={movingThumbnailUrl(scan.id)} alt="" width={32} height={32} />
                      <span className="one-line">{scan.name}</span>
                    </Link>
                  </Table.Td>
                  <Table.Td className={lists.cell} title={scan.subject}>
                    {scan.subject || <span className="quiet">–</span>}
                  </Table.Td>
                  <Table.Td ta="right">
                    <Frames scan={scan} />
                  </Table.Td>
                  <Table.Td ta="right">{scan.fps.toLocaleString("en")}</Table.Td>
                  <Table.Td ta="right">{scan.point_count.toLocaleString("en")}</Table.Td>
                  <Table.Td ta="right">{scan.registration_count || <span className="quiet">–</span>}</Table.Td>
                  <Table.Td ta="right">{scan.accepted_count ? formatCount(scan.accepted_count, "frame") : <span className="quiet">–</span>}</Table.Td>
                  <Table.Td ta="right" className="quiet">
                    {formatAgo(scan.created_at)}
                  </Table.Td>
                </Table.Tr>
              ))}
            </Table.Tbody>
          </Table>
        </div>
      )}
      {hasNextPage && (
        <Group justify="center" mt="md">
          <Button variant="default" loading={isFetchingNextPage} onClick={() => void fetchNextPage()}>
            Show more
          </Button>
        </Group>
      )}
    </div>
  );
}
