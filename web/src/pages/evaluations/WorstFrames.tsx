import { Button, Group, Select, Text, Title } from "@mantine/core";
import { IconCube, IconPencil } from "@tabler/icons-react";
import { useState } from "react";
import { Link } from "react-router";
import type { Comparison, JudgedTrack, WorstFrame } from "../../api/evaluations";
import { HandBadge } from "../parts/HandBadge";
import classes from "./Evaluations.module.css";
import { PixelLegend } from "./JointTable";

function Picture({ track, item }: { track: JudgedTrack; item: WorstFrame }) {
  const camera = encodeURIComponent(item.camera);
  const annotate = `/recordings/${track.recording_key}/annotate?camera=${camera}&frame=${item.frame}&hand=${item.hand}`;
  const what = `frame ${item.frame}, ${item.camera}, ${item.hand} hand`;
  return (
    <article className={`card ${classes.picture}`} aria-label={what}>
      <Link className={classes.shot} to={annotate} title="Open in the annotator">
        {item.picture && <img loading="lazy" src={item.picture} alt={`Marks and track in ${what}`} />}
      </Link>
      <div style={{ padding: "8px 12px 12px" }}>
        <Group justify="space-between" wrap="nowrap" gap={8}>
          <Text size="sm" fw={600} className="one-line">
            {item.mean_px.toFixed(2)} px
          </Text>
          <HandBadge hand={item.hand} />
        </Group>
        <Text size="xs" className="quiet one-line">
          frame {item.frame}, {item.camera}
          {item.status === "ok" ? "" : `, ${item.status}`}
        </Text>
        <Text size="xs" className="quiet one-line">
          worst: {item.worst_joint.replace("_", " ")}, {item.max_px.toFixed(1)} px
        </Text>
        <Group gap={8} mt={8} wrap="nowrap" grow>
          <Button size="compact-xs" variant="default" component={Link} to={annotate} leftSection={<IconPencil size={13} aria-hidden />}>
            Annotate
          </Button>
          <Button size="compact-xs" variant="default" component={Link} to={`/tracks/${track.key}?frame=${item.frame}&camera=${camera}`} leftSection={<IconCube size={13} aria-hidden />}>
            3D
          </Button>
        </Group>
      </div>
    </article>
  );
}

/** The frames of one track that are worst, each one click from where it can be mended and looked at. */
export function WorstFrames({ comparison }: { comparison: Comparison }) {
  const { tracks } = comparison;
  const [chosen, setChosen] = useState<string | null>(null);
  const track = tracks.find((one) => one.key === chosen) ?? tracks.find((one) => one.worst.length > 0);
  if (!track) return null;
  return (
    <section aria-label="Worst frames">
      <Group justify="space-between" mb="sm">
        <Title order={2}>Worst frames</Title>
        <Group gap="md">
          <Text size="xs" className="quiet">
            white rings: marked (with a dot: visible) · crosses: tracked, error
          </Text>
          <PixelLegend />
          {tracks.length > 1 && (
            <Select
              size="xs"
              w={232}
              aria-label="Track of the worst frames"
              allowDeselect={false}
              data={tracks.map((one) => ({ value: one.key, label: `${one.name}, ${one.recording}` }))}
              value={track.key}
              onChange={setChosen}
            />
          )}
        </Group>
      </Group>
      <div className={classes.pictures}>
        {track.worst.map((item) => (
          <Picture key={`${item.camera}/${item.frame}/${item.hand}`} track={track} item={item} />
        ))}
      </div>
    </section>
  );
}
