import { useEffect, type RefObject } from "react";
import type uPlot from "uplot";

/** A finger on a plot goes through the frames; a movement up or down scrolls the page instead. */
export function useTouchSeek(holder: RefObject<HTMLElement | null>, plot: RefObject<uPlot | null>, seek: RefObject<((frame: number) => void) | undefined>): void {
  useEffect(() => {
    const element = holder.current;
    if (!element) return;
    const follow = (event: PointerEvent): void => {
      const drawn = plot.current;
      if (!drawn || event.pointerType === "mouse" || !(event.target as Element).closest(".u-over")) return;
      const box = drawn.over.getBoundingClientRect();
      const at = drawn.data[0][drawn.posToIdx(Math.min(box.width, Math.max(0, event.clientX - box.left)))];
      if (at !== undefined) seek.current?.(at);
    };
    element.addEventListener("pointerdown", follow);
    element.addEventListener("pointermove", follow);
    return () => {
      element.removeEventListener("pointerdown", follow);
      element.removeEventListener("pointermove", follow);
    };
  }, [holder, plot, seek]);
}
