import { Loader, Text } from "@mantine/core";
import { useEffect, useRef } from "react";
import type { HandGeometry } from "../../canvas/hand3d/geometry";
import type { Staged } from "../../canvas/hand3d/staged";
import { useStage } from "../../canvas/hand3d/useStage";
import classes from "./BodyPage.module.css";

const NOTHING = { positions: new Float32Array(0), normals: null, colors: null, index: null, errorMm: null, taken: null };

interface BodyViewProps {
  /** Three numbers a vertex, m; undefined until they are there. */
  vertices: Float32Array | undefined;
  faces: Uint32Array | undefined;
}

/** The body in 3D. It is put in the middle when it first comes, and moves from there. */
export function BodyView({ vertices, faces }: BodyViewProps) {
  const { holder, canvas, stage, failure } = useStage();
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
  const isThere = vertices !== undefined && faces !== undefined;
  return (
    <div ref={holder} className={classes.view} role="img" aria-label="Mesh of the body" data-drawn={isThere}>
      <canvas ref={canvas} aria-hidden />
      {!isThere && !failure && <Loader className={classes.loading} aria-label="The body is loading" />}
      <Text size="xs" className={classes.note}>
        {failure ?? "Drag to turn, scroll to zoom, right button to move"}
      </Text>
    </div>
  );
}
