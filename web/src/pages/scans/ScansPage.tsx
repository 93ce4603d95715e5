import { Button, Checkbox, Group, Select, Text, Tooltip } from "@mantine/core";
import { useDisclosure } from "@mantine/hooks";
import { IconChecks, IconScan, IconTrash } from "@tabler/icons-react";
import { useState } from "react";
import { Link } from "react-router";
import { useRestore } from "../../api/bin";
import { useDeleteScans, useScanCollections, useScanList, type Scan, scanThumbnailUrl } from "../../api/scans";
import { formatCount } from "../../model/format";
import { judgeSize } from "../../model/scanUnit";
import { VerdictBadge } from "../curate/Verdict";
import type { Column } from "../parts/CardTable";
import { EmptyState } from "../parts/EmptyState";
import { For } from "../parts/For";
import { HandBadge } from "../parts/HandBadge";
import { useTitle } from "../parts/useTitle";
import { intoBin } from "../parts/undo";
import { AddScansButton, ScanDrops } from "./AddScans";
import { RegisterDialog } from "./RegisterDialog";
import { ADDED, nameColumn, pointsColumn, ScanList, subjectColumn } from "./ScanList";
import classes from "./ScanList.module.css";
import { UnitsDialog } from "./UnitsDialog";
import { UploadDialog } from "./UploadDialog";
import { useScanAddress } from "./useScanAddress";

const ANY = "";

function State({ scan }: { scan: Scan }) {
  if (scan.state === "failed") {
    return (
      <Tooltip label={scan.problem ?? "It could not be registered."} multiline maw={360}>
        <Text size="sm" c="var(--bad-text)" truncate tabIndex={0}>
          failed: {scan.problem ?? "no reason given"}
        </Text>
      </Tooltip>
    );
  }
  if (scan.registration) {
    return (
      <Group gap={8} wrap="nowrap">
        <VerdictBadge verdict={scan.registration.verdict} />
        <Text size="xs" className="quiet one-line">
          round {scan.registration.round}
        </Text>
      </Group>
    );
  }
  return (
    <Text size="sm" className="quiet">
      new
    </Text>
  );
}

/** Longest side of a scan; says when its unit is a guess or no hand has that size. */
function Length({ scan }: { scan: Scan }) {
  const length = scan.size_m[0] ?? 0;
  const { state, text } = judgeSize(length);
  const told = [text, scan.is_unit_guessed ? "The unit was not given; it was guessed from the size." : ""].filter(Boolean).join(" ");
  const shown = (
    <Text size="sm" span c={state === "bad" ? "var(--bad-text)" : state === "crop" ? "var(--warn-text)" : undefined} tabIndex={told ? 0 : undefined}>
      {(100 * length).toFixed(length < 1 ? 1 : 0)} cm{told ? " ?" : ""}
    </Text>
  );
  return told ? (
    <Tooltip label={told} multiline maw={320}>
      {shown}
    </Tooltip>
  ) : (
    shown
  );
}

const COLUMNS: readonly Column<Scan>[] = [
  nameColumn<Scan>("/scans", scanThumbnailUrl),
  subjectColumn(128),
  { head: "Pose", width: 144, full: ({ pose }) => pose, show: ({ pose }) => pose },
  { head: "Hand", width: 88, show: ({ side }) => side && <HandBadge hand={side} /> },
  { head: "Length", width: 96, isNumber: true, show: (scan) => <Length scan={scan} /> },
  pointsColumn("Points", 88),
  { head: "Left out", width: 88, isNumber: true, show: (scan) => scan.removed_count > 0 && `${((100 * scan.removed_count) / scan.point_count).toFixed(1)} %` },
  { head: "Registration", width: 200, show: (scan) => <State scan={scan} /> },
  ADDED,
];

