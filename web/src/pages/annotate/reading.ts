/** How the annotator's parts read its state: each hook draws its component again only when what it answers is another. */

import { useMemo } from "react";
import type { Camera, Recording } from "../../api/types";
import type { Pictures } from "../../canvas/usePictures";
import type { Pose } from "../../model/pose";
import { activePose, poseIn, type AnnotatorState } from "../../state/annotator";
import type { KeyFrames } from "../../state/keyFrames";
import type { SaveStatus } from "../../state/saveQueue";
import { chooseShown } from "../../state/shownCameras";
import type { SuggestionsState } from "../../state/suggestions";
import { sameList, useSelect, useStore } from "../../state/useStore";
import { arrangementFor, type Arrangement, type ViewOptions } from "../../state/viewOptions";
import { useAnnotating, type Annotating, type PageState } from "./annotating";

type Same<T> = (a: T, b: T) => boolean;

/** Of the labels and where the person is. */
export const useAnnotation = <T>(select: (state: AnnotatorState) => T, isSame?: Same<T>): T => useSelect(useAnnotating().session.store, select, isSame);

/** Of what the page shows. */
export const usePage = <T>(select: (page: PageState) => T): T => useSelect(useAnnotating().page, select);

export const useOption = <K extends keyof ViewOptions>(name: K): ViewOptions[K] => useSelect(useAnnotating().options, (options) => options[name]);

/** Of what is saved, and what waits. */
export function useSaving<T>(select: (status: SaveStatus) => T, isSame?: Same<T>): T {
  const { session } = useAnnotating();
  const store = useMemo(() => ({ get: session.saving, watch: session.watchSaving }), [session]);
  return useSelect(store, select, isSame);
}

export const useSuggestions = <T>(select: (state: SuggestionsState) => T, isSame?: Same<T>): T => useSelect(useAnnotating().session.suggestions, select, isSame);

export const useKeyFrames = <T>(select: (keys: KeyFrames) => T): T => useSelect(useAnnotating().session.keyFrames.store, select);

/** Of the pictures of the active camera and frame. */
export const usePicturesHere = <T>(select: (pictures: Pictures | null) => T): T => useSelect(useAnnotating().pictures, select);

/** Whether this is a blind version of the labels: nothing is said there of others' labels or by machines, for people are compared. */
export const useIsBlind = (): boolean => useAnnotating().replica !== null;

export const useOpenRecording = (): Recording => useStore(useAnnotating().recording);

const cameraNamed = ({ cameras }: Recording, name: string): Camera => {
  const found = cameras.find((one) => one.id === name) ?? cameras[0];
  if (!found) throw new Error("This recording has no camera.");
  return found;
};

/** The active camera. */
export const useCamera = (): Camera => cameraNamed(useOpenRecording(), useAnnotation((state) => state.camera));

export const cameraOf = ({ recording, session }: Annotating): Camera => cameraNamed(recording.get(), session.store.get().camera);

/** How the active camera's pictures stand beside each other. */
export const useArrangement = (): Arrangement => arrangementFor(useCamera(), useOption("arrangement"));

export const arrangementOf = (annotating: Annotating): Arrangement => arrangementFor(cameraOf(annotating), annotating.options.get().arrangement);

/** The active hand as it is to be drawn. */
export const usePose = (): Pose => useAnnotation(activePose);

/** The active hand in a camera's picture of this frame. */
export const usePoseIn = (camera: string): Pose => useAnnotation((state) => poseIn(state, camera));

const shownNames = (recording: Recording, page: PageState, active: string): string[] =>
  chooseShown(
    recording.cameras.map(({ id }) => id),
    page.wantedCameras,
    active,
  );

/** The cameras whose pictures are shown, in the recording's order; the active one is among them. */
export function useShownCameras(): readonly Camera[] {
  const recording = useOpenRecording();
  const active = useAnnotation((state) => state.camera);
  const names = useSelect(useAnnotating().page, (page) => shownNames(recording, page, active), sameList);
  return useMemo(() => recording.cameras.filter(({ id }) => names.includes(id)), [recording, names]);
}

export function shownCamerasOf({ recording, page, session }: Annotating): readonly Camera[] {
  const names = shownNames(recording.get(), page.get(), session.store.get().camera);
  return recording.get().cameras.filter(({ id }) => names.includes(id));
}

/** The camera whose picture is enlarged, if it is shown. */
export function useLargeCamera(): string | null {
  const shown = useShownCameras();
  const large = usePage((page) => page.largeCamera);
  return shown.some(({ id }) => id === large) ? large : null;
}
