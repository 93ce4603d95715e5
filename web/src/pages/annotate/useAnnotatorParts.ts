/** The annotator's own state beside the session: pictures, views, keys, playback. */

import { useCallback, useEffect, useMemo, useRef, useState, type RefObject } from "react";
import { PLACE_MODES } from "../../actions/annotate/place";
import { stepFrames } from "../../actions/annotate/select";
import { camerasTouched } from "../../actions/annotate/touched";
import { useKeymap } from "../../actions/useKeymap";
import type { Recording } from "../../api/types";
import { scaleRange, type DepthRange } from "../../canvas/depth";
import { usePictures } from "../../canvas/usePictures";
import type { View } from "../../canvas/view";
import { KEYMAP } from "../../model/keymap";
import type { Pose } from "../../model/pose";
import { activePose, type Action } from "../../state/annotator";
import { keepPlace } from "../../state/lastPlace";
import { createHoverStore, createOverStore, pointerOn } from "../../state/pointer";
import type { Session } from "../../state/session";
import { arrangementFor, arrangementsOf, clampFactor, useViewOptions } from "../../state/viewOptions";
import { useLateAddress } from "../parts/useLateAddress";
import type { Actions, Annotating } from "./annotating";
import { createScreen } from "./screen";
import { annotateActions, stepFor } from "./useAnnotateActions";
import { usePlayback } from "./usePlayback";
import { useSeenSteps } from "./useSeenSteps";
import { useAnnotatorState, useSaveStatus } from "./useSession";

const KEYS = KEYMAP.filter((binding) => binding.scope === "annotate" || binding.id === "undo" || binding.id === "redo").map((binding) => binding.id);

const STEPS: ReadonlySet<string> = new Set(["frame.next", "frame.previous"]);

/** What changes something about the labels in view by itself, past the actions. */
const JUDGED: ReadonlySet<string> = new Set(["undo", "redo", "key.mark", "flag.dismiss"]);

/** Keys that mean something only when pressed, not when held. */
const ONCE: ReadonlySet<string> = new Set(["play", "view.magnifier"]);

