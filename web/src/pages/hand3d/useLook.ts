import { useLocalStorage } from "@mantine/hooks";
import { FIRST_LOOK, type Layers, type Look, type ViewSide } from "../../canvas/hand3d/look";
import type { Stage } from "../../canvas/hand3d/stage";
import type { Handlers } from "../../actions/useKeymap";
import { useEffect, useState } from "react";

const LAYERS: readonly Layers[] = ["both", "scan", "mesh"];

export interface LookControl {
  readonly look: Look;
  /** What of it can be changed here; a scan without a mesh has neither errors nor wires. */
  change: (patch: Partial<Look>) => void;
  nextLayers: () => void;
}

/** How a person wants to see hands, on every page and after a reload; the turntable stands still at first. */
export function useLook(stage: Stage | null): LookControl {
  const [kept, setKept] = useLocalStorage<Partial<Look>>({ key: "handloom/hand-look", defaultValue: {}, getInitialValueInEffect: false });
  const [isTurning, setTurning] = useState(false);
  const look: Look = { ...FIRST_LOOK, ...kept, isTurning };
  const { layers, hasErrors, hasWireframe, hasCorrespondences } = look;
  useEffect(() => {
    stage?.setLook({ layers, hasErrors, hasWireframe, hasCorrespondences, isTurning });
  }, [stage, layers, hasErrors, hasWireframe, hasCorrespondences, isTurning]);
  return {
    look,
    change({ isTurning: turns, ...others }) {
      if (turns !== undefined) setTurning(turns);
      if (Object.keys(others).length > 0) setKept({ layers, hasErrors, hasWireframe, hasCorrespondences, ...others });
    },
    nextLayers: () => setKept({ layers: LAYERS[(LAYERS.indexOf(layers) + 1) % LAYERS.length] ?? "both", hasErrors, hasWireframe, hasCorrespondences }),
  };
}

const TURN_DEG = 15;
const SIDES: readonly ViewSide[] = ["back", "thumb", "little"];

/** What the keys of a hand in 3D do. */
export function handHandlers(scope: "curate" | "scan" | "moving", stage: Stage | null, { look, change, nextLayers }: LookControl): Handlers {
  const named: Handlers = {
    errors: () => change({ hasErrors: !look.hasErrors }),
    wireframe: () => change({ hasWireframe: !look.hasWireframe }),
    layers: nextLayers,
    correspondences: () => change({ hasCorrespondences: !look.hasCorrespondences }),
    turntable: () => change({ isTurning: !look.isTurning }),
    palm: () => stage?.reset(),
    ...Object.fromEntries(SIDES.map((side) => [side, () => stage?.lookFrom(side)])),
    turnLeft: () => stage?.orbit(-TURN_DEG, 0),
    turnRight: () => stage?.orbit(TURN_DEG, 0),
    turnUp: () => stage?.orbit(0, TURN_DEG),
    turnDown: () => stage?.orbit(0, -TURN_DEG),
    nearer: () => stage?.zoom(1.2),
    farther: () => stage?.zoom(1 / 1.2),
    leave: () => document.querySelector<HTMLElement>('[role="toolbar"] button')?.focus(),
  };
  return Object.fromEntries(Object.entries(named).map(([name, act]) => [`${scope}.${name}`, act]));
}
