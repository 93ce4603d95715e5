/** Which frames are on the screen: what the panes have drawn, not what they were asked for. */

export interface Screen {
  /** A pane has drawn a frame of a camera; null: it shows none. */
  note: (pane: string, camera: string, frame: number | null) => void;
  /** Whether the camera's pictures on the screen are of this frame, all of them. */
  shows: (camera: string, frame: number) => boolean;
}

export function createScreen(): Screen {
  const panes = new Map<string, { camera: string; frame: number }>();
  return {
    note(pane, camera, frame) {
      if (frame === null) panes.delete(pane);
      else panes.set(pane, { camera, frame });
    },
    shows(camera, frame) {
      const own = [...panes.values()].filter((pane) => pane.camera === camera);
      return own.length > 0 && own.every((pane) => pane.frame === frame);
    },
  };
}
