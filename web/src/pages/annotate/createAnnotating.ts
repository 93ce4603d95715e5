/** The annotator's own state beside the session: what the page shows, and what is done when. No React. */

import { stepFrames } from "../../actions/annotate/select";
import { camerasTouched } from "../../actions/annotate/touched";
import type { Recording } from "../../api/types";
import type { Pictures } from "../../canvas/usePictures";
import type { Action } from "../../state/annotator";
import { keep, readKept } from "../../state/kept";
import { createHoverStore, createOverStore } from "../../state/pointer";
import type { Session } from "../../state/session";
import { createStore } from "../../state/store";
import { viewOptions } from "../../state/viewOptions";
import type { Actions, Annotating, PageState } from "./annotating";
import { annotateActions } from "./annotateActions";
import { pageActions } from "./pageActions";
import { arrangementOf } from "./reading";
import { createScreen } from "./screen";
import { createSeenSteps } from "./seenSteps";

const STEPS: ReadonlySet<string> = new Set(["frame.next", "frame.previous"]);

/** What changes something about the labels in view by itself, past the actions. */
const JUDGED: ReadonlySet<string> = new Set(["undo", "redo", "key.mark", "flag.dismiss"]);

/** Keys that mean something only when pressed, not when held; they wait for no picture. */
export const ONCE: ReadonlySet<string> = new Set(["play", "view.magnifier"]);

const BEGINNING: Omit<PageState, "wantedCameras"> = {
  views: {},
  range: null,
  isMagnified: false,
  isPlaying: false,
  isRefused: false,
  preview: null,
  lock: null,
  largeCamera: null,
};

const isNames = (found: unknown): found is string[] => Array.isArray(found) && found.every((one) => typeof one === "string");

/** `cameras` are those that the address asks for. */
export function createAnnotating(opened: Recording, session: Session, replica: string | null, cameras: readonly string[]): Annotating {
  const recording = createStore(opened);
  const remembered = readKept(`handloom/cameras/${opened.id}`);
  const page = createStore<PageState>({ ...BEGINNING, wantedCameras: [cameras, isNames(remembered) ? remembered : []] });
  const options = viewOptions();
  const pictures = createStore<Pictures | null>(null);
  const screen = createScreen();
  let others: (() => Actions)[] = [];

  const show = (change: Partial<PageState>): void => page.set({ ...page.get(), ...change }, "person");
  const refuse = (): void => show({ isRefused: true });

  /** Whether these cameras' pictures of the frame are on the screen and stand still; a person whose action has no effect is told so. */
  const areSeen = (names: Iterable<string>): boolean => {
    const { frame } = session.store.get();
    const isShown = [...names].every((one) => screen.shows(one, frame));
    if (!isShown) refuse();
    return isShown && !page.get().isPlaying;
  };

  const act = <I>(action: Action<I>, input: I): boolean => {
    const before = session.store.get();
    const next = action(before, input);
    if (next === before) return false;
    const touched = camerasTouched(before, next);
    const isTaken = touched.size === 0 || (page.get().lock === null && areSeen(touched));
    // A drag that may not end here is cancelled.
    if (isTaken || before.draft) session.store.set(isTaken ? next : { ...before, draft: null }, "person");
    return isTaken;
  };

  const isDrawn = (): boolean => {
    const { camera, frame } = session.store.get();
    const now = pictures.get();
    // A frame without any picture is never drawn.
    const isBlank = now !== null && !now.isStale && now.color === null && now.depth === null;
    return (now !== null && now.setback !== null) || isBlank || screen.shows(camera, frame);
  };
  const steps = createSeenSteps((by) => act(stepFrames, by), isDrawn);

  const run = (id: string, repeats = 0): void => {
    if (!STEPS.has(id)) steps.flush();
    if (page.get().lock !== null && (id === "undo" || id === "redo")) return;
    if (JUDGED.has(id) && !areSeen([session.store.get().camera])) return;
    annotating.answerTo(id)?.(repeats);
  };

  const annotating: Annotating = {
    recording,
    replica,
    session,
    page,
    options,
    pictures,
    hover: createHoverStore(),
    over: createOverStore(),
    sizes: new Map(),
    show,
    setOptions: (change) => options.set({ ...options.get(), ...change }, "person"),
    setView: (camera, view) => show({ views: { ...page.get().views, [camera]: view } }),
    showCameras(names) {
      if (names.length === 0) return;
      keep(`handloom/cameras/${opened.id}`, names);
      show({ wantedCameras: [names] });
    },
    noteDrawn(pane, camera, frame) {
      screen.note(pane, camera, frame);
      if (frame === session.store.get().frame && page.get().isRefused) show({ isRefused: false });
      // Behind the drawing that this is said from; what changes now is drawn for the refresh after it.
      queueMicrotask(steps.drawn);
    },
    refuse,
    act,
    answerTo: (id) => others.map((part) => part()[id]).find(Boolean) ?? own[id],
    run,
    press(id, repeats) {
      const isHere = pictures.get()?.isStale === false;
      if (STEPS.has(id) || ONCE.has(id) || !isHere || isDrawn()) run(id, repeats);
      else steps.whenDrawn(() => run(id, repeats));
    },
    register(actions) {
      others = [actions, ...others];
      return () => {
        others = others.filter((one) => one !== actions);
      };
    },
    start() {
      let arrangement = arrangementOf(annotating);
      const rearrange = (): void => {
        const now = arrangementOf(annotating);
        if (now !== arrangement) show({ views: {} });
        arrangement = now;
      };
      const stops = [
        session.store.watch((now, before) => {
          const isCameraNew = now.camera !== before.camera;
          const isImageNew = isCameraNew || now.frame !== before.frame;
          if (isImageNew || now.hand !== before.hand) show({ preview: null, isRefused: isImageNew ? false : page.get().isRefused, range: isCameraNew ? null : page.get().range });
          if (isCameraNew) rearrange();
        }),
        options.watch(rearrange),
        // What waits for a picture that does not come goes on.
        pictures.watch((now, before) => now?.setback && now.setback !== before?.setback && queueMicrotask(steps.drawn)),
        steps.flush,
      ];
      return () => stops.forEach((stop) => stop());
    },
  };
  const own: Actions = { ...annotateActions(annotating), ...pageActions(annotating, steps) };
  return annotating;
}
