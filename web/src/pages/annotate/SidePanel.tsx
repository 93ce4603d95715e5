import { useState } from "react";
import { useIsCompact } from "../parts/useScreen";
import { PANELS } from "./mounts";
import classes from "./SidePanel.module.css";

/** The panels on the right, one at a time. */
export function SidePanel() {
  const isCompact = useIsCompact();
  const [chosen, setChosen] = useState<string | undefined>(isCompact ? undefined : PANELS[0]?.id);
  // On a small screen the picture has the space until somebody opens a panel.
  const panel = PANELS.find((one) => one.id === chosen) ?? (isCompact ? undefined : PANELS[0]);
  return (
    <aside className={classes.side} aria-label="Panels">
      {PANELS.length > 1 && (
        <div className={classes.tabs} role="tablist" aria-label="Panel">
          {PANELS.map(({ id, label }) => (
            <button key={id} type="button" role="tab" aria-selected={id === panel?.id} className={classes.tab} onClick={() => setChosen(isCompact && id === chosen ? undefined : id)}>
              {label}
            </button>
          ))}
        </div>
      )}
      {panel && <panel.Component />}
    </aside>
  );
}
