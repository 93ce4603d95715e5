import { Group, Text, Title } from "@mantine/core";
import { importPicture } from "../../api/imports";
import type { CameraReport } from "../../api/types";
import { formatPicture } from "../../model/format";
import classes from "./ImportPictures.module.css";

const PLACES = ["First", "Middle", "Last"];

interface ThumbnailsProps {
  importId: string;
  names: readonly string[];
  /** What they show, for those who don't see them. */
  what: string;
}

/** First, middle and last image of a series. */
export function Thumbnails({ importId, names, what }: ThumbnailsProps) {
  return (
    <div className={classes.row}>
      {names.map((name, index) => (
        <figure key={name} className={classes.figure}>
          <img src={importPicture(importId, name)} alt={`${names.length === 3 ? PLACES[index] : "An"} image of ${what}: ${name}`} loading="lazy" className={classes.image} />
          <figcaption className={classes.caption} title={name}>
            {formatPicture(name)}
          </figcaption>
        </figure>
      ))}
    </div>
  );
}

const KINDS: Record<string, string> = { color: "Colour", depth: "Depth" };

/** What would be imported, as pictures; kinds that are still to be chosen are left to their question. */
export function ImportPictures({ importId, cameras, open }: { importId: string; cameras: readonly CameraReport[]; open: readonly string[] }) {
  const rows = cameras.flatMap((camera) =>
    Object.entries(camera.pictures ?? {})
      .filter(([kind, names]) => names.length > 0 && !open.includes(kind))
      .map(([kind, names]) => ({ key: `${camera.id} ${kind}`, title: cameras.length > 1 ? `${camera.id}, ${KINDS[kind]?.toLowerCase()}` : KINDS[kind], names })),
  );
  if (rows.length === 0) return null;
  return (
    <section className="card" style={{ padding: 16 }} aria-label="Pictures of what would come in">
      <Title order={2} mb="sm">
        What would be imported
      </Title>
      <Group gap="lg" align="flex-start">
        {rows.map(({ key, title, names }) => (
          <div key={key}>
            <Text size="sm" fw={600} mb={4}>
              {title}
            </Text>
            <Thumbnails importId={importId} names={names} what={title ?? ""} />
          </div>
        ))}
      </Group>
    </section>
  );
}
