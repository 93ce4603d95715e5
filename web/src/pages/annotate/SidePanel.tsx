import { useState } from "react";
import { PANELS } from "./mounts";
import classes from "./SidePanel.module.css";

/** The panels on the right, one at a time. */
export function SidePanel() {
  const [chosen, setChosen] = useState(PANELS[0]?.id);
  const panel = PANELS.find((one) => one.id === chosen) ?? PANELS[0];
  return (
    <aside className={classes.side} aria-label="Panels">
      {PANELS.length > 1 && (
        <div className={classes.tabs} role="tablist" aria-label="Panel">
          {PANELS.map(({ id, label }) => (
            <button key={id} type="button" role="tab" aria-selected={id === panel?.id} className={classes.tab} onClick={() => setChosen(id)}>
              {label}
            </button>
          ))}
        </div>
      )}
      {panel && <panel.Component />}
    </aside>
  );
}
