import { IconGridDots, IconLine, IconRotate360, IconStack2, IconTemperature } from "@tabler/icons-react";
import type { ReactNode } from "react";
import { Tool } from "../parts/Tool";
import classes from "./HandView.module.css";
import type { LookControl } from "./useLook";

interface HandRailProps {
  scope: "curate" | "scan";
  control: LookControl;
  /** Without a registered mesh there is nothing to compare with. */
  hasMesh: boolean;
  children?: ReactNode;
}

const NAMES = { both: "Scan and mesh", scan: "Scan only", mesh: "Mesh only" } as const;

/** How the hand is drawn, as buttons; each hint says its key. */
export function HandRail({ scope, control: { look, change, nextLayers }, hasMesh, children }: HandRailProps) {
  return (
    <div className={classes.rail} role="toolbar" aria-label="View" aria-orientation="vertical">
      {children}
      <Tool label={`${NAMES[look.layers]}; next: another`} action={`${scope}.layers`} icon={<IconStack2 size={18} />} isOn={look.layers !== "both"} isDisabled={!hasMesh} onClick={nextLayers} />
      <Tool label="Error colours" action={`${scope}.errors`} icon={<IconTemperature size={18} />} isOn={look.hasErrors} isDisabled={!hasMesh} onClick={() => change({ hasErrors: !look.hasErrors })} />
      <Tool label="Wireframe" action={`${scope}.wireframe`} icon={<IconGridDots size={18} />} isOn={look.hasWireframe} isDisabled={!hasMesh} onClick={() => change({ hasWireframe: !look.hasWireframe })} />
      <Tool label="Lines from the scan to the mesh" action={`${scope}.correspondences`} icon={<IconLine size={18} />} isOn={look.hasCorrespondences} isDisabled={!hasMesh} onClick={() => change({ hasCorrespondences: !look.hasCorrespondences })} />
      <Tool label="Turntable" action={`${scope}.turntable`} icon={<IconRotate360 size={18} />} isOn={look.isTurning} onClick={() => change({ isTurning: !look.isTurning })} />
    </div>
  );
}
