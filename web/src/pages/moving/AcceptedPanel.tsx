import { Button, Menu, Text, TextInput, Title } from "@mantine/core";
import { useDisclosure } from "@mantine/hooks";
import { IconDownload, IconUser } from "@tabler/icons-react";
import { useState } from "react";
import { Link } from "react-router";
import { bodySetUrl, useAcceptedFrames, personModelUrl, useBodySets, useKeepAccepted, useMakePersonModel, usePersonModels, type AcceptedFrames, type BodySet, type MovingScan } from "../../api/movingScans";
import { formatAgo, formatCount } from "../../model/format";
import { sayStretch } from "../../model/stretch";
import { Dialog, FormDialog } from "../parts/Dialog";
import { For } from "../parts/For";
import classes from "./Moving.module.css";
import { PRIORS } from "./priors";

type AcceptedStretch = AcceptedFrames["stretches"][number];

/** From scan to registration to decision, stretch by stretch. */
function Stretches({ stretches, onRegistration }: { stretches: readonly AcceptedStretch[]; onRegistration: (id: string, frame: number) => void }) {
  return (
    <ul className={classes.list}>
      {stretches.map((one) => (
        <li key={`${one.registration_id}/${one.first_frame}`} style={{ flexWrap: "wrap", rowGap: 0 }}>
          <button type="button" className={classes.jump} onClick={() => onRegistration(one.registration_id, one.first_frame)}>
            {sayStretch({ first: one.first_frame, last: one.last_frame })}
          </button>
          <span>
            registration {one.registration_number}, {PRIORS[one.prior].label} (
            <Link to={`/jobs/${one.job_id}`} className={classes.link}>
              job
            </Link>
            ), accepted by {one.accepted_by_name} {formatAgo(one.accepted_at)}
          </span>
        </li>
      ))}
    </ul>
  );
}

/** The model of the person of a set: made once, then taken as a file. */
function SetModel({ set, scan }: { set: BodySet; scan: string }) {
  const model = usePersonModels(scan).data?.find((one) => one.body_set_id === set.id);
  const make = useMakePersonModel(scan);
  if (model) {
    return (
      <Menu position="bottom-end">
        <Menu.Target>
          <Button size="compact-xs" variant="default" leftSection={<IconUser size={14} aria-hidden />} aria-label={`The person’s model of ${set.name}`}>
            Model
          </Button>
        </Menu.Target>
        <Menu.Dropdown>
          {(["npz", "pkl"] as const).map((kind) => (
            <Menu.Item key={kind} component="a" href={personModelUrl(model.id, kind)} download>
              As SMPL-H, .{kind}
            </Menu.Item>
          ))}
        </Menu.Dropdown>
      </Menu>
    );
  }
  return (
    <For role="reviewer">
      <Button size="compact-xs" variant="default" loading={make.isPending} onClick={() => make.mutate(set.id)} aria-label={`Make the person’s model of ${set.name}`}>
        Make model
      </Button>
      {make.error && (
        <Text size="xs" c="var(--bad-text)" role="alert" w="100%">
          {make.error.message}
        </Text>
      )}
    </For>
  );
}

interface AcceptedPanelProps {
  scan: MovingScan;
  onRegistration: (id: string, frame: number) => void;
}

/** What counts of the moving scan, what was kept of it, and where each comes from. */
export function AcceptedPanel({ scan, onRegistration }: AcceptedPanelProps) {
  const accepted = useAcceptedFrames(scan.id).data;
  const sets = useBodySets(scan.id).data ?? [];
  const keep = useKeepAccepted(scan.id);
  const [isNaming, naming] = useDisclosure(false);
  const [name, setName] = useState("");
  const [shown, setShown] = useState<string | null>(null);
  const set = sets.find((one) => one.id === shown);
  const count = accepted?.frame_count ?? 0;
  const close = (): void => {
    naming.close();
    keep.reset();
  };
  return (
    <section aria-label="Accepted frames">
      <Title order={2}>
        Accepted, {count.toLocaleString("en")} of {formatCount(scan.frame_count, "frame")}
      </Title>
      {accepted && count > 0 ? (
        <Stretches stretches={accepted.stretches} onRegistration={onRegistration} />
      ) : (
        <Text size="xs" className="quiet">
          Of each frame the registration counts that was accepted last. What is accepted is kept as a set for other programs.
        </Text>
      )}
      {count > 0 && (
        <For role="reviewer">
          <Button size="xs" variant="default" mt={8} fullWidth onClick={naming.open}>
            Keep what is accepted …
          </Button>
        </For>
      )}
      {sets.length > 0 && (
        <>
          <Title order={2} mt="md">
            Kept sets
          </Title>
          <ul className={classes.list}>
            {sets.map((one) => (
              <li key={one.id} style={{ flexWrap: "wrap" }}>
                <button type="button" className={`${classes.jump} one-line`} style={{ flex: "0 1 auto" }} title={`${one.name}: where it comes from`} onClick={() => setShown(one.id)}>
                  {one.name}
                </button>
                <span className="quiet one-line" style={{ flex: 1 }}>
                  {formatCount(one.frame_count, "frame")}
                </span>
                <Button component="a" href={bodySetUrl(one.id)} size="compact-xs" variant="default" leftSection={<IconDownload size={14} aria-hidden />} aria-label={`Download ${one.name}`}>
                  .zip
                </Button>
                <SetModel set={one} scan={scan.id} />
              </li>
            ))}
          </ul>
        </>
      )}
      <FormDialog
        title="Keep what is accepted"
        size={480}
        isOpen={isNaming}
        onClose={close}
        onSubmit={() => keep.mutate(name.trim() || scan.name, { onSuccess: () => (setName(""), close()) })}
        verb="Keep"
        isBusy={keep.isPending}
        failure={keep.error}
        failed="Nothing was kept."
      >
        <Text size="sm" className="quiet">
          {formatCount(count, "frame")} as they are accepted now. The set never changes; its .zip holds a motion as AMASS keeps it, a mesh a frame, the person’s model and where each comes from.
        </Text>
        <TextInput label="Name" placeholder={scan.name} maxLength={200} value={name} onChange={(event) => setName(event.currentTarget.value)} data-autofocus />
      </FormDialog>
      {set && (
        <Dialog title={set.name} size={560} onClose={() => setShown(null)}>
          <Text size="sm" className="quiet" mb="sm">
            {formatCount(set.frame_count, "frame")} of {scan.name}, kept by {set.created_by_name ?? "somebody"} {formatAgo(set.created_at)}. SHA-256 {set.digest.slice(0, 12)}.
          </Text>
          <Stretches stretches={set.stretches} onRegistration={(id, frame) => (setShown(null), onRegistration(id, frame))} />
        </Dialog>
      )}
    </section>
  );
}
