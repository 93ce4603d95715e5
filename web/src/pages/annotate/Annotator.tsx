import { useEffect, useRef } from "react";
import type { Recording } from "../../api/types";
import type { Session } from "../../state/session";
import { AnnotatingContext } from "./annotating";
import classes from "./Annotator.module.css";
import { FrameBar } from "./FrameBar";
import { CamerasProvider } from "./CamerasProvider";
import { BARS, CARDS } from "./mounts";
import { Panes } from "./Panes";
import { SidePanel } from "./SidePanel";
import { StatusLine } from "./StatusLine";
import { Timeline } from "./Timeline";
import { ToolRail } from "./ToolRail";
import { useAnnotatorParts } from "./useAnnotatorParts";

interface AnnotatorProps {
  recording: Recording;
  session: Session;
}

/** The annotator: the picture has the space, everything else stands around it, and nothing is modal. */
export function Annotator({ recording, session }: AnnotatorProps) {
  const frameField = useRef<HTMLInputElement>(null);
  const middle = useRef<HTMLDivElement>(null);
  const annotating = useAnnotatorParts(recording, session, frameField);

  useEffect(() => {
    middle.current?.querySelector<HTMLElement>("[data-picture]")?.focus({ preventScroll: true });
  }, []);

  return (
    <AnnotatingContext value={annotating}>
      <CamerasProvider>
        <div className={classes.page}>
          <FrameBar frameField={frameField} />
          {BARS.map((Bar, index) => (
            <Bar key={index} />
          ))}
          <div className={classes.middle} ref={middle}>
            <ToolRail />
            <div className={classes.panes}>
              <Panes />
              <div className={classes.corner}>
                {CARDS.map((Card, index) => (
                  <Card key={index} />
                ))}
              </div>
            </div>
            <SidePanel />
          </div>
          <Timeline />
          <StatusLine />
        </div>
      </CamerasProvider>
    </AnnotatingContext>
  );
}
