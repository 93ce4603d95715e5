import { Button } from "@mantine/core";
import { useCallback, useMemo, useRef, useState } from "react";
import { useSearchParams } from "react-router";
import { useKeymap } from "../../actions/useKeymap";
import { isActive } from "../../api/jobs";
import { useMovingJobs, useMovingRegistrations, type MovingScan } from "../../api/movingScans";
import { useStage } from "../../canvas/hand3d/useStage";
import { beginAt, endAt, nextDoubt, type Stretch } from "../../model/stretch";
import { hasRole, useMe } from "../../state/me";
import frames3d from "../hand3d/HandPage.module.css";
import { handHandlers, useLook } from "../hand3d/useLook";
import { Failure } from "../parts/Failure";
import { useLateAddress } from "../parts/useLateAddress";
import { usePlayback } from "../parts/usePlayback";
import { AcceptedPanel } from "./AcceptedPanel";
import { RegistrationFacts } from "./RegistrationFacts";
import { useChain } from "./useChain";
import { FramePanel } from "./FramePanel";
import classes from "./Moving.module.css";
import { MovingBar } from "./MovingBar";
import { MovingJob } from "./MovingJob";
import { MovingRail } from "./MovingRail";
import { MovingTimeline } from "./MovingTimeline";
import { MovingView } from "./MovingView";
import { RegisterMovingDialog } from "./RegisterMovingDialog";
import { StretchPanel } from "./StretchPanel";
import { useMovingCuration } from "./useMovingCuration";
import { useShownFrame } from "./useShownFrame";

/** The screen shows no more frames a second; faster scans leave some out. */
const SHOWN_FPS = 30;

