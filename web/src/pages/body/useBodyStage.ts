import { useEffect, useRef } from "react";
import type { HandGeometry } from "../../canvas/hand3d/geometry";
import type { Staged } from "../../canvas/hand3d/staged";
import { useStage, type StageParts } from "../../canvas/hand3d/useStage";

const NOTHING = { positions: new Float32Array(0), normals: null, colors: null, index: null, errorMm: null, taken: null };

/** A 3D view of the body. It is put in the middle when it first comes, and moves from there. */
export function useBodyStage(vertices: Float32Array | undefined, faces: Uint32Array | undefined): StageParts {
  const parts = useStage();
  const { stage } = parts;
  const staged = useRef<Staged | null>(null);
  useEffect(() => {
    if (!stage || !vertices || !faces) return;
    if (staged.current) {
      staged.current.move(vertices);
      return stage.draw();
    }
    const mesh = { ...NOTHING, positions: vertices.slice(), index: faces };
    const shown: HandGeometry = { scan: NOTHING, mesh, side: null, upright: [0, 0, 0, 1] };
    staged.current = stage.prepare(shown);
    stage.show(staged.current);
  }, [stage, vertices, faces]);
  useEffect(
    () => () => {
      staged.current?.release();
      staged.current = null;
    },
    [stage],
  );
  return parts;
}