/** Scans of hands: added by drag and drop, looked for, registered. */
export default function ScansPage() {
  useTitle("Scans");
  const [filters, setFilters] = useScanAddress();
  const list = useScanList(filters);
  const known = useScanCollections().data;
  const collections = known ?? [];
  const [chosen, setChosen] = useState<ReadonlySet<string>>(new Set());
  const [isRegistering, registering] = useDisclosure(false);
  const [isChangingUnits, units] = useDisclosure(false);
  const remove = useDeleteScans();
  const restore = useRestore();
  const scans = list.data?.pages.flatMap((page) => page.items) ?? [];
  const selected = scans.filter((scan) => chosen.has(scan.id));
  const total = collections.filter(({ name }) => !filters.collection || name === filters.collection).reduce((sum, one) => sum + one.scans, 0);
  const choose = (ids: readonly string[], isChosen: boolean): void => {
    const next = new Set(chosen);
    for (const id of ids) if (isChosen) next.add(id); else next.delete(id);
    setChosen(next);
  };
  const hide = (): void => {
    const ids = selected.map((scan) => scan.id);
    remove.mutate(
      ids,
      intoBin(formatCount(ids.length, "scan"), () => restore.mutateAsync({ kind: "scan", ids }), () => setChosen(new Set())),
    );
  };
  const choice: Column<Scan> = {
    head: (
      <Checkbox
        aria-label="Choose all that are shown"
        checked={selected.length > 0 && selected.length === scans.length}
        indeterminate={selected.length > 0 && selected.length < scans.length}
        onChange={(event) => choose(scans.map((scan) => scan.id), event.currentTarget.checked)}
      />
    ),
    width: 48,
    show: (scan) => <Checkbox aria-label={`Choose ${scan.name}`} checked={chosen.has(scan.id)} onChange={(event) => choose([scan.id], event.currentTarget.checked)} />,
  };

  return (
    <>
      <ScanDrops />
      <UploadDialog />
      <ScanList
        here="/scans"
        noun="scan"
        list={list}
        columns={[choice, ...COLUMNS]}
        search={filters.search}
        searched="name"
        onSearch={(search) => setFilters({ search })}
        isNarrowed={Object.values(filters).some(Boolean)}
        onShowAll={() => setFilters({ collection: undefined, subject: undefined, side: undefined, state: undefined, search: undefined })}
        count={known && <span className="quiet">{formatCount(total, "scan")}</span>}
        acts={
          <>
            <Button variant="default" component={Link} to={filters.collection ? `/curate?collection=${encodeURIComponent(filters.collection)}` : "/curate"} leftSection={<IconChecks size={16} aria-hidden />}>
              Curate
            </Button>
            <For role="reviewer">
              <Button variant="default" onClick={registering.open}>
                Register …
              </Button>
            </For>
            <AddScansButton label="Add" />
          </>
        }
        filters={
          <>
            <Select
              aria-label="Collection"
              w={240}
              searchable
              allowDeselect={false}
              value={filters.collection ?? ANY}
              data={[{ value: ANY, label: "Every collection" }, ...collections.map(({ name, scans: count }) => ({ value: name, label: `${name} (${count.toLocaleString("en")})` }))]}
              onChange={(value) => setFilters({ collection: value || undefined })}
            />
            <Select
              aria-label="State"
              w={152}
              allowDeselect={false}
              value={filters.state ?? ANY}
              data={[{ value: ANY, label: "Any state" }, { value: "new", label: "New" }, { value: "registered", label: "Registered" }, { value: "failed", label: "Failed" }]}
              onChange={(value) => setFilters({ state: (value || undefined) })}
            />
            <Select
              aria-label="Hand"
              w={136}
              allowDeselect={false}
              value={filters.side ?? ANY}
              data={[{ value: ANY, label: "Either hand" }, { value: "right", label: "Right" }, { value: "left", label: "Left" }]}
              onChange={(value) => setFilters({ side: (value || undefined) })}
            />
            {filters.subject && (
              <Button variant="light" size="xs" onClick={() => setFilters({ subject: undefined })}>
                Subject {filters.subject} ×
              </Button>
            )}
          </>
        }
        firstUse={
          <EmptyState icon={<IconScan size={56} stroke={1.25} />} title="No scans yet" action={<AddScansButton label="Add the first scans" />}>
            Drop PLY, OBJ or STL files, a folder of them or a .zip anywhere on this page. Then register them: a hand model is fitted to each, you accept or reject, and what you accept trains a better model.
          </EmptyState>
        }
      >
        {selected.length > 0 && (
          <div className={`card ${classes.chosen}`} role="group" aria-label="With the chosen scans">
            <Text size="sm" fw={600}>
              {formatCount(selected.length, "scan")} chosen
            </Text>
            <For role="reviewer">
              <Button size="xs" onClick={registering.open}>
                Register …
              </Button>
            </For>
            <For role="lead">
              <Button size="xs" variant="default" onClick={units.open}>
                Unit …
              </Button>
              <Button size="xs" variant="default" loading={remove.isPending} leftSection={<IconTrash size={14} aria-hidden />} onClick={hide}>
                Move to the bin
              </Button>
            </For>
            <Button size="xs" variant="subtle" onClick={() => setChosen(new Set())}>
              Choose none
            </Button>
          </div>
        )}
      </ScanList>
      {isChangingUnits && selected.length > 0 && <UnitsDialog scans={selected} onClose={units.close} />}
      <RegisterDialog isOpen={isRegistering} onClose={registering.close} scanIds={selected.map((scan) => scan.id)} collection={filters.collection} />
    </>
  );
}