/** One frame drives everything: the 3D view, the figures beside it and the timeline. */
export function MovingReview({ scan }: { scan: MovingScan }) {
  const [address] = useSearchParams();
  const jobs = useMovingJobs(scan.id).data ?? [];
  const isGrowing = jobs.some(isActive);
  const registrations = useMovingRegistrations(scan.id, isGrowing).data ?? [];
  const [chosen, setChosen] = useState<string | null>(() => address.get("registration"));
  const [jobShown, setJobShown] = useState<string | null>(() => address.get("job"));
  const registration =
    registrations.find((one) => one.id === chosen) ?? registrations.find((one) => one.job_id === jobShown) ?? registrations.find((one) => one.frames_done > 0) ?? registrations[0];
  const { own: registered, shown: bodies, found: foundOf } = useChain(scan.id, registration, registrations, isGrowing);

  const last = scan.frame_count - 1;
  const clamp = useCallback((at: number) => Math.min(last, Math.max(0, at)), [last]);
  const [frame, setFrame] = useState(() => clamp(Number(address.get("frame") ?? 0) || 0));
  const seek = useCallback((to: number) => setFrame(clamp(to)), [clamp]);
  const [picked, setStretch] = useState<Stretch | null>(null);
  const whole = useMemo<Stretch>(() => ({ first: registered[0]?.frame ?? 0, last: registered.at(-1)?.frame ?? last }), [registered, last]);
  const stretch = picked ?? whole;
  /** Where one would register again: the beginning of what was chosen, else the frame that is shown. */
  const here = picked?.first ?? frame;
  const [isPlaying, setPlaying] = useState(false);
  const [dialog, setDialog] = useState<"anew" | "again" | null>(null);

  const drawn = useRef("");
  const parts = useStage(drawn);
  const { stage } = parts;
  const control = useLook(stage);
  const pace = isPlaying ? Math.max(1, Math.round(scan.fps / SHOWN_FPS)) : 1;
  const shown = useShownFrame(stage, scan, bodies, frame, pace, drawn);
  usePlayback(isPlaying, scan.fps / pace, {
    isReady: () => shown.isDrawn,
    step: () => {
      seek(frame + pace);
      return frame + pace < last;
    },
    end: () => setPlaying(false),
  });
  const play = (): void => {
    if (!isPlaying && frame === last) seek(0);
    setPlaying(!isPlaying);
  };
  const step = (by: number): void => {
    setPlaying(false);
    seek(frame + by);
  };
  useLateAddress({ frame: String(frame), ...(registration ? { registration: registration.id } : {}) }, 200);

  const found = foundOf.get(frame);
  const foundIn = registrations.find((one) => one.id === bodies.get(frame));
  const all = useMemo(() => [...foundOf.values()].sort((a, b) => a.frame - b.frame), [foundOf]);
  const curation = useMovingCuration(scan.id, registration?.id);
  const mayDecide = hasRole(useMe(), "reviewer");
  const isInside = registered.length > 0 && stretch.first >= whole.first && stretch.last <= whole.last;
  const obstacle = registered.length === 0 ? "There is nothing to decide about yet: register the frames first." : isInside ? null : `Registered are frames ${whole.first} to ${whole.last}: choose among these.`;
  const decide = (decision: "accept" | "reject"): void => {
    if (mayDecide && obstacle === null) curation.decide(decision, stretch);
  };
  const show = (id: string, at: number): void => {
    setChosen(id);
    setStretch(null);
    step(at - frame);
  };
  const doubt = (direction: 1 | -1): void => {
    const next = nextDoubt(all, frame, direction);
    if (next !== null) step(next - frame);
  };
  const once = (act: () => void) => (event: KeyboardEvent): void => {
    if (!event.repeat) act();
  };
  useKeymap("moving", {
    ...handHandlers("moving", stage, control),
    undo: curation.undo,
    "moving.play": once(play),
    "moving.next": () => step(1),
    "moving.previous": () => step(-1),
    "moving.forward": () => step(10),
    "moving.backward": () => step(-10),
    "moving.first": () => step(-frame),
    "moving.last": () => step(last - frame),
    "moving.nextDoubt": () => doubt(1),
    "moving.previousDoubt": () => doubt(-1),
    "moving.begin": () => setStretch(beginAt(stretch, frame)),
    "moving.end": () => setStretch(endAt(stretch, frame)),
    "moving.accept": once(() => decide("accept")),
    "moving.reject": once(() => decide("reject")),
    "moving.undo": once(curation.undo),
    "moving.rerun": once(() => mayDecide && registered.length > 0 && setDialog("again")),
    "moving.whole": () => stage?.reset(),
    "moving.behind": () => stage?.lookFrom("back"),
  });

  const job = jobs.find(isActive) ?? jobs.find((one) => one.state !== "succeeded" && one.id === (registration?.job_id ?? jobs[0]?.id));
  return (
    <>
      <MovingBar
        scan={scan}
        registrations={registrations}
        registration={registration}
        onRegistration={(id) => (setChosen(id), setStretch(null))}
        frame={frame}
        isPlaying={isPlaying}
        hasDoubts={nextDoubt(all, frame, 1) !== null}
        onPlay={play}
        onStep={step}
        onDoubt={() => doubt(1)}
        onRegister={() => setDialog("anew")}
      />
      <div className={frames3d.middle}>
        <MovingRail control={control} hasMesh={found !== undefined} />
        <MovingView
          label={`Frame ${frame} of ${scan.name}`}
          parts={parts}
          isBusy={!shown.isDrawn}
          hasLegend={control.look.hasErrors && found !== undefined}
          guessed={found?.guessed ?? []}
          isUnusable={scan.problems.some((one) => one.frame === frame)}
          place={`frame ${frame}${foundIn ? ` · registration ${foundIn.number}` : ""}`}
          failure={
            shown.failure && (
              <Failure what={`Frame ${frame} could not be drawn`} error={shown.failure} safe="Go on with the next one; its file is kept." onRetry={shown.retry}>
                <Button onClick={() => step(1)}>Next frame</Button>
              </Failure>
            )
          }
        />
        <aside className={classes.panel} aria-label="Registration, decisions and what is accepted" tabIndex={0}>
          {job && <MovingJob job={job} />}
          <FramePanel scan={scan} frame={frame} found={found} foundIn={foundIn} registration={registration} />
          {registrations.length > 0 && (
            <StretchPanel
              stretch={stretch}
              most={last}
              onStretch={setStretch}
              onBegin={() => setStretch(beginAt(stretch, frame))}
              onEnd={() => setStretch(endAt(stretch, frame))}
              obstacle={obstacle}
              mayDecide={mayDecide}
              onDecide={decide}
              here={here}
              onRerun={() => setDialog("again")}
              canUndo={curation.canUndo}
              onUndo={curation.undo}
              decisions={curation.decisions}
              me={curation.me}
              onTakeBack={curation.takeBack}
              onSeek={(at) => step(at - frame)}
            />
          )}
          <AcceptedPanel scan={scan} onRegistration={show} />
          {registration && <RegistrationFacts registration={registration} parent={registrations.find((one) => one.id === registration.parent_id)} />}
        </aside>
      </div>
      <MovingTimeline scan={scan} frames={all} frame={frame} stretch={stretch} onSeek={(to) => step(to - frame)} />
      {dialog && (
        <RegisterMovingDialog
          scan={scan}
          parent={dialog === "again" ? (registration ?? null) : null}
          frames={dialog === "again" ? { first: here, last } : { first: 0, last }}
          onClose={() => setDialog(null)}
          onStarted={(id) => (setJobShown(id), setChosen(null), setStretch(null), setDialog(null))}
        />
      )}
    </>
  );
}
