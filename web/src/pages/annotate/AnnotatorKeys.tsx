import { useEffect, useRef } from "react";
import { stepFrames } from "../../actions/annotate/select";
import { useKeymapWith } from "../../actions/useKeymap";
import { KEYMAP } from "../../model/keymap";
import { keepPlace } from "../../state/lastPlace";
import { useLateAddress } from "../parts/useLateAddress";
import { usePlayback } from "../parts/usePlayback";
import { useAnnotating } from "./annotating";
import { ONCE } from "./createAnnotating";
import { useAnnotation, useOpenRecording, usePage } from "./reading";

const KEYS: ReadonlySet<string> = new Set(KEYMAP.filter(({ scope, id }) => scope === "annotate" || id === "undo" || id === "redo").map(({ id }) => id));

/** Keys, for as long as the annotator is there. */
export function AnnotatorKeys() {
  const { answerTo, press, show } = useAnnotating();
  const repeats = useRef(0);
  const held = useRef<string | null>(null);
  useKeymapWith("annotate", (id) =>
    KEYS.has(id) && answerTo(id)
      ? (event) => {
          repeats.current = event.repeat ? repeats.current + 1 : 0;
          if (id === "view.magnifier") held.current = event.code;
          if (!event.repeat || !ONCE.has(id)) press(id, repeats.current);
        }
      : undefined,
  );
  useEffect(() => {
    const lose = (): void => show({ isMagnified: false });
    const release = (event: KeyboardEvent): void => {
      if (event.code === held.current) lose();
    };
    window.addEventListener("keyup", release);
    window.addEventListener("blur", lose);
    return () => {
      window.removeEventListener("keyup", release);
      window.removeEventListener("blur", lose);
    };
  }, [show]);
  return null;
}

/** The address says where one is. */
export function AnnotatorAddress() {
  const camera = useAnnotation((state) => state.camera);
  const frame = useAnnotation((state) => state.frame);
  const hand = useAnnotation((state) => state.hand);
  // One choice alone is a person's; before, the address and the last visit stand there.
  const cameras = usePage(({ wantedCameras: [first, ...others] }) => (first && others.length === 0 ? first.join() : null));
  useLateAddress({ camera, frame: String(frame), hand, ...(cameras === null ? {} : { cameras }) }, 120, keepPlace);
  return null;
}

/** Goes through the frames while they are played; waits for a picture rather than leave one out. */
export function AnnotatorPlayback() {
  const { session, pictures, act, show } = useAnnotating();
  const isPlaying = usePage((page) => page.isPlaying);
  usePlayback(isPlaying, useOpenRecording().fps, {
    isReady: () => pictures.get()?.isStale === false,
    step: () => {
      act(stepFrames, 1);
      const { frame, frames, frameCount } = session.store.get();
      return frame < (frames?.at(-1) ?? frameCount - 1);
    },
    end: () => show({ isPlaying: false }),
  });
  return null;
}
