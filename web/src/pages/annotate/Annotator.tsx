import { Button, Text } from "@mantine/core";
import { useCallback, useEffect, useMemo, useRef, useState } from "react";
import { useSearchParams } from "react-router";
import { annotatedFrames } from "../../actions/annotate/bring";
import { dragHand, dragJoint, endDrag } from "../../actions/annotate/move";
import { placeJoint } from "../../actions/annotate/place";
import { goToFrame, selectCamera, selectJoint, switchHand } from "../../actions/annotate/select";
import { cycleVisibility } from "../../actions/annotate/visibility";
import { useKeymap } from "../../actions/useKeymap";
import { useTrackFrames } from "../../api/tracks";
import type { Recording } from "../../api/types";
import { scaleRange, type DepthRange } from "../../canvas/depth";
import { FrameStrip } from "../../canvas/FrameStrip";
import { GhostShape, HandShape } from "../../canvas/HandShape";
import { jointAt } from "../../canvas/hit";
import { ImagePane, type PaneLayer } from "../../canvas/ImagePane";
import { usePictures } from "../../canvas/usePictures";
import type { View } from "../../canvas/view";
import { annotationRows } from "../../model/annotationRows";
import { HANDS, jointLabel } from "../../model/joints";
import { KEYMAP } from "../../model/keymap";
import { fromWire, keyText, parseKey, placedCount } from "../../model/pose";
import { trackRows } from "../../model/trackRows";
import { activeKey, activePose, type Action } from "../../state/annotator";
import { keepPlace } from "../../state/lastPlace";
import { createPointerStore } from "../../state/pointer";
import { settleConflict, type Session } from "../../state/session";
import { arrangementFor, arrangementsOf, clampFactor, useViewOptions } from "../../state/viewOptions";
import classes from "./Annotator.module.css";
import { ConflictCard } from "./ConflictCard";
import { FrameBar } from "./FrameBar";
import { JointsPanel } from "./JointsPanel";
import { StatusLine } from "./StatusLine";
import { ToolRail } from "./ToolRail";
import { annotateActions } from "./useAnnotateActions";
import { usePlayback } from "./usePlayback";
import { useAnnotatorState, useSaveStatus } from "./useSession";

interface AnnotatorProps {
  recording: Recording;
  session: Session;
}

