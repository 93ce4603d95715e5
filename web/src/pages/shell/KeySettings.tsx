import { ActionIcon, Button, Group, Stack, Text, TextInput, Title, Tooltip } from "@mantine/core";
import { Dialog } from "../parts/Dialog";
import { IconArrowBackUp, IconPlus, IconSearch, IconX } from "@tabler/icons-react";
import { useState } from "react";
import { chordOf, faultOf, KEYMAP, type KeyBinding, type KeyFault } from "../../model/keymap";
import { bindKeys, moveKey, restoreKeys, useCurrentKeymap } from "../../state/keys";
import { Keys } from "./KeyboardMap";
import classes from "./KeySettings.module.css";

const DEFAULTS: readonly KeyBinding[] = KEYMAP;
const isDefault = (binding: KeyBinding): boolean => DEFAULTS.find((one) => one.id === binding.id)?.keys.join(" ") === binding.keys.join(" ");
const nameOf = (group: string): string => (group === "Track" ? "Track page" : group);

interface Asked {
  readonly chord: string;
  readonly fault: KeyFault;
}

/** What stands in the way of a key, and the way out. */
function Fault({ asked, onMove, onKeep }: { asked: Asked; onMove: () => void; onKeep: () => void }) {
  const { chord, fault } = asked;
  return (
    <Group gap="sm" className={classes.fault} role="alert">
      <Text size="xs">
        {fault.kind === "taken" && `${chord} is “${fault.by.label}” now.`}
        {fault.kind === "reserved" && `${chord} belongs to the browser or the system: no page gets it.`}
        {fault.kind === "modifier" && "Press another key together with it."}
      </Text>
      {fault.kind === "taken" && (
        <Button size="compact-xs" onClick={onMove}>
          Move it here
        </Button>
      )}
      <Button size="compact-xs" variant="default" onClick={onKeep}>
        Leave it
      </Button>
    </Group>
  );
}

function Row({ binding }: { binding: KeyBinding }) {
  const map = useCurrentKeymap();
  const [isListening, setListening] = useState(false);
  const [asked, setAsked] = useState<Asked | null>(null);
  const done = (): void => {
    setListening(false);
    setAsked(null);
  };
  const press = (event: React.KeyboardEvent): void => {
    if (!isListening) return;
    event.preventDefault();
    event.stopPropagation();
    const chord = chordOf(event.nativeEvent);
    const fault = faultOf(map, binding.id, chord);
    if (fault?.kind === "modifier") return;
    if (chord === "Esc") return done();
    if (fault) {
      setListening(false);
      return setAsked({ chord, fault });
    }
    bindKeys(binding.id, [...binding.keys.filter((key) => key !== chord), chord]);
    done();
  };
  // Two pages have things of the same name.
  const name = `${binding.label}, ${nameOf(binding.group)}`;
  const defaults = DEFAULTS.find((one) => one.id === binding.id)?.keys ?? [];
  const restore = (): void => {
    const first = defaults.find((key) => faultOf(map, binding.id, key));
    const fault = first === undefined ? null : faultOf(map, binding.id, first);
    if (first !== undefined && fault) return setAsked({ chord: first, fault });
    bindKeys(binding.id, defaults);
  };
  return (
    <div className={classes.row} data-binding={binding.id}>
      <Text size="sm" className={classes.label}>
        {binding.label}
      </Text>
      <Group gap={6} wrap="nowrap" className={classes.keys}>
        {binding.keys.map((chord) => (
          <span key={chord} className={classes.key}>
            <Keys chord={chord} />
            <Tooltip label="Remove this key">
              <ActionIcon size={24} aria-label={`Remove ${chord} from ${name}`} onClick={() => bindKeys(binding.id, binding.keys.filter((key) => key !== chord))}>
                <IconX size={12} />
              </ActionIcon>
            </Tooltip>
          </span>
        ))}
        {binding.keys.length === 0 && (
          <Text size="xs" className="quiet">
            no key
          </Text>
        )}
        <Button
          size="compact-xs"
          variant={isListening ? "filled" : "default"}
          leftSection={isListening ? undefined : <IconPlus size={12} />}
          aria-label={isListening ? `Press a key … for ${name}` : `Key: a new one for ${name}`}
          onClick={() => {
            setAsked(null);
            setListening(true);
          }}
          onKeyDownCapture={press}
          onBlur={() => setListening(false)}
        >
          {isListening ? "Press a key …" : "Key"}
        </Button>
        <Tooltip label={`As it was: ${defaults.join(" or ")}`}>
          <ActionIcon
            size={24}
            aria-label={`Restore the keys of ${name}`}
            onClick={restore}
            style={{ visibility: isDefault(binding) ? "hidden" : "visible" }}
          >
            <IconArrowBackUp size={14} />
          </ActionIcon>
        </Tooltip>
      </Group>
      {asked && (
        <Fault
          asked={asked}
          onKeep={done}
          onMove={() => {
            if (asked.fault.kind === "taken") moveKey(binding.id, asked.chord, asked.fault.by.id);
            done();
          }}
        />
      )}
    </div>
  );
}

/** Every key of the app, to be put elsewhere; what is changed holds at once, in the handlers, the hints and the map. */
export function KeySettings({ isOpen, onClose }: { isOpen: boolean; onClose: () => void }) {
  const map = useCurrentKeymap();
  const [wanted, setWanted] = useState("");
  const words = wanted.trim().toLowerCase();
  const found = map.filter((binding) => `${binding.label} ${binding.keys.join(" ")} ${nameOf(binding.group)}`.toLowerCase().includes(words));
  const groups = [...new Set(found.map((binding) => binding.group))];
  return (
    <Dialog title="Keys" size={760} isOpen={isOpen} onClose={onClose}>
      <Group mb="md" wrap="nowrap">
        <TextInput
          flex={1}
          data-autofocus
          aria-label="Look for an action or a key"
          placeholder="Look for an action or a key"
          leftSection={<IconSearch size={15} />}
          value={wanted}
          onChange={(event) => setWanted(event.currentTarget.value)}
        />
        <Button variant="default" disabled={map.every(isDefault)} onClick={restoreKeys}>
          Restore defaults
        </Button>
      </Group>
      <Text size="xs" className="quiet" mb="sm">
        Changes apply at once and are kept with your account. Mouse gestures cannot be changed.
      </Text>
      <Stack gap="lg">
        {groups.map((group) => (
          <section key={group}>
            <Title order={3}>{nameOf(group)}</Title>
            {found
              .filter((binding) => binding.group === group)
              .map((binding) => (
                <Row key={binding.id} binding={binding} />
              ))}
          </section>
        ))}
        {found.length === 0 && <Text className="quiet">Nothing has this name or key. Look for a part of it, such as “frame” or “Ctrl”.</Text>}
      </Stack>
    </Dialog>
  );
}
