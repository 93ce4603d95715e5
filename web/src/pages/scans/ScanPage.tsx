import { Badge, Button, Group, Kbd, Text, TextInput, Title } from "@mantine/core";
import { IconArrowBackUp, IconChevronLeft, IconChevronRight, IconDownload, IconFlipHorizontal, IconScissors } from "@tabler/icons-react";
import { useQuery, useQueryClient } from "@tanstack/react-query";
import { useDisclosure } from "@mantine/hooks";
import { useEffect, useRef, useState } from "react";
import { Link, useNavigate, useParams } from "react-router";
import { useKeymap } from "../../actions/useKeymap";
import { fetchPattern } from "../../api/handModels";
import { fetchRegistrationGeometry, useRegistration, useScanRegistrations, type Registration } from "../../api/registrations";
import { fetchScanGeometry, scanFileUrl, useChangeScan, useScan, useScanList, type Scan } from "../../api/scans";
import type { Staged } from "../../canvas/hand3d/staged";
import { useStage } from "../../canvas/hand3d/useStage";
import type { Point } from "../../model/crop";
import { formatAgo, formatBytes, formatMeasure } from "../../model/format";
import { formatSize } from "../../model/scanUnit";
import { useKeyOf } from "../../state/keys";
import { DecisionBadge, VerdictBadge } from "../curate/Verdict";
import { HandRail } from "../hand3d/HandRail";
import { HandView } from "../hand3d/HandView";
import { handHandlers, useLook } from "../hand3d/useLook";
import viewClasses from "../hand3d/HandView.module.css";
import { LineageList } from "../models/LineageList";
import { Awaited } from "../parts/Awaited";
import { Failure } from "../parts/Failure";
import { For } from "../parts/For";
import { HandBadge } from "../parts/HandBadge";
import { KeyIcon } from "../parts/KeyIcon";
import { PageSkeleton } from "../parts/PageSkeleton";
import { Tool } from "../parts/Tool";
import { useHasFingers } from "../parts/useScreen";
import { useTitle } from "../parts/useTitle";
import { CropPanel } from "./CropPanel";
import { RegisterDialog } from "./RegisterDialog";
import frame from "../hand3d/HandPage.module.css";
import classes from "./ScanPage.module.css";
import { StrokeLayer } from "./StrokeLayer";
import { UnitPanel } from "./UnitPanel";
import { useCrop } from "./useCrop";

const HINTS = [
  ["scan.cut", "knife"],
  ["scan.uncut", "take the stroke back"],
  ["scan.flip", "other side"],
  ["scan.save", "save"],
  ["scan.next", "next scan"],
] as const;

/** Points of a scan, with the newest registered mesh when there is one. */
function useGeometry(scan: Scan, registration: Registration | undefined) {
  const client = useQueryClient();
  return useQuery({
    queryKey: ["scans", "one", scan.id, "geometry", registration?.id ?? null, scan.metres_per_unit],
    queryFn: async ({ signal }) =>
      registration ? fetchRegistrationGeometry(registration, await fetchPattern(client, registration.model_id), signal) : fetchScanGeometry(scan, scan.side, signal),
    enabled: !scan.registration || registration !== undefined,
    staleTime: Infinity,
    gcTime: 60_000,
  });
}

function Details({ scan }: { scan: Scan }) {
  const change = useChangeScan();
  const [draft, setDraft] = useState({ name: scan.name, subject: scan.subject, pose: scan.pose, collection: scan.collection });
  const names = ["name", "subject", "pose", "collection"] as const;
  const isChanged = names.some((name) => draft[name].trim() !== scan[name]);
  return (
    <form
      aria-label="Details"
      onSubmit={(event) => {
        event.preventDefault();
        change.mutate({ id: scan.id, ...draft });
      }}
    >
      {names.map((name) => (
        <TextInput
          key={name}
          size="xs"
          mb={4}
          label={name.replace(/^./, (letter) => letter.toUpperCase())}
          value={draft[name]}
          maxLength={name === "name" || name === "collection" ? 200 : 100}
          onChange={(event) => setDraft({ ...draft, [name]: event.currentTarget.value })}
        />
      ))}
      {isChanged && (
        <Group gap="sm" mt="sm">
          <Button size="compact-xs" type="submit" loading={change.isPending}>
            Keep
          </Button>
          <Button size="compact-xs" variant="default" onClick={() => setDraft({ name: scan.name, subject: scan.subject, pose: scan.pose, collection: scan.collection })}>
            As it was
          </Button>
        </Group>
      )}
      {change.error && (
        <Text size="xs" mt={4} c="var(--bad-text)" role="alert">
          {change.error.message}
        </Text>
      )}
    </form>
  );
}

