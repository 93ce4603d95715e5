import { Button, Checkbox, Group, Select, Skeleton, Stack, Table, Text, TextInput, Title, Tooltip } from "@mantine/core";
import { useDebouncedCallback, useDisclosure } from "@mantine/hooks";
import { IconChecks, IconFilterOff, IconScan, IconSearch, IconTrash } from "@tabler/icons-react";
import { useState } from "react";
import { Link } from "react-router";
import { useRestore } from "../../api/bin";
import { useDeleteScans, useScanCollections, useScanList, type Scan, scanThumbnailUrl } from "../../api/scans";
import { formatAgo, formatCount } from "../../model/format";
import { judgeSize } from "../../model/scanUnit";
import { VerdictBadge } from "../curate/Verdict";
import { EmptyState } from "../parts/EmptyState";
import { Failure } from "../parts/Failure";
import { For } from "../parts/For";
import { HandBadge } from "../parts/HandBadge";
import { Thumbnail } from "../parts/Thumbnail";
import { useTitle } from "../parts/useTitle";
import { intoBin } from "../parts/undo";
import { AddScansButton, ScanDrops } from "./AddScans";
import { ScanKinds } from "./ScanKinds";
import { RegisterDialog } from "./RegisterDialog";
import classes from "./ScansPage.module.css";
import { UnitsDialog } from "./UnitsDialog";
import { UploadDialog } from "./UploadDialog";
import { useScanAddress } from "./useScanAddress";

const ANY = "";

