import { useEffect, useRef, useState } from "react";
import type { Annotating } from "./annotating";

/** How often what stands around the picture follows while frames go by. */
const PERIOD_MS = 200;

/**
 * The annotator as what stands around the picture sees it: at once, but while frames go by only a few times a second.
 * Panels and timeline take longer to draw than a picture, and drawn for each frame they would cost frames.
 */
export function useUnhurried(now: Annotating): Annotating {
  const shown = useRef({ value: now, at: -PERIOD_MS });
  const [, wake] = useState(0);
  const time = performance.now();
  const isAnotherFrame = shown.current.value.state.frame !== now.state.frame;
  const isHeld = isAnotherFrame && time - shown.current.at < PERIOD_MS;
  if (!isHeld) shown.current = { value: now, at: isAnotherFrame ? time : shown.current.at };
  useEffect(() => {
    if (!isHeld) return;
    const timer = setTimeout(() => wake((times) => times + 1), PERIOD_MS);
    return () => clearTimeout(timer);
  });
  return shown.current.value;
}
