import { Button, Checkbox, Group, Popover, Stack, Text } from "@mantine/core";
import { IconLayoutGrid, IconTopologyStar3, IconVectorSpline, IconZoomInArea } from "@tabler/icons-react";
import { MAX_SHOWN } from "../../state/shownCameras";
import { useAnnotating } from "./annotating";
import { useCamera, useOpenRecording, useOption, useShownCameras } from "./reading";
import { useTriangulation } from "./useTriangulation";
import { Tool } from "../parts/Tool";

/** Which cameras are shown side by side. */
export function CamerasTool() {
  const { showCameras } = useAnnotating();
  const recording = useOpenRecording();
  const camera = useCamera();
  const shown = useShownCameras();
  const all = recording.cameras.map((one) => one.id);
  if (all.length < 2) return null;
  const names = shown.map((one) => one.id);
  return (
    <Popover position="bottom-start" withArrow shadow="md" trapFocus returnFocus>
      <Popover.Target>
        <Button size="xs" variant="default" leftSection={<IconLayoutGrid size={14} aria-hidden />} style={{ flex: "none" }}>
          {names.length} of {all.length} cameras
        </Button>
      </Popover.Target>
      <Popover.Dropdown>
        <Stack gap="sm" miw={200}>
          <Checkbox.Group label="Shown side by side" value={names} onChange={showCameras}>
            <Stack gap="sm" mt="sm" mah={280} style={{ overflowY: "auto" }}>
              {recording.cameras.map((one) => (
                <Checkbox
                  key={one.id}
                  size="xs"
                  value={one.id}
                  label={one.id === camera.id ? `${one.id} (active)` : one.id}
                  disabled={one.id === camera.id || (names.length >= MAX_SHOWN && !names.includes(one.id))}
                />
              ))}
            </Stack>
          </Checkbox.Group>
          <Group gap="sm" grow>
            <Button size="compact-xs" variant="default" onClick={() => showCameras(all.slice(0, MAX_SHOWN))}>
              {all.length > MAX_SHOWN ? `First ${MAX_SHOWN}` : "All"}
            </Button>
            <Button size="compact-xs" variant="default" onClick={() => showCameras([camera.id])}>
              Only {camera.id}
            </Button>
          </Group>
          {all.length > MAX_SHOWN && (
            <Text size="xs" className="quiet">
              At most {MAX_SHOWN} at a time.
            </Text>
          )}
        </Stack>
      </Popover.Dropdown>
    </Popover>
  );
}

/** In the tool rail: what is done with several cameras. */
export function CameraTools() {
  const { run } = useAnnotating();
  const recording = useOpenRecording();
  const areLinesShown = useOption("areLinesShown");
  const { joints } = useTriangulation();
  if (recording.cameras.length < 2) return null;
  return (
    <>
      <Tool label="Triangulate into the other cameras" action="views.triangulate" icon={<IconTopologyStar3 size={18} />} isDisabled={!joints} onClick={() => run("views.triangulate")} />
      <Tool label="Epipolar lines" action="views.epipolar" icon={<IconVectorSpline size={18} />} isOn={areLinesShown} onClick={() => run("views.epipolar")} />
      <Tool label="Look at the joint in every picture" action="views.look" icon={<IconZoomInArea size={18} />} onClick={() => run("views.look")} />
    </>
  );
}