function Registrations({ scan }: { scan: Scan }) {
  const query = useScanRegistrations(scan.id);
  const registrations = query.data;
  if (!registrations) return query.error ? <Awaited what="The registrations" query={query} /> : null;
  return (
    <section aria-label="Registrations">
      <Title order={3} mb="sm">
        Registrations
      </Title>
      {registrations.length === 0 && (
        <Text size="xs" className="quiet">
          {scan.problem ?? "Not registered yet."}
        </Text>
      )}
      <ul className={classes.rows}>
        {registrations.map((one) => (
          <li key={one.id}>
            <Link to={`/curate?queue=all&registration=${one.id}`} className={classes.row} title={`By ${one.model_name}`}>
              <span>round {one.round}</span>
              {one.is_outdated ? <Badge color="gray" variant="light" size="sm" title="The unit of the scan was corrected since: it no longer counts">another size</Badge> : <VerdictBadge verdict={one.verdict} />}
              {one.decision && <DecisionBadge decision={one.decision} />}
              <span className="quiet" style={{ marginLeft: "auto" }}>
                {formatMeasure(one.scan_to_mesh_mm.mean, "mm", 2)}
              </span>
            </Link>
          </li>
        ))}
      </ul>
    </section>
  );
}

function OpenScan({ scan }: { scan: Scan }) {
  const registration = useRegistration(scan.registration?.id ?? null);
  const geometry = useGeometry(scan, registration.data);
  const [isCutting, setCutting] = useState(false);
  const [isRegistering, registering] = useDisclosure(false);
  const hasFingers = useHasFingers();
  const keyOf = useKeyOf();
  const navigate = useNavigate();
  const neighbours = useScanList({ collection: scan.collection });
  const list = neighbours.data?.pages.flatMap((page) => page.items) ?? [];
  const place = list.findIndex((one) => one.id === scan.id);
  const isNearEnd = place >= 0 && place > list.length - 5 && neighbours.hasNextPage && !neighbours.isFetchingNextPage;
  const { fetchNextPage } = neighbours;
  useEffect(() => {
    if (isNearEnd) void fetchNextPage();
  }, [isNearEnd, fetchNextPage]);

  const shown = useRef("");
  const parts = useStage(shown);
  const { stage } = parts;
  const control = useLook(stage);
  const crop = useCrop(scan, geometry.data ?? null);
  const staged = useRef<Staged | null>(null);

  useEffect(() => {
    if (!stage || !geometry.data) return;
    const hand = stage.prepare(geometry.data);
    staged.current = hand;
    shown.current = scan.id;
    stage.show(hand);
    return () => {
      staged.current = null;
      shown.current = "";
      stage.show(null);
      hand.release();
    };
  }, [stage, geometry.data, scan.id]);
  const { taken } = crop;
  useEffect(() => {
    if (!stage || !taken || !staged.current) return;
    staged.current.take(taken);
    stage.draw();
  }, [stage, taken, geometry.data]);
  useEffect(() => stage?.setGestures(!isCutting), [stage, isCutting]);
  const { look, change } = control;
  useEffect(() => {
    // A stroke is drawn over a hand that stands still.
    if (isCutting && look.isTurning) change({ isTurning: false });
  }, [isCutting, look.isTurning, change]);
  const begunOn = useRef("");
  const viewNow = (): string => `${shown.current} ${[...(stage?.projection() ?? [])].join()}`;
  /** A stroke belongs to the view that it was begun in. */
  const cut = (points: readonly Point[]): void => {
    if (stage && shown.current !== "" && viewNow() === begunOn.current) crop.cut(points, stage.projection());
  };

  const go = (by: number): void => {
    const next = place >= 0 ? list[place + by] : undefined;
    if (next) void navigate(`/scans/${next.id}`);
  };
  useKeymap("scan", {
    ...handHandlers("scan", stage, control),
    undo: crop.undo,
    redo: crop.redo,
    "scan.cut": () => setCutting(!isCutting),
    "scan.flip": crop.flip,
    "scan.uncut": crop.undo,
    "scan.save": () => crop.isChanged && crop.store(),
    "scan.next": () => go(1),
    "scan.previous": () => go(-1),
  });

  const hand = scan.side ?? registration.data?.side;
  const failure = geometry.error ?? registration.error;
  return (
    <div className={frame.page}>
      <div className={frame.bar}>
        <Link to={`/scans?collection=${encodeURIComponent(scan.collection)}`} className="one-line quiet" style={{ flex: "none", maxWidth: 240 }}>
          {scan.collection}
        </Link>
        <Title order={1} className="one-line" title={scan.name} style={{ fontSize: 16, lineHeight: "24px" }}>
          {scan.name}
        </Title>
        <Group gap={4} ml="auto" wrap="nowrap">
          <KeyIcon label="Previous scan" action="scan.previous" disabled={place <= 0} onClick={() => go(-1)}>
            <IconChevronLeft size={18} />
          </KeyIcon>
          <KeyIcon label="Next scan" action="scan.next" disabled={place < 0 || place >= list.length - 1} onClick={() => go(1)}>
            <IconChevronRight size={18} />
          </KeyIcon>
          <Button size="xs" variant="default" ml={8} component="a" href={scanFileUrl(scan)} download leftSection={<IconDownload size={14} aria-hidden />}>
            Download
          </Button>
          <For role="reviewer">
            <Button size="xs" ml={4} onClick={registering.open}>
              Register …
            </Button>
          </For>
        </Group>
      </div>
      <div className={frame.middle}>
        <HandRail scope="scan" control={control} hasMesh={Boolean(geometry.data?.mesh)}>
          <Tool label="Knife: the next stroke cuts" action="scan.cut" icon={<IconScissors size={18} />} isOn={isCutting} isDisabled={!crop.isReady} onClick={() => setCutting(!isCutting)} />
          <Tool label="Undo the last stroke" action="scan.uncut" icon={<IconArrowBackUp size={18} />} isDisabled={crop.draft.cuts.length === 0} onClick={crop.undo} />
          <Tool label="Take the other side of the last line" action="scan.flip" icon={<IconFlipHorizontal size={18} />} isDisabled={!crop.canFlip} onClick={crop.flip} />
          <span className={viewClasses.line} aria-hidden />
        </HandRail>
        <HandView
          scope="scan"
          label={`Scan ${scan.name}`}
          parts={parts}
          isBusy={!geometry.data && !failure}
          hasLegend={control.look.hasErrors && Boolean(geometry.data?.mesh)}
          failure={
            failure ? (
              <Failure what="The scan could not be drawn" error={failure} safe="Its file is untouched on the server's disk." onRetry={() => void (registration.error ? registration.refetch() : geometry.refetch())} />
            ) : undefined
          }
        >
          {isCutting && crop.isReady && <StrokeLayer onBegin={() => (begunOn.current = viewNow())} onStroke={cut} />}
        </HandView>
        <aside className={classes.panel} aria-label="About the scan" tabIndex={0}>
          <CropPanel crop={crop} revision={scan.revision} hasColors={scan.has_colors} />
          <Registrations scan={scan} />
          <section aria-label="Facts">
            <Title order={3} mb="sm">
              Scan
            </Title>
            <dl className={classes.facts}>
              <dt>Hand</dt>
              <dd>{hand ? <HandBadge hand={hand} /> : "to be found out"}{hand && !scan.side && ", found by registering"}</dd>
              <dt>Points</dt>
              <dd>{scan.point_count.toLocaleString("en")}</dd>
              <dt>Triangles</dt>
              <dd>{scan.face_count.toLocaleString("en")}</dd>
              <dt>Size</dt>
              <dd data-testid="scan-size">{formatSize(scan.size_m)}</dd>
              <dt>File</dt>
              <dd title={scan.digest}>
                {formatBytes(scan.byte_count)}, {scan.digest.slice(0, 12)}
              </dd>
              <dt>Added</dt>
              <dd>
                {formatAgo(scan.created_at)}
                {scan.created_by_name ? ` by ${scan.created_by_name}` : ""}
              </dd>
            </dl>
            {scan.notes.length > 0 && (
              <ul className={classes.notes}>
                {scan.notes.map((note) => (
                  <li key={note}>{note}</li>
                ))}
              </ul>
            )}
          </section>
          <UnitPanel scan={scan} hasUnsavedCrop={crop.isChanged} />
          <For role="lead">
            <Details key={`${scan.name}/${scan.subject}/${scan.pose}/${scan.collection}`} scan={scan} />
          </For>
          <LineageList kind="scan" id={scan.id} />
        </aside>
      </div>
      <div className={frame.line}>
        {HINTS.map(([id, label]) => (
          <span key={id} className={frame.hint}>
            <Kbd size="xs">{keyOf(id) || "–"}</Kbd>
            <Text size="xs" span>
              {label}
            </Text>
          </span>
        ))}
        <Text size="xs" span ml="auto" role="status">
          {isCutting ? "The next stroke cuts" : hasFingers ? "Drag to turn, pinch to zoom, two fingers to move" : "Drag to turn, wheel to zoom, right drag to move"}
        </Text>
      </div>
      <RegisterDialog isOpen={isRegistering} onClose={registering.close} scanIds={[scan.id]} />
    </div>
  );
}

/** One scan in 3D: look at it, crop it with one stroke, register it. */
export default function ScanPage() {
  const { scanId = "" } = useParams();
  const { data: scan, error, refetch } = useScan(scanId);
  useTitle(scan?.name);
  if (error && !scan) {
    return (
      <Failure what="This scan could not be loaded" error={error} onRetry={() => void refetch()}>
        <Button variant="default" component={Link} to="/scans">
          To the scans
        </Button>
      </Failure>
    );
  }
  if (!scan) return <PageSkeleton />;
  return <OpenScan key={scan.id} scan={scan} />;
}