/** The annotator: the picture has the space, everything else stands around it, and nothing is modal. */
export function Annotator({ recording, session }: AnnotatorProps) {
  const state = useAnnotatorState(session);
  const saving = useSaveStatus(session);
  const [options, setOptions] = useViewOptions();
  const [view, setView] = useState<View | null>(null);
  const [range, setRange] = useState<DepthRange | null>(null);
  const [isMagnified, setMagnified] = useState(false);
  const [pointer] = useState(createPointerStore);
  const [, setAddress] = useSearchParams();
  const frameField = useRef<HTMLInputElement>(null);
  const middle = useRef<HTMLDivElement>(null);

  const camera = recording.cameras.find((one) => one.id === state.camera) ?? recording.cameras[0];
  if (!camera) throw new Error("This recording has no camera.");
  const arrangement = arrangementFor(camera, options.arrangement);
  // Depth is fetched whenever there is any: the value under the cursor is wanted beside the colour image, too.
  const pictures = usePictures(recording, camera, state.frame, { color: arrangement !== "depth", depth: camera.has_depth }, range);
  const pose = activePose(state);
  const track = useTrackFrames(recording.best_track?.id).data;

  const act = useCallback(<I,>(action: Action<I>, input: I) => session.store.set(action(session.store.get(), input), "person"), [session]);
  const [isPlaying, setPlaying] = usePlayback(recording.fps, () => {
    const { frame, frameCount } = session.store.get();
    act(goToFrame, frame + 1);
    return frame + 1 < frameCount - 1;
  });

  useEffect(() => {
    const timer = setTimeout(() => {
      const address = new URLSearchParams({ camera: state.camera, frame: String(state.frame), hand: state.hand });
      setAddress(address, { replace: true });
      keepPlace(`/recordings/${recording.id}/annotate?${address}`);
    }, 120);
    return () => clearTimeout(timer);
  }, [state.camera, state.frame, state.hand, recording.id, setAddress]);

  useEffect(() => {
    setView(null);
    setRange(null);
  }, [camera.id]);

  useEffect(() => setView(null), [arrangement]);

  useEffect(() => {
    middle.current?.querySelector<HTMLElement>("[data-picture]")?.focus({ preventScroll: true });
  }, []);

  const actions = useMemo(() => annotateActions(session, recording), [session, recording]);
  const cycleArrangement = (): void => {
    const all = arrangementsOf(camera);
    setOptions({ arrangement: all[(all.indexOf(arrangement) + 1) % all.length] ?? "color" });
  };
  const contrast = (factor: number): void => {
    if (arrangement === "color" || !pictures.range) setOptions({ contrast: clampFactor(options.contrast * factor) });
    else setRange(scaleRange(pictures.range, 1 / factor));
  };
  const pageActions: Record<string, () => void> = {
    "frame.goto": () => frameField.current?.select(),
    play: () => setPlaying(!isPlaying),
    "view.fit": () => setView(null),
    "view.magnifier": () => setMagnified(true),
    "view.depth": cycleArrangement,
    "view.hands": () => setOptions({ areHandsShown: !options.areHandsShown }),
    "view.names": () => setOptions({ areNamesShown: !options.areNamesShown }),
    "view.brighter": () => setOptions({ brightness: clampFactor(options.brightness * 1.1) }),
    "view.darker": () => setOptions({ brightness: clampFactor(options.brightness / 1.1) }),
    "view.contrastUp": () => contrast(1.1),
    "view.contrastDown": () => contrast(1 / 1.1),
    "drag.cancel": () => {
      if (state.draft) actions["drag.cancel"]?.();
      else document.querySelector<HTMLElement>('[role="toolbar"] button')?.focus();
    },
  };
  const run = (id: string, repeats = 0): void => {
    const action = pageActions[id] ?? actions[id];
    action?.(repeats);
  };
  const repeats = useRef(0);
  const ids = KEYMAP.filter((binding) => binding.scope === "annotate" || binding.id === "undo" || binding.id === "redo").map((binding) => binding.id);
  useKeymap(
    "annotate",
    Object.fromEntries(
      ids.map((id) => [
        id,
        (event: KeyboardEvent) => {
          repeats.current = event.repeat ? repeats.current + 1 : 0;
          if (event.repeat && (id === "play" || id.startsWith("view.m"))) return;
          run(id, repeats.current);
        },
      ]),
    ),
  );
  useEffect(() => {
    const release = (event: KeyboardEvent): void => {
      if (event.key.toLowerCase() === "z") setMagnified(false);
    };
    const lose = (): void => setMagnified(false);
    window.addEventListener("keyup", release);
    window.addEventListener("blur", lose);
    return () => {
      window.removeEventListener("keyup", release);
      window.removeEventListener("blur", lose);
    };
  }, []);

  const trackStrip = useMemo(() => (track ? trackRows(track, recording.frame_count) : []), [track, recording.frame_count]);
  const rows = useMemo(
    () => [...annotationRows(state.poses, recording.frame_count, state.camera), ...trackStrip],
    [state.poses, recording.frame_count, state.camera, trackStrip],
  );
  const hereKey = keyText(activeKey(state));
  const theirs = saving.conflicts.get(hereKey);
  const refusals = [...saving.refusals];

  const drawHands = (shown: View) =>
    options.areHandsShown && (
      <>
        {HANDS.filter((hand) => hand !== state.hand).map((hand) => {
          const other = state.poses[keyText({ camera: state.camera, frame: state.frame, hand })];
          return other && <HandShape key={hand} pose={other} hand={hand} view={shown} active={-1} isFaint />;
        })}
        <HandShape pose={pose} hand={state.hand} view={shown} active={state.joint} areNamesShown={options.areNamesShown} />
        {theirs?.points && <GhostShape pose={fromWire(theirs.points)} view={shown} />}
      </>
    );

  const pane = (label: string, layers: readonly PaneLayer[]) => (
    <ImagePane
      key={label}
      label={`${label} of frame ${state.frame}, ${camera.id}. Next click places ${jointLabel(state.joint)}.`}
      camera={camera}
      layers={layers}
      view={view}
      onView={setView}
      brightness={options.brightness}
      contrast={options.contrast}
      pointer={pointer}
      cursorLabel={jointLabel(state.joint)}
      isMagnified={isMagnified}
      isBusy={pictures.isStale || layers.every((layer) => layer.picture === null)}
      hitJoint={(shown, screen) => (options.areHandsShown ? jointAt(pose, shown, screen, state.joint) : -1)}
      onPlace={(pixel) => act(placeJoint, pixel)}
      onSelect={(joint) => act(selectJoint, joint)}
      onDragJoint={(joint, to) => act(dragJoint, { joint, to })}
      onDragHand={(by) => act(dragHand, by)}
      onDragEnd={() => act(endDrag, undefined)}
      onCycle={(joint) => act(cycleVisibility, joint)}
      overlay={<span className={classes.paneLabel}>{label}</span>}
    >
      {drawHands}
    </ImagePane>
  );
  const color = { picture: pictures.color, opacity: 1 };
  const depth = { picture: pictures.depth, opacity: 1 };

  return (
    <div className={classes.page}>
      <FrameBar
        recording={recording}
        camera={camera.id}
        frame={state.frame}
        isPlaying={isPlaying}
        arrangement={arrangement}
        frameField={frameField}
        run={run}
        onFrame={(frame) => act(goToFrame, frame)}
        onCamera={(id) => act(selectCamera, id)}
        onArrangement={(next) => setOptions({ arrangement: next })}
      />
      <div className={classes.middle} ref={middle}>
        <ToolRail
          run={run}
          canUndo={session.undo.canUndo()}
          canRedo={session.undo.canRedo()}
          canBring={annotatedFrames(state, state.hand).some((frame) => frame < state.frame)}
          hasPose={placedCount(pose) > 0}
          hasSeveralPictures={arrangementsOf(camera).length > 1}
          options={options}
          onOptions={setOptions}
        />
        <div className={classes.panes}>
          {arrangement === "color" && pane("Colour", [color])}
          {arrangement === "depth" && pane("Depth", [depth])}
          {arrangement === "over" && pane("Depth over colour", [color, { ...depth, opacity: 0.55 }])}
          {arrangement === "side" && [pane("Colour", [color]), pane("Depth", [depth])]}
          <div className={classes.corner}>
            {[...saving.conflicts].map(([key, version]) => (
              <ConflictCard
                key={key}
                poseKey={key}
                mine={state.poses[key]}
                theirs={version}
                isHere={key === hereKey}
                onGo={() => session.store.set({ ...state, ...parseKey(key), draft: null }, "person")}
                onSettle={(choice) => settleConflict(session, key, choice)}
              />
            ))}
            {refusals.map(([key, reason]) => (
              <div key={key} className="card" style={{ padding: "12px 16px", width: 340 }} role="alert">
                <Text size="sm" fw={600}>
                  The server does not take the {parseKey(key).hand} hand of frame {parseKey(key).frame}
                </Text>
                <Text size="xs" my={8}>
                  {reason} Your version is kept in this browser; change it, or drop it.
                </Text>
                <Button size="xs" variant="default" onClick={() => session.queue.discard(key)}>
                  Drop my version
                </Button>
              </div>
            ))}
            {pictures.failure && (
              <div className="card" style={{ padding: "12px 16px", width: 340 }} role="alert">
                <Text size="sm" fw={600}>
                  The picture of frame {state.frame} could not be loaded
                </Text>
                <Text size="xs">{pictures.failure.message} Annotations are safe; go to another frame and back to try again.</Text>
              </div>
            )}
          </div>
        </div>
        <JointsPanel
          state={state}
          pose={pose}
          onHand={(hand) => hand !== state.hand && act(switchHand, undefined)}
          onJoint={(joint) => act(selectJoint, joint)}
        />
      </div>
      <div className={classes.timeline}>
        <FrameStrip rows={rows} frameCount={recording.frame_count} frame={state.frame} height={rows.length > 2 ? 48 : 32} label="Timeline" onSeek={(frame) => act(goToFrame, frame)} />
      </div>
      <StatusLine state={state} pose={pose} saving={saving} pointer={pointer} depth={pictures.depthImage} onFlush={() => session.queue.flush()} />
    </div>
  );
}
