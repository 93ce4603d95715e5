import { memo, useDeferredValue, useEffect, useRef, type ComponentType, type ReactNode } from "react";
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
import { useUnhurried } from "./useUnhurried";

interface AnnotatorProps {
  recording: Recording;
  session: Session;
}

/** A part whose properties never change: it is drawn again only for what it reads itself. */
const Steady = memo(function Steady({ of: Part }: { of: ComponentType }) {
  return <Part />;
});

const SteadyFrameBar = memo(FrameBar);

/** The annotator: the picture has the space, everything else stands around it, and nothing is modal. */
export function Annotator({ recording, session }: AnnotatorProps) {
  const frameField = useRef<HTMLInputElement>(null);
  const middle = useRef<HTMLDivElement>(null);
  const annotating = useAnnotatorParts(recording, session, frameField);
  // The picture comes first: while somebody scrubs, what stands around it follows when there is time.
  const later = useDeferredValue(useUnhurried(annotating));
  const around = (parts: ReactNode): ReactNode => <AnnotatingContext value={later}>{parts}</AnnotatingContext>;

  useEffect(() => {
    middle.current?.querySelector<HTMLElement>("[data-picture]")?.focus({ preventScroll: true });
  }, []);

  return (
    <AnnotatingContext value={annotating}>
      <CamerasProvider>
        <div className={classes.page}>
          {around(
            <>
              <SteadyFrameBar frameField={frameField} />
              {BARS.map((Bar, index) => (
                <Steady key={index} of={Bar} />
              ))}
            </>,
          )}
          <div className={classes.middle} ref={middle}>
            {around(<Steady of={ToolRail} />)}
            <div className={classes.panes}>
              <Panes />
              <div className={classes.corner}>
                {around(
                  CARDS.map((Card, index) => <Steady key={index} of={Card} />),
                )}
              </div>
            </div>
            {around(<Steady of={SidePanel} />)}
          </div>
          {around(<Steady of={Timeline} />)}
          <StatusLine />
        </div>
      </CamerasProvider>
    </AnnotatingContext>
  );
}
