import { Text, Tooltip } from "@mantine/core";
import { IconRun } from "@tabler/icons-react";
import { useSearchParams } from "react-router";
import { movingThumbnailUrl, useMovingScans, type MovingScan } from "../../api/movingScans";
import { formatCount } from "../../model/format";
import type { Column } from "../parts/CardTable";
import { EmptyState } from "../parts/EmptyState";
import { useTitle } from "../parts/useTitle";
import { ADDED, nameColumn, pointsColumn, ScanList, subjectColumn } from "../scans/ScanList";
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

const COLUMNS: readonly Column<MovingScan>[] = [
  nameColumn<MovingScan>("/scans/moving", ({ id }) => movingThumbnailUrl(id)),
  subjectColumn(144),
  { head: "Frames", width: 112, isNumber: true, show: (scan) => <Frames scan={scan} /> },
  { head: "Per second", width: 112, isNumber: true, show: ({ fps }) => fps.toLocaleString("en") },
  pointsColumn("Points, most", 128),
  { head: "Registrations", width: 128, isNumber: true, show: ({ registration_count: count }) => count },
  { head: "Accepted", width: 144, isNumber: true, show: ({ accepted_count: count }) => count > 0 && formatCount(count, "frame") },
  ADDED,
];

/** Scans of people who move: each a row, however many frames it has. */
export default function MovingScansPage() {
  useTitle("Moving scans");
  const [address, setAddress] = useSearchParams();
  const search = address.get("search") ?? undefined;
  const list = useMovingScans(search);
  const narrow = (text: string | undefined): void => setAddress(text ? { search: text } : {}, { replace: true });
  return (
    <>
      <MovingDrops />
      <MovingUploadDialog />
      <ScanList
        here="/scans/moving"
        noun="moving scan"
        list={list}
        columns={COLUMNS}
        search={search}
        searched="name or subject"
        onSearch={narrow}
        isNarrowed={search !== undefined}
        onShowAll={() => narrow(undefined)}
        acts={<AddMovingScanButton label="Add" />}
        firstUse={
          <EmptyState icon={<IconRun size={56} stroke={1.25} />} title="No moving scans yet" action={<AddMovingScanButton label="Add the first one" />}>
            Drop a folder of PLY, OBJ or STL files of one person here, one file a frame. Then register it: the body with both hands is laid onto every frame, you accept or reject by stretch, and take what you accepted to other programs.
          </EmptyState>
        }
      />
    </>
  );
}
