import { Title } from "@mantine/core";
import type { MovingRegistration } from "../../api/movingScans";
import { formatAgo, formatNumber } from "../../model/format";
import classes from "./Moving.module.css";
import { PRIORS } from "./priors";

const YES = { true: "yes", false: "no" } as const;

/** What a registration was made with, and how it went. */
export function RegistrationFacts({ registration, parent }: { registration: MovingRegistration; parent: MovingRegistration | undefined }) {
  const { number, prior, holds_hands, has_velocity, first_frame, last_frame, verdicts, guessed, scan_to_mesh_mm, created_by_name, created_at } = registration;
  const rows: readonly (readonly [string, string])[] = [
    ["Frames", `${first_frame} to ${last_frame}`],
    ...(parent ? [["Goes on from", `registration ${parent.number}`] as const] : []),
    ["Hands", PRIORS[prior].label],
    ["Hidden hands keep their pose", YES[`${holds_hands}`]],
    ["Held to the frame before", YES[`${has_velocity}`]],
    ["Scan to body, mean", scan_to_mesh_mm === null ? "–" : `${formatNumber(scan_to_mesh_mm, 2)} mm`],
    ["Good, doubtful, bad", (["good", "doubtful", "bad"] as const).map((name) => verdicts[name] ?? 0).join(", ")],
    ["Guessed left, right", (["left", "right"] as const).map((hand) => guessed[hand] ?? 0).join(", ")],
    ["Made", [created_by_name, formatAgo(created_at)].filter(Boolean).join(", ")],
  ];
  return (
    <section aria-label="The registration">
      <Title order={2}>Registration {number}</Title>
      <dl className={classes.facts}>
        {rows.map(([name, value]) => (
          <div key={name} className={classes.row}>
            <dt>{name}</dt>
            <dd>{value}</dd>
          </div>
        ))}
      </dl>
    </section>
  );
}