function State({ scan }: { scan: Scan }) {
  if (scan.state === "failed") {
    return (
      <Tooltip label={scan.problem ?? "It could not be registered."} multiline maw={360}>
        <Text size="sm" c="var(--bad-text)" className={classes.cell} tabIndex={0}>
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

/** Scans of hands: added by drag and drop, looked for, registered. */
export default function ScansPage() {
  useTitle("Scans");
  const [filters, setFilters] = useScanAddress();
  const { data, error, refetch, fetchNextPage, hasNextPage, isFetchingNextPage } = useScanList(filters);
  const known = useScanCollections().data;
  const collections = known ?? [];
  const [search, setSearch] = useState(filters.search ?? "");
  const seek = useDebouncedCallback((text: string) => setFilters({ search: text.trim() || undefined }), 250);
  const [chosen, setChosen] = useState<ReadonlySet<string>>(new Set());
  const [isRegistering, registering] = useDisclosure(false);
  const [isChangingUnits, units] = useDisclosure(false);
  const remove = useDeleteScans();
  const restore = useRestore();
  const scans = data?.pages.flatMap((page) => page.items) ?? [];
  const selected = scans.filter((scan) => chosen.has(scan.id));
  const isNarrowed = Object.values(filters).some(Boolean);
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

  if (error && !data) return <Failure what="The scans could not be loaded" error={error} safe="They are untouched on the server's disk." onRetry={() => void refetch()} />;
  if (data && scans.length === 0 && !isNarrowed) {
    return (
      <>
        <ScanDrops />
        <UploadDialog />
        <div className="page">
          <Group gap="md">
            <Title order={1}>Scans</Title>
            <ScanKinds here="/scans" />
          </Group>
        </div>
        <EmptyState icon={<IconScan size={56} stroke={1.25} />} title="No scans yet" action={<AddScansButton label="Add the first scans" />}>
          Drop PLY, OBJ or STL files, a folder of them or a .zip anywhere on this page. Then register them: a hand model is fitted to each, you accept or reject, and what you accept trains a better model.
        </EmptyState>
      </>
    );
  }
  return (
    <div className="page">
      <ScanDrops />
      <UploadDialog />
      <Group mb="md" justify="space-between" wrap="nowrap">
        <Group gap="md" wrap="nowrap">
          <Title order={1}>Scans</Title>
          <ScanKinds here="/scans" />
          {data && known && <span className="quiet">{formatCount(total, "scan")}</span>}
        </Group>
        <Group gap="sm" wrap="nowrap">
          <Button variant="default" component={Link} to={filters.collection ? `/curate?collection=${encodeURIComponent(filters.collection)}` : "/curate"} leftSection={<IconChecks size={16} aria-hidden />}>
            Curate
          </Button>
          <For role="reviewer">
            <Button variant="default" onClick={registering.open}>
              Register …
            </Button>
          </For>
          <AddScansButton label="Add" />
        </Group>
      </Group>
      <div className={classes.filters}>
        <TextInput
          value={search}
          onChange={(event) => {
            setSearch(event.currentTarget.value);
            seek(event.currentTarget.value);
          }}
          placeholder="Filter by name"
          aria-label="Filter scans by name"
          leftSection={<IconSearch size={16} aria-hidden />}
          w={240}
        />
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
      </div>
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
      {!data && (
        <Stack gap="sm" role="status" aria-label="Loading">
          {Array.from({ length: 10 }, (_, index) => (
            <Skeleton key={index} height={40} />
          ))}
        </Stack>
      )}
      {data && scans.length === 0 && (
        <EmptyState
          icon={<IconFilterOff size={40} stroke={1.25} />}
          title="No scan matches"
          action={
            <Button variant="default" onClick={() => (setSearch(""), setFilters({ collection: undefined, subject: undefined, side: undefined, state: undefined, search: undefined }))}>
              Show all
            </Button>
          }
        >
          Change the filters above.
        </EmptyState>
      )}
      {scans.length > 0 && (
        <div className={`card ${classes.frame}`}>
          <Table highlightOnHover verticalSpacing="xs" horizontalSpacing="md">
            <Table.Thead>
              <Table.Tr>
                <Table.Th w={48}>
                  <Checkbox
                    aria-label="Choose all that are shown"
                    checked={selected.length > 0 && selected.length === scans.length}
                    indeterminate={selected.length > 0 && selected.length < scans.length}
                    onChange={(event) => choose(scans.map((scan) => scan.id), event.currentTarget.checked)}
                  />
                </Table.Th>
                <Table.Th>Name</Table.Th>
                <Table.Th w={128}>Subject</Table.Th>
                <Table.Th w={144}>Pose</Table.Th>
                <Table.Th w={88}>Hand</Table.Th>
                <Table.Th w={96} ta="right">
                  Length
                </Table.Th>
                <Table.Th w={88} ta="right">
                  Points
                </Table.Th>
                <Table.Th w={88} ta="right">
                  Left out
                </Table.Th>
                <Table.Th w={200}>Registration</Table.Th>
                <Table.Th w={128} ta="right">
                  Added
                </Table.Th>
              </Table.Tr>
            </Table.Thead>
            <Table.Tbody>
              {scans.map((scan) => (
                <Table.Tr key={scan.id}>
                  <Table.Td>
                    <Checkbox aria-label={`Choose ${scan.name}`} checked={chosen.has(scan.id)} onChange={(event) => choose([scan.id], event.currentTarget.checked)} />
                  </Table.Td>
                  <Table.Td className={classes.cell} title={scan.name}>
                    <Link to={`/scans/${scan.id}`} className={`${classes.link} ${classes.named}`}>
                      <Thumbnail className={classes.picture} src={scanThumbnailUrl(scan)} alt="" width={32} height={32} />
                      <span className="one-line">{scan.name}</span>
                    </Link>
                  </Table.Td>
                  <Table.Td className={classes.cell} title={scan.subject}>
                    {scan.subject || <span className="quiet">–</span>}
                  </Table.Td>
                  <Table.Td className={classes.cell} title={scan.pose}>
                    {scan.pose || <span className="quiet">–</span>}
                  </Table.Td>
                  <Table.Td>{scan.side ? <HandBadge hand={scan.side} /> : <span className="quiet">–</span>}</Table.Td>
                  <Table.Td ta="right">
                    <Length scan={scan} />
                  </Table.Td>
                  <Table.Td ta="right">{scan.point_count.toLocaleString("en")}</Table.Td>
                  <Table.Td ta="right">{scan.removed_count > 0 ? `${((100 * scan.removed_count) / scan.point_count).toFixed(1)} %` : <span className="quiet">–</span>}</Table.Td>
                  <Table.Td>
                    <State scan={scan} />
                  </Table.Td>
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
      {isChangingUnits && selected.length > 0 && <UnitsDialog scans={selected} onClose={units.close} />}
      <RegisterDialog isOpen={isRegistering} onClose={registering.close} scanIds={selected.map((scan) => scan.id)} collection={filters.collection} />
    </div>
  );
}
