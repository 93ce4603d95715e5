import { Badge, Button, Group, Stack, Text, Title } from "@mantine/core";
import { useState } from "react";
import { scanThumbnailUrl, useChangeUnits, type Scan } from "../../api/scans";
import { formatSize, formatUnit, judgeSize } from "../../model/scanUnit";
import { hasRole, useMe } from "../../state/me";
import { HandForScale } from "./HandForScale";
import { UnitField } from "./UnitField";

/** Share of a thumbnail's side that its scan fills (server/scans/thumbnails.py). */
const FILLED = 0.88;

/** The unit of a scan's file and the size that it makes, beside a hand; leads correct it. */
export function UnitPanel({ scan, hasUnsavedCrop }: { scan: Scan; hasUnsavedCrop: boolean }) {
  const mayChange = hasRole(useMe(), "lead");
  const change = useChangeUnits();
  const [draft, setDraft] = useState<number | null>(null);
  const [isOpen, setOpen] = useState(false);
  const factor = draft !== null && scan.metres_per_unit !== null ? draft / scan.metres_per_unit : 1;
  const size = scan.size_m.map((side) => side * factor);
  const length = size[0] ?? 0;
  const verdict = judgeSize(length);
  const units = scan.metres_per_unit === null ? null : (scan.size_m[0] ?? 0) / scan.metres_per_unit;
  const keep = (metresPerUnit: number): void =>
    change.mutate({ scans: [scan], metresPerUnit }, { onSuccess: () => (setOpen(false), setDraft(null)) });
  return (
    <section aria-label="Unit and size">
      <Group gap="sm" mb="sm">
        <Title order={3}>Unit and size</Title>
        {scan.is_unit_guessed && (
          <Badge color="yellow" variant="outline" size="sm" c="var(--mantine-color-text)">
            Guess
          </Badge>
        )}
      </Group>
      <HandForScale picture={scanThumbnailUrl(scan)} pictureSide={length / FILLED} length={length} />
      <Stack gap="sm" mt="sm">
        <Text size="xs">
          {formatSize(size)}; {formatUnit(draft ?? scan.metres_per_unit)}
          {scan.is_unit_guessed && draft === null ? ", guessed from the size" : ""}.
        </Text>
        {verdict.text && (
          <Text size="xs" c={verdict.state === "bad" ? "var(--bad-text)" : "var(--warn-text)"} role="status">
            {verdict.text}
          </Text>
        )}
        {mayChange && isOpen && (
          <>
            <UnitField value={draft ?? scan.metres_per_unit} units={units} onChange={setDraft} />
            {scan.registration && (
              <Text size="xs" className="quiet">
                Its registrations were made at this size. With another unit they no longer count, and the scan must be registered again.
              </Text>
            )}
            {hasUnsavedCrop && (
              <Text size="xs" className="quiet">
                Save or clear the crop first.
              </Text>
            )}
          </>
        )}
        {change.error && (
          <Text size="xs" c="var(--bad-text)" role="alert" style={{ overflowWrap: "anywhere" }}>
            {change.error.message}
          </Text>
        )}
        {mayChange && (
          <Group gap="sm">
            {!isOpen && scan.is_unit_guessed && scan.metres_per_unit !== null && verdict.state !== "bad" && (
              <Button size="compact-xs" loading={change.isPending} onClick={() => keep(scan.metres_per_unit ?? 1)}>
                The size is right
              </Button>
            )}
            {isOpen ? (
              <>
                <Button size="compact-xs" disabled={draft === null || verdict.state === "bad" || hasUnsavedCrop} loading={change.isPending} onClick={() => draft !== null && keep(draft)}>
                  Set the unit
                </Button>
                <Button size="compact-xs" variant="default" onClick={() => (setOpen(false), setDraft(null), change.reset())}>
                  As it was
                </Button>
              </>
            ) : (
              <Button size="compact-xs" variant="default" onClick={() => setOpen(true)}>
                Correct the unit …
              </Button>
            )}
          </Group>
        )}
      </Stack>
    </section>
  );
}
