import { Group, Skeleton, Stack, Text, Title } from "@mantine/core";
import { IconChecks, IconHandStop, IconPackage, IconScan, IconStack2, IconUser } from "@tabler/icons-react";
import { Link } from "react-router";
import { useLineage, type Lineage, type LineageItem, type LineageKind } from "../../api/handModels";
import { formatCount } from "../../model/format";
import classes from "./Models.module.css";

const KINDS: Record<LineageKind, { one: string; many: string; icon: typeof IconScan }> = {
  scan: { one: "scan", many: "scans", icon: IconScan },
  registration: { one: "registration", many: "registrations", icon: IconStack2 },
  decision: { one: "decision", many: "decisions", icon: IconChecks },
  training_set: { one: "training set", many: "training sets", icon: IconPackage },
  hand_model: { one: "hand model", many: "hand models", icon: IconHandStop },
  moving_scan: { one: "moving scan", many: "moving scans", icon: IconScan },
  moving_registration: { one: "registration", many: "registrations", icon: IconStack2 },
  stretch_decision: { one: "decision", many: "decisions", icon: IconChecks },
  body_set: { one: "kept set", many: "kept sets", icon: IconPackage },
  person_model: { one: "model of a person", many: "models of people", icon: IconUser },
};
const SHOWN = 5;

function addressOf({ kind, id }: LineageItem): string | null {
  if (kind === "scan") return `/scans/${id}`;
  if (kind === "moving_scan") return `/scans/moving/${id}`;
  if (kind === "registration") return `/curate?queue=all&registration=${id}`;
  return kind === "hand_model" ? `/models/${id}` : null;
}

function Groups({ title, groups }: { title: string; groups: Lineage["comes_from"] }) {
  const filled = groups.filter((group) => group.total > 0);
  if (filled.length === 0) return null;
  return (
    <section aria-label={title}>
      <Text size="xs" className="quiet" mb={4}>
        {title}
      </Text>
      <Stack gap="sm">
        {filled.map(({ kind, total, items }) => {
          const { one, many, icon: Icon } = KINDS[kind];
          const shown = items.slice(0, SHOWN);
          return (
            <div key={kind} className={classes.group}>
              <Group gap={8} mb={4}>
                <Icon size={16} aria-hidden />
                <Text size="sm" fw={600}>
                  {formatCount(total, one, many)}
                </Text>
              </Group>
              <ul className={classes.items}>
                {shown.map((item) => {
                  const to = addressOf(item);
                  return (
                    <li key={item.id} className="one-line" title={[item.name, item.detail].filter(Boolean).join(", ")}>
                      {to ? (
                        <Link to={to} className={classes.link}>
                          {item.name}
                        </Link>
                      ) : (
                        item.name
                      )}
                      {item.detail && <span className="quiet"> {item.detail}</span>}
                    </li>
                  );
                })}
                {total > shown.length && <li className="quiet">and {(total - shown.length).toLocaleString("en")} more</li>}
              </ul>
            </div>
          );
        })}
      </Stack>
    </section>
  );
}

/** From scan to registration to decision to training set to model, and back. */
export function LineageList({ kind, id }: { kind: LineageKind; id: string }) {
  const { data, error, isPending } = useLineage(kind, id);
  return (
    <section aria-label="Lineage">
      <Title order={3} mb="sm">
        Lineage
      </Title>
      {isPending && <Skeleton h={96} />}
      {error && (
        <Text size="xs" c="var(--bad-text)" role="alert">
          The lineage could not be loaded: {error.message}
        </Text>
      )}
      {data && (
        <Stack gap="md">
          <Groups title="Comes from" groups={data.comes_from} />
          <Groups title="Went into" groups={data.went_into} />
          {[...data.comes_from, ...data.went_into].every((group) => group.total === 0) && (
            <Text size="xs" className="quiet">
              Nothing has been made from it yet.
            </Text>
          )}
        </Stack>
      )}
    </section>
  );
}
