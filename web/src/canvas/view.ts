/** Image pixels to screen and back: the one place that knows of the browser's half pixel. */

export interface Point {
  readonly x: number;
  readonly y: number;
}

export interface Size {
  readonly width: number;
  readonly height: number;
}

/** `screen = offset + scale * canvas`, where the canvas has the image's top-left corner (not pixel centre) at (0, 0). */
export interface View {
  readonly scale: number;
  readonly x: number;
  readonly y: number;
}

/** The store's (0, 0) is the centre of the top-left pixel; a browser canvas has that centre at (0.5, 0.5). */
export const PIXEL_CENTRE = 0.5;

export const toScreen = (view: View, pixel: Point): Point => ({
  x: view.x + view.scale * (pixel.x + PIXEL_CENTRE),
  y: view.y + view.scale * (pixel.y + PIXEL_CENTRE),
});

export const toPixel = (view: View, screen: Point): Point => ({
  x: (screen.x - view.x) / view.scale - PIXEL_CENTRE,
  y: (screen.y - view.y) / view.scale - PIXEL_CENTRE,
});

/** A point between pixel centres can be marked up to half a pixel beyond the outermost ones. */
export const isInImage = (pixel: Point, image: Size): boolean =>
  pixel.x >= -PIXEL_CENTRE && pixel.y >= -PIXEL_CENTRE && pixel.x < image.width - PIXEL_CENTRE && pixel.y < image.height - PIXEL_CENTRE;

/** The whole image, centred, with a margin on each side (px of the screen). */
export function fitView(image: Size, pane: Size, margin = 8): View {
  const scale = Math.max(
    0.05,
    Math.min((pane.width - 2 * margin) / image.width, (pane.height - 2 * margin) / image.height),
  );
  return { scale, x: (pane.width - scale * image.width) / 2, y: (pane.height - scale * image.height) / 2 };
}

export const MAX_SCALE = 64;

/** Zoom by a factor; what lies under the cursor stays under it. */
export function zoomAt(view: View, screen: Point, factor: number, minScale: number): View {
  const scale = Math.min(MAX_SCALE, Math.max(minScale, view.scale * factor));
  const ratio = scale / view.scale;
  return { scale, x: screen.x - ratio * (screen.x - view.x), y: screen.y - ratio * (screen.y - view.y) };
}

/** Move the image by screen pixels, without losing it: a part of it stays in the pane. */
export function panBy(view: View, by: Point, image: Size, pane: Size): View {
  const keep = 48;
  const within = (offset: number, length: number, room: number): number =>
    Math.min(room - keep, Math.max(keep - length * view.scale, offset));
  return {
    scale: view.scale,
    x: within(view.x + by.x, image.width, pane.width),
    y: within(view.y + by.y, image.height, pane.height),
  };
}
