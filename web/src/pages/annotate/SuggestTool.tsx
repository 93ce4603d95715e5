import { ActionIcon, Popover, Select, Stack, Switch, Text, Tooltip } from "@mantine/core";
import { IconSparkles } from "@tabler/icons-react";
import { useState } from "react";
import { acceptHand, acceptJoint } from "../../actions/annotate/accept";
import { useTracks } from "../../api/tracks";
import { SOURCE_NAMES, SOURCES, type Source } from "../../model/suggestion";
import { useHint } from "../../state/keys";
import { setHidden } from "../../state/suggestions";
import { useActions, useAnnotating } from "./annotating";
import { useCamera, useIsBlind, useOpenRecording, useSuggestions } from "./reading";
import { DetectRecording, useDetectJobs } from "./DetectRecording";
import { useDetectedSuggestions, useFitSuggestion, useTrackSuggestions } from "./useSuggestionSources";

const ABOUT: Record<Source, string> = {
  triangulation: "joints placed in other cameras, seen from here",
  interpolation: "between two key frames of this hand",
  fit: "a hand model fitted to the joints placed so far, from the fourth on",
  track: "the fitted hand of a tracking run",
  detector: "hands that a neural network sees in this image",
};

/** A blind replica is marked without suggestions: people who accept the same ones would seem to agree. */
export function SuggestTool() {
  return useIsBlind() ? null : <Suggest />;
}

/** Asks the machines, answers the keys that accept, and lets one choose who may suggest. */
function Suggest() {
  const { session, act } = useAnnotating();
  const recording = useOpenRecording();
  const tracks = useTracks(recording.id).data ?? [];
  const [chosen, setChosen] = useState<string | null>(null);
  const hint = useHint();
  const track = tracks.find((one) => one.id === chosen)?.id ?? recording.best_track?.id;
  const hidden = useSuggestions((state) => state.hidden);
  const isOn = hidden.size < SOURCES.length;

  useTrackSuggestions(track);
  const failure = useFitSuggestion(!hidden.has("fit"));
  const hasColor = useCamera().has_color;
  const detectJobs = useDetectJobs(recording.id);
  const detectorFailure = useDetectedSuggestions(detectJobs.found?.id, detectJobs.isKnown && !hidden.has("detector"));
  const toggle = (): void => setHidden(session.suggestions, isOn ? SOURCES : []);
  useActions({
    "suggestion.joint": () => act(acceptJoint, session.suggestions.get()),
    "suggestion.hand": () => act(acceptHand, session.suggestions.get()),
    "suggestion.toggle": toggle,
  });

  return (
    <Popover position="bottom-start" withArrow shadow="md" trapFocus returnFocus>
      <Popover.Target>
        <Tooltip label={hint("Suggestions", "suggestion.toggle")}>
          <ActionIcon size={32} aria-label="Suggestions" variant={isOn ? "light" : "subtle"} color={isOn ? "violet" : "gray"}>
            <IconSparkles size={18} />
          </ActionIcon>
        </Tooltip>
      </Popover.Target>
      <Popover.Dropdown data-over-picture>
        <Stack gap={12} w={288}>
          <Switch size="xs" color="violet" label="Show suggestions" checked={isOn} onChange={toggle} />
          {SOURCES.map((source) => (
            <Switch
              key={source}
              size="xs"
              color="violet"
              label={SOURCE_NAMES[source]}
              description={source === "detector" && !hasColor ? "sees nothing in this view: it has only depth" : ABOUT[source]}
              disabled={source === "detector" && !hasColor}
              checked={!hidden.has(source)}
              onChange={({ currentTarget: { checked } }) => setHidden(session.suggestions, SOURCES.filter((one) => (one === source ? !checked : hidden.has(one))))}
            />
          ))}
          {tracks.length > 1 && (
            <Select
              size="xs"
              label="Track"
              allowDeselect={false}
              comboboxProps={{ withinPortal: false }}
              data={tracks.map(({ id, name }) => ({ value: id, label: name }))}
              value={track ?? null}
              onChange={setChosen}
            />
          )}
          {!hidden.has("detector") && recording.cameras.some((camera) => camera.has_color) && <DetectRecording recording={recording.id} jobs={detectJobs} />}
          {detectorFailure !== null && (
            <Text size="xs" c="var(--warn-text)" role="status">
              The hand detector suggests nothing: {detectorFailure} Your joints are safe.
            </Text>
          )}
          {failure !== null && (
            <Text size="xs" c="var(--warn-text)" role="status">
              No model fit: {failure} Your joints are safe.
            </Text>
          )}
        </Stack>
      </Popover.Dropdown>
    </Popover>
  );
}
