import { ActionIcon, Checkbox, Loader, Text } from "@mantine/core";
import { IconChevronDown, IconChevronUp } from "@tabler/icons-react";
import { useState, type ReactNode } from "react";
import type { Layer } from "../../api/tracks";
import type { ViewerSession } from "../../api/types";
import { errorGradient } from "../../model/errorColor";
import { describeCollisions, describeContacts, describeDetections, describeOrigin, describeUnknown } from "../../model/evidence";
import { formatMeasure, formatNumber } from "../../model/format";
import classes from "./EvidenceCard.module.css";

interface EvidenceCardProps {
  told: ViewerSession | null;
  layers: Record<Layer, boolean>;
  isBusy: boolean;
  terms: Record<string, boolean>;
  onTerms: (terms: Record<string, boolean>) => void;
}

const LISTED = ["correspondences", "detections", "collisions", "contacts", "unknown", "distances"] as const;
const MOST_ROWS = 8;

/** What the layers that are on say of this frame; nothing while none is. */
export function EvidenceCard({ told, layers, isBusy, terms, onTerms }: EvidenceCardProps) {
  const [isOpen, setOpen] = useState(true);
  const on = LISTED.filter((layer) => layers[layer]);
  if (on.length === 0) return null;
  const Chevron = isOpen ? IconChevronUp : IconChevronDown;

  return (
    <aside className={classes.card} aria-label="What is seen in this frame" aria-busy={isBusy}>
      <header className={classes.head}>
        <Text size="xs" fw={600}>
          Frame {told?.frame ?? "…"}
        </Text>
        {isBusy && <Loader size={12} />}
        <ActionIcon size="xs" ml="auto" aria-label={isOpen ? "Fold" : "Unfold"} aria-expanded={isOpen} onClick={() => setOpen(!isOpen)}>
          <Chevron size={14} />
        </ActionIcon>
      </header>
      {isOpen && told && (
        <div className={classes.body}>
          {layers.correspondences && <Correspondences found={told.terms} shown={terms} onShown={onTerms} />}
          {layers.detections && told.detections && (
            <Part title="Detections" says={describeDetections(told.detections)} origin={describeOrigin("detections", told.detections.is_of_run, told.detections.own_detector)}>
              <Rows
                rows={told.detections.items.map((item) => ({
                  color: item.color,
                  name: item.finger ? `${item.hand ?? ""} ${item.finger}` : "no fingertip",
                  values: [`confidence ${formatNumber(item.confidence)}`, item.distance_mm === null ? "" : formatMeasure(item.distance_mm, "mm")],
                }))}
              />
            </Part>
          )}
          {layers.collisions && told.collisions && (
            <Part title="Collisions" says={describeCollisions(told.collisions)} origin={describeOrigin("collisions", told.collisions.is_of_run)}>
              <Rows
                rows={told.collisions.pairs.map((pair) => ({
                  name: `${pair.first} – ${pair.second}`,
                  values: [pair.deepest_mm > 0 ? `${formatNumber(pair.deepest_mm)} mm` : "crossing"],
                }))}
              />
              {told.collisions.vertices > 0 && <Scale label="depth of a vertex" full={told.collisions.full_mm} />}
            </Part>
          )}
          {layers.contacts && told.contacts && (
            <Part title="Contact candidates" says={describeContacts(told.contacts)} origin={describeOrigin("contacts", told.contacts.is_of_run)}>
              <Rows
                rows={told.contacts.parts.map((part) => ({
                  color: part.is_chosen ? "#b48cff" : "#ced4da",
                  name: `${part.hand} ${part.part}${part.is_chosen ? " (chosen)" : ""}`,
                  values: [part.distance_mm < 0 ? `${formatNumber(-part.distance_mm)} mm in` : `${formatNumber(part.distance_mm)} mm off`],
                }))}
              />
            </Part>
          )}
          {layers.unknown && told.unknown && (
            <Part title="Unknown things" says={describeUnknown(told.unknown)} origin={null}>
              <Rows rows={[{ color: told.unknown.color, name: "neither hand nor an object with a model", values: [] }]} />
            </Part>
          )}
          {layers.distances && told.distances && (
            <Part title="Distance to the data" says="Of skin that the camera sees, to the nearest measured point. Grey: out of sight." origin={null}>
              <Scale label="distance" full={told.distances.full_mm} />
              <Rows
                rows={told.distances.models.map((model) => ({
                  name: model.name,
                  values: [`median ${formatNumber(model.median_mm)}`, `95 % ${formatMeasure(model.p95_mm, "mm")}`],
                }))}
              />
            </Part>
          )}
        </div>
      )}
    </aside>
  );
}

interface CorrespondencesProps {
  found: ViewerSession["terms"];
  shown: Record<string, boolean>;
  onShown: (terms: Record<string, boolean>) => void;
}

function Correspondences({ found, shown, onShown }: CorrespondencesProps) {
  return (
    <Part title="Correspondences" says={found.length === 0 ? "None: the models are out of the camera's sight here." : null} origin={null}>
      {found.map((term) => (
        <div key={term.name} className={classes.row}>
          <Checkbox
            size="xs"
            label={
              <>
                <i className={classes.swatch} style={{ background: term.color }} aria-hidden /> {term.label}
              </>
            }
            aria-label={`Correspondences of ${term.label.toLowerCase()}`}
            checked={shown[term.name] ?? true}
            onChange={(event) => onShown({ ...shown, [term.name]: event.currentTarget.checked })}
          />
          <span className={classes.value}>{term.count.toLocaleString("en")}</span>
        </div>
      ))}
    </Part>
  );
}

function Part({ title, says, origin, children }: { title: string; says: string | null; origin: string | null; children: ReactNode }) {
  return (
    <section className={classes.part}>
      <h3 className={classes.title}>{title}</h3>
      {says && <p className={classes.says}>{says}</p>}
      {children}
      {origin && <p className={classes.origin}>{origin}</p>}
    </section>
  );
}

function Rows({ rows }: { rows: { color?: string; name: string; values: string[] }[] }) {
  return (
    <>
      {rows.slice(0, MOST_ROWS).map((row, place) => (
        <div key={place} className={classes.row}>
          <span className={classes.name}>
            {row.color && <i className={classes.swatch} style={{ background: row.color }} aria-hidden />} {row.name}
          </span>
          {row.values.filter(Boolean).map((value) => (
            <span key={value} className={classes.value}>
              {value}
            </span>
          ))}
        </div>
      ))}
      {rows.length > MOST_ROWS && <p className={classes.origin}>and {rows.length - MOST_ROWS} more</p>}
    </>
  );
}

function Scale({ label, full }: { label: string; full: number }) {
  return (
    <div className={classes.scale}>
      <span>0</span>
      <span className={classes.gradient} style={{ background: errorGradient }} role="img" aria-label={`Colours of the ${label}: blue is 0, red is ${full} mm and more`} />
      <span>{full} mm and more</span>
    </div>
  );
}
