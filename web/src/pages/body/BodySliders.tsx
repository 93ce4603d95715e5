import { Button, Group, Stack, Tabs } from "@mantine/core";
import { AT_REST, BODY_SLIDERS, HAND_SLIDERS, type BodySetting } from "../../model/bodyPose";
import classes from "./BodyPage.module.css";
import { LabelledSlider } from "./LabelledSlider";

/** More directions of shape than anybody turns by hand. */
const SHAPE_SLIDERS = 10;

interface BodySlidersProps {
  shape: readonly number[];
  onShape: (shape: number[]) => void;
  setting: BodySetting;
  onSetting: (setting: BodySetting) => void;
}

const withValue = (values: readonly number[], count: number, at: number, value: number): number[] =>
  Array.from({ length: count }, (_, other) => (other === at ? value : (values[other] ?? 0)));

/** Whose body it is, and how it stands. */
export function BodySliders({ shape, onShape, setting, onSetting }: BodySlidersProps) {
  const components = (values: readonly number[], count: number, name: string, onValues: (values: number[]) => void) =>
    Array.from({ length: count }, (_, at) => (
      <LabelledSlider key={at} label={`${name} ${at + 1}`} unit="sd" least={-3} most={3} step={0.1} value={values[at] ?? 0} onChange={(value) => onValues(withValue(values, count, at, value))} />
    ));
  const reset = (label: string, isSet: boolean, onReset: () => void) => (
    <Group justify="flex-end">
      <Button size="compact-xs" variant="subtle" disabled={!isSet} onClick={onReset}>
        {label}
      </Button>
    </Group>
  );
  const isSet = (values: readonly number[]): boolean => values.some((value) => value !== 0);
  return (
    <Tabs defaultValue="body" className={classes.sliders} keepMounted={false}>
      <Tabs.List grow>
        <Tabs.Tab value="body">Pose</Tabs.Tab>
        <Tabs.Tab value="left">Left hand</Tabs.Tab>
        <Tabs.Tab value="right">Right hand</Tabs.Tab>
        <Tabs.Tab value="shape">Shape</Tabs.Tab>
      </Tabs.List>
      <Tabs.Panel value="body" className={classes.panel}>
        <Stack gap="sm">
          {reset("T-pose", Object.values(setting.angles).some((value) => value !== 0), () => onSetting({ ...setting, angles: AT_REST.angles }))}
          {BODY_SLIDERS.map(({ key, label, least, most }) => (
            <LabelledSlider key={key} label={label} unit="°" least={least} most={most} step={1} value={setting.angles[key] ?? 0} onChange={(value) => onSetting({ ...setting, angles: { ...setting.angles, [key]: value } })} />
          ))}
        </Stack>
      </Tabs.Panel>
      {(["left", "right"] as const).map((side) => (
        <Tabs.Panel key={side} value={side} className={classes.panel}>
          <Stack gap="sm">
            {reset("Mean pose", isSet(setting[side]), () => onSetting({ ...setting, [side]: [] }))}
            {components(setting[side], HAND_SLIDERS, "Component", (values) => onSetting({ ...setting, [side]: values }))}
          </Stack>
        </Tabs.Panel>
      ))}
      <Tabs.Panel value="shape" className={classes.panel}>
        <Stack gap="sm">
          {reset("Mean person", isSet(shape), () => onShape([]))}
          {components(shape, SHAPE_SLIDERS, "Component", onShape)}
        </Stack>
      </Tabs.Panel>
    </Tabs>
  );
}