export function useAnnotatorParts(recording: Recording, session: Session, frameField: RefObject<HTMLInputElement | null>): Annotating {
  const state = useAnnotatorState(session);
  const saving = useSaveStatus(session);
  const [options, setOptions] = useViewOptions();
  const [views, setViews] = useState<Readonly<Record<string, View | null>>>({});
  const [range, setRange] = useState<DepthRange | null>(null);
  const [isMagnified, setMagnified] = useState(false);
  const [preview, setPreview] = useState<Pose | null>(null);
  const [lock, setLock] = useState<string | null>(null);
  const [hover] = useState(createHoverStore);
  const [over] = useState(createOverStore);

  const camera = recording.cameras.find((one) => one.id === state.camera) ?? recording.cameras[0];
  if (!camera) throw new Error("This recording has no camera.");
  const pointer = useMemo(() => pointerOn(hover, camera.id), [hover, camera.id]);
  const arrangement = arrangementFor(camera, options.arrangement);
  // Depth is large: it is fetched where it is seen, and its values are known there.
  const pictures = usePictures(recording, camera, state.frame, { color: arrangement !== "depth", depth: arrangement !== "color", palette: options.palette }, range);

  const [screen] = useState(createScreen);
  const [isRefused, setRefused] = useState(false);
  const isLocked = useRef(false);
  isLocked.current = lock !== null;
  const isRunning = useRef(false);
  const refuse = useCallback(() => setRefused(true), []);
  /** Whether these cameras' pictures of the frame are on the screen and stand still; who acts in vain is told. */
  const areSeen = useCallback(
    (cameras: Iterable<string>): boolean => {
      const { frame } = session.store.get();
      const isShown = [...cameras].every((one) => screen.shows(one, frame));
      if (!isShown) refuse();
      return isShown && !isRunning.current;
    },
    [session, screen, refuse],
  );
  const act = useCallback(
    <I>(action: Action<I>, input: I): boolean => {
      const before = session.store.get();
      const next = action(before, input);
      if (next === before) return false;
      const touched = camerasTouched(before, next);
      const isTaken = touched.size === 0 || (!isLocked.current && areSeen(touched));
      // A drag that may not end here is called off.
      if (isTaken || before.draft) session.store.set(isTaken ? next : { ...before, draft: null }, "person");
      return isTaken;
    },
    [session, areSeen],
  );
  const [isPlaying, setPlaying] = usePlayback(recording.fps, {
    // Playing waits for a picture rather than leave one out.
    isReady: () => !pictures.isStale,
    step: () => {
      act(stepFrames, 1);
      const { frame, frames, frameCount } = session.store.get();
      return frame < (frames?.at(-1) ?? frameCount - 1);
    },
  });
  isRunning.current = isPlaying;

  /** Of this frame nothing will be drawn: it has no picture. */
  const isBlank = !pictures.isStale && pictures.color === null && pictures.depth === null;
  const isDrawn = (): boolean => {
    const { camera: active, frame } = session.store.get();
    return pictures.setback !== null || isBlank || screen.shows(active, frame);
  };
  const steps = useSeenSteps((by) => act(stepFrames, by), isDrawn);
  const noteDrawn = useCallback(
    (pane: string, id: string, frame: number | null) => {
      screen.note(pane, id, frame);
      if (frame === session.store.get().frame) setRefused(false);
      // Behind the drawing that this is said from; what changes now is drawn for the refresh after it.
      queueMicrotask(steps.drawn);
    },
    [session, screen, steps],
  );
  useEffect(() => {
    if (pictures.setback) steps.drawn();
  }, [pictures.setback, steps]);
  useEffect(() => setRefused(false), [state.frame, state.camera]);

  useLateAddress({ camera: state.camera, frame: String(state.frame), hand: state.hand }, 120, keepPlace);

  useEffect(() => setRange(null), [camera.id]);
  useEffect(() => setViews({}), [arrangement]);
  useEffect(() => setPreview(null), [state.camera, state.frame, state.hand]);

  const setView = useCallback((id: string, view: View | null) => setViews((now) => ({ ...now, [id]: view })), []);

  const others = useRef<(() => Actions)[]>([]);
  const register = useCallback((actions: () => Actions) => {
    others.current = [actions, ...others.current];
    return () => {
      others.current = others.current.filter((one) => one !== actions);
    };
  }, []);

  const actions = useMemo(() => annotateActions(session, recording, act), [session, recording, act]);
  const contrast = (factor: number): void => {
    if (arrangement === "color" || !pictures.range) setOptions({ contrast: clampFactor(options.contrast * factor) });
    else setRange(scaleRange(pictures.range, 1 / factor));
  };
  const pageActions: Actions = {
    "frame.next": (repeats = 0) => steps.step(stepFor(repeats)),
    "frame.previous": (repeats = 0) => steps.step(-stepFor(repeats)),
    "frame.goto": () => frameField.current?.select(),
    play: () => setPlaying(!isPlaying),
    "view.fit": () => setViews({}),
    "view.magnifier": () => setMagnified(true),
    "view.depth": () => {
      const all = arrangementsOf(camera);
      setOptions({ arrangement: all[(all.indexOf(arrangement) + 1) % all.length] ?? "color" });
    },
    "place.mode": () => setOptions({ placeMode: PLACE_MODES[(PLACE_MODES.indexOf(options.placeMode) + 1) % PLACE_MODES.length] ?? "joint" }),
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
  const answers = useRef<(id: string) => ((repeats?: number) => void) | undefined>(() => undefined);
  answers.current = (id) => others.current.map((part) => part()[id]).find(Boolean) ?? pageActions[id] ?? actions[id];
  const run = useCallback((id: string, repeats = 0) => {
    if (!STEPS.has(id)) steps.flush();
    if (isLocked.current && (id === "undo" || id === "redo")) return;
    if (JUDGED.has(id) && !areSeen([session.store.get().camera])) return;
    answers.current(id)?.(repeats);
  }, [steps, session, areSeen]);

  const repeats = useRef(0);
  const held = useRef<string | null>(null);
  const answer = (id: string) => (event: KeyboardEvent) => {
    repeats.current = event.repeat ? repeats.current + 1 : 0;
    if (id === "view.magnifier") held.current = event.code;
    if (event.repeat && ONCE.has(id)) return;
    const press = (): void => run(id, repeats.current);
    // What comes right behind a step finds that step's picture drawn, if it is here already.
    if (STEPS.has(id) || ONCE.has(id) || pictures.isStale || isDrawn()) press();
    else steps.whenDrawn(press);
  };
  useKeymap("annotate", Object.fromEntries(KEYS.flatMap((id) => (answers.current(id) ? [[id, answer(id)]] : []))));
  useEffect(() => {
    const release = (event: KeyboardEvent): void => {
      if (event.code === held.current) setMagnified(false);
    };
    const lose = (): void => setMagnified(false);
    window.addEventListener("keyup", release);
    window.addEventListener("blur", lose);
    return () => {
      window.removeEventListener("keyup", release);
      window.removeEventListener("blur", lose);
    };
  }, []);

  return {
    recording,
    session,
    state,
    camera,
    pose: activePose(state),
    saving,
    pictures,
    range,
    setRange,
    arrangement,
    options,
    setOptions,
    viewOf: (id) => views[id] ?? null,
    setView,
    noteDrawn,
    isRefused,
    refuse,
    pointer,
    hover,
    over,
    isMagnified,
    isPlaying,
    preview,
    setPreview,
    lock,
    setLock,
    act,
    run,
    register,
  };
}
