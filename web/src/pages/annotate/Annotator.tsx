import { memo, useEffect, useLayoutEffect, useRef, useState } from "react";
import type { Recording } from "../../api/types";
import type { Session } from "../../state/session";
import { AnnotatingContext } from "./annotating";
import classes from "./Annotator.module.css";
import { AnnotatorAddress, AnnotatorKeys, AnnotatorPlayback } from "./AnnotatorKeys";
import { CameraKeys } from "./CameraKeys";
import { createAnnotating } from "./createAnnotating";
import { FrameBar } from "./FrameBar";
import { BARS, CARDS } from "./mounts";
import { Panes } from "./Panes";
import { SidePanel } from "./SidePanel";
import { StatusLine } from "./StatusLine";
import { Timeline } from "./Timeline";
import { ToolRail } from "./ToolRail";

interface AnnotatorProps {
  recording: Recording;
  session: Session;
  /** The blind replica that is marked, if one is. */
  replica: string | null;
}

/**
 * The annotator: the picture has the space, everything else stands around it, and nothing is modal. Drawn once for a recording;
 * its parts hear of what they show by themselves.
 */
export const Annotator = memo(function Annotator({ recording, session, replica }: AnnotatorProps) {
  const [annotating] = useState(() => createAnnotating(recording, session, replica, new URLSearchParams(window.location.search).get("cameras")?.split(",") ?? []));
  const middle = useRef<HTMLDivElement>(null);
  useEffect(() => annotating.start(), [annotating]);
  useLayoutEffect(() => annotating.recording.set(recording, "server"), [annotating, recording]);
  useEffect(() => {
    middle.current?.querySelector<HTMLElement>("[data-picture]")?.focus({ preventScroll: true });
  }, []);

  return (
    <AnnotatingContext value={annotating}>
      <AnnotatorKeys />
      <AnnotatorAddress />
      <AnnotatorPlayback />
      <CameraKeys />
      <div className={classes.page}>
        <h1 className="visually-hidden">Annotate {recording.name}</h1>
        <FrameBar />
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
    </AnnotatingContext>
  );
});
