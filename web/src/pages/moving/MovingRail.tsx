import { IconGridDots, IconRotate360, IconStack2, IconTemperature } from "@tabler/icons-react";
import view from "../hand3d/HandView.module.css";
import type { LookControl } from "../hand3d/useLook";
import { Tool } from "../parts/Tool";

const NAMES = { both: "Scan and body", scan: "Scan only", mesh: "Body only" } as const;

/** How a frame is drawn, as buttons; each hint says its key. */
export function MovingRail({ control: { look, change, nextLayers }, hasMesh }: { control: LookControl; hasMesh: boolean }) {
  return (
    <div className={view.rail} role="toolbar" aria-label="View" aria-orientation="vertical">
      <Tool label={`${NAMES[look.layers]}; next: another`} action="moving.layers" icon={<IconStack2 size={18} />} isOn={look.layers !== "both"} isDisabled={!hasMesh} onClick={nextLayers} />
      <Tool label="Error colours" action="moving.errors" icon={<IconTemperature size={18} />} isOn={look.hasErrors} isDisabled={!hasMesh} onClick={() => change({ hasErrors: !look.hasErrors })} />
      <Tool label="Wireframe" action="moving.wireframe" icon={<IconGridDots size={18} />} isOn={look.hasWireframe} isDisabled={!hasMesh} onClick={() => change({ hasWireframe: !look.hasWireframe })} />
      <Tool label="Turntable" action="moving.turntable" icon={<IconRotate360 size={18} />} isOn={look.isTurning} onClick={() => change({ isTurning: !look.isTurning })} />
    </div>
  );
}
