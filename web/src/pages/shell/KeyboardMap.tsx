import { Button, Group, Kbd, Stack, Text, Title } from "@mantine/core";
import { Dialog } from "../parts/Dialog";
import { IconKeyboard } from "@tabler/icons-react";
import { Fragment } from "react";
import { useLocation } from "react-router";
import type { KeyBinding, Scope } from "../../model/keymap";
import { useCurrentKeymap } from "../../state/keys";
import classes from "./KeyboardMap.module.css";

const MOUSE: readonly (readonly [string, string])[] = [
  ["Click", "Place the next joint, or choose the one under the cursor"],
  ["Drag a joint", "Move it"],
  ["Alt + drag", "Move the whole hand"],
  ["Alt + wheel", "Turn the whole hand about the cursor"],
  ["Alt + Shift + wheel", "Make the whole hand larger or smaller"],
  ["Right click on a joint", "Visible, occluded, outside"],
  ["Wheel", "Zoom at the cursor"],
  ["Drag the background, Ctrl + drag, or Space + drag", "Pan"],
  ["Double click beside the image", "Fit the image"],
];

/** "Ctrl+Shift+Z" as keys to look at. */
export function Keys({ chord }: { chord: string }) {
  return (
    <Group gap={2} wrap="nowrap" component="span">
      {chord.split(/\+(?=.)/).map((key) => (
        <Kbd key={key} size="xs">
          {key}
        </Kbd>
      ))}
    </Group>
  );
}

function Row({ keys, label }: { keys: readonly string[]; label: string }) {
  return (
    <Group justify="space-between" wrap="nowrap" gap="md" py={2}>
      <Text size="sm">{label}</Text>
      <Group gap={6} wrap="nowrap">
        {keys.length === 0 && (
          <Text size="xs" className="quiet" span>
            no key
          </Text>
        )}
        {keys.map((chord, index) => (
          <Fragment key={chord}>
            {index > 0 && (
              <Text size="xs" className="quiet" span>
                or
              </Text>
            )}
            <Keys chord={chord} />
          </Fragment>
        ))}
      </Group>
    </Group>
  );
}

/** Whose keys a page answers, by its address. */
function scopeOf(path: string): Scope | null {
  if (path.endsWith("/annotate")) return "annotate";
  const scopes: readonly (readonly [string, Scope])[] = [
    ["/tracks/", "track"],
    ["/curate", "curate"],
    ["/scans/", "scan"],
  ];
  return scopes.find(([start]) => path.startsWith(start))?.[1] ?? null;
}

function KeyGroup({ group, map }: { group: string; map: readonly KeyBinding[] }) {
  return (
    <Stack gap={2} className={classes.group}>
      <Title order={3}>{group === "Track" ? "Track page" : group}</Title>
      {map
        .filter((binding) => binding.group === group)
        .map((binding) => (
          <Row key={binding.id} keys={binding.keys} label={binding.label} />
        ))}
    </Stack>
  );
}

/** The keyboard map, made from the same table as the handlers. */
export function KeyboardMap({ isOpen, onClose, onSettings }: { isOpen: boolean; onClose: () => void; onSettings: () => void }) {
  const map = useCurrentKeymap();
  const scope = scopeOf(useLocation().pathname);
  const isHere = (binding: KeyBinding): boolean => scope === null || binding.scope === scope || binding.scope === "everywhere";
  const groupsOf = (some: readonly KeyBinding[]): string[] => [...new Set(some.map((binding) => binding.group))];
  const elsewhere = groupsOf(map.filter((binding) => !isHere(binding)));
  return (
    <Dialog title="Keyboard map" size={1040} isOpen={isOpen} onClose={onClose}>
      <Group justify="space-between" mb="md">
        <Text size="sm" className="quiet">
          {scope ? "The keys of this page come first. " : ""}Every key can be put elsewhere.
        </Text>
        <Button variant="default" size="xs" leftSection={<IconKeyboard size={15} />} onClick={onSettings}>
          Change keys
        </Button>
      </Group>
      <div className={classes.columns}>
        {groupsOf(map.filter(isHere)).map((group) => (
          <KeyGroup key={group} group={group} map={map} />
        ))}
        <Stack gap={2} className={classes.group}>
          <Title order={3}>Mouse, on the picture</Title>
          {MOUSE.map(([gesture, label]) => (
            <Group key={gesture} justify="space-between" wrap="nowrap" gap="md" py={2}>
              <Text size="sm">{label}</Text>
              <Text size="xs" className="quiet" ta="right">
                {gesture}
              </Text>
            </Group>
          ))}
        </Stack>
      </div>
      {elsewhere.length > 0 && (
        <>
          <Title order={2} mt="lg" mb="md">
            On other pages
          </Title>
          <div className={classes.columns}>
            {elsewhere.map((group) => (
              <KeyGroup key={group} group={group} map={map} />
            ))}
          </div>
        </>
      )}
    </Dialog>
  );
}
