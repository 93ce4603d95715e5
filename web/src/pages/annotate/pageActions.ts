import { cancelDrag } from "../../actions/annotate/move";
import { scaleRange } from "../../canvas/depth";
import { clampFactor, nextArrangement, nextPlaceMode } from "../../state/viewOptions";
import type { Actions, Annotating } from "./annotating";
import { arrangementOf, cameraOf } from "./reading";
import type { SeenSteps } from "./seenSteps";

/** Holding a key goes faster after a while: 1, then 2, then 4 frames a step. */
const stepFor = (repeats: number): number => (repeats < 12 ? 1 : repeats < 40 ? 2 : 4);

/** Everything of the key map that changes how the page shows things, or goes from frame to frame. */
export function pageActions(annotating: Annotating, steps: SeenSteps): Actions {
  const { session, page, pictures, options, show, setOptions, act } = annotating;
  const brighten = (factor: number) => () => setOptions({ brightness: clampFactor(options.get().brightness * factor) });
  const contrast = (factor: number) => () => {
    const range = pictures.get()?.range;
    if (arrangementOf(annotating) === "color" || !range) setOptions({ contrast: clampFactor(options.get().contrast * factor) });
    else show({ range: scaleRange(range, 1 / factor) });
  };
  return {
    "frame.next": (repeats = 0) => steps.step(stepFor(repeats)),
    "frame.previous": (repeats = 0) => steps.step(-stepFor(repeats)),
    play: () => show({ isPlaying: !page.get().isPlaying }),
    "view.fit": () => show({ views: {} }),
    "view.magnifier": () => show({ isMagnified: true }),
    "view.depth": () => setOptions({ arrangement: nextArrangement(cameraOf(annotating), options.get().arrangement) }),
    "place.mode": () => setOptions({ placeMode: nextPlaceMode(options.get().placeMode) }),
    "view.hands": () => setOptions({ areHandsShown: !options.get().areHandsShown }),
    "view.names": () => setOptions({ areNamesShown: !options.get().areNamesShown }),
    "views.epipolar": () => setOptions({ areLinesShown: !options.get().areLinesShown }),
    "view.brighter": brighten(1.1),
    "view.darker": brighten(1 / 1.1),
    "view.contrastUp": contrast(1.1),
    "view.contrastDown": contrast(1 / 1.1),
    "drag.cancel": () => {
      if (session.store.get().draft) act(cancelDrag, undefined);
      else document.querySelector<HTMLElement>('[role="toolbar"] button')?.focus();
    },
  };
}
