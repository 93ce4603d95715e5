/** Which frames a timeline shows, and where; frames may be fractions while zooming. */

export interface FrameWindow {
  readonly from: number;
  readonly count: number;
}

/** Closer than this and a frame is wider than anybody needs. */
const MIN_COUNT = 24;

export const wholeWindow = (frameCount: number): FrameWindow => ({ from: 0, count: Math.max(1, frameCount) });

function within(from: number, count: number, frameCount: number): FrameWindow {
  const shown = Math.min(frameCount, Math.max(Math.min(MIN_COUNT, frameCount), count));
  return { from: Math.min(frameCount - shown, Math.max(0, from)), count: shown };
}

export const xOf = (window: FrameWindow, width: number, frame: number): number => ((frame - window.from) / window.count) * width;

export const frameAt = (window: FrameWindow, width: number, x: number, frameCount: number): number =>
  Math.min(frameCount - 1, Math.max(0, Math.floor(window.from + (x / Math.max(1, width)) * window.count)));

/** What lies at a share (0..1) of the width stays there. */
export function zoomWindow(window: FrameWindow, factor: number, share: number, frameCount: number): FrameWindow {
  const at = window.from + share * window.count;
  const { count } = within(0, window.count / factor, frameCount);
  return within(at - share * count, count, frameCount);
}

export const panWindow = (window: FrameWindow, frames: number, frameCount: number): FrameWindow => within(window.from + frames, window.count, frameCount);

/** The window, moved so that a frame is in it: by pages, so that the marks stand still while the cursor runs. */
export function windowWith(window: FrameWindow, frame: number, frameCount: number): FrameWindow {
  if (frame >= window.from && frame + 1 <= window.from + window.count) return window;
  const margin = 0.1 * window.count;
  return within(frame < window.from ? frame - window.count + margin : frame - margin, window.count, frameCount);
}

/** Distance of the frame numbers below a timeline: 1, 2 or 5 times a power of ten, at least so many px apart. */
export function tickStep(window: FrameWindow, width: number, apart = 72): number {
  const least = (window.count / Math.max(1, width)) * apart;
  const power = 10 ** Math.floor(Math.log10(Math.max(1, least)));
  return [1, 2, 5, 10].map((factor) => factor * power).find((step) => step >= least) ?? 10 * power;
}
