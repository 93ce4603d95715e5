import { Button, Group, Slider, Text, Title } from "@mantine/core";
import { useEffect, useMemo, useRef, useState } from "react";
import { useModelGeometry, type HandModel } from "../../api/handModels";
import type { HandGeometry } from "../../canvas/hand3d/geometry";
import type { Staged } from "../../canvas/hand3d/staged";
import { useStage } from "../../canvas/hand3d/useStage";
import { shapeHand } from "../../model/liveHand";
import { patternOf, uprightFrom } from "../../model/upright";
import { formatName, formatNumber } from "../../model/format";
import classes from "./Models.module.css";

/** More than anybody turns by hand. */
const SLIDERS = 10;

/** The model's mesh at rest, with a slider for each of the first components of its shape space. */
export function LiveModel({ model }: { model: HandModel }) {
  const { data: geometry, error } = useModelGeometry(model.id);
  const [shape, setShape] = useState<readonly number[]>([]);
  const parts = useStage();
  const { stage } = parts;
  const staged = useRef<Staged | null>(null);
  const upright = useMemo(() => geometry && uprightFrom(geometry.vertices, patternOf(geometry.vertices, geometry.joints, geometry.tips), model.side), [geometry, model.side]);

  useEffect(() => {
    if (!stage || !geometry || !upright) return;
    const vertices = shapeHand(geometry.vertices, geometry.shapes, geometry.shapeCount, shape);
    const surface = { positions: vertices, normals: null, colors: null, index: geometry.faces, errorMm: null, taken: null };
    const shown: HandGeometry = { scan: { ...surface, positions: new Float32Array(0), index: null }, mesh: surface, side: model.side, upright };
    const before = staged.current;
    staged.current = stage.prepare(shown);
    stage.show(staged.current);
    before?.release();
  }, [stage, geometry, upright, shape, model.side]);
  useEffect(
    () => () => {
      staged.current?.release();
      staged.current = null;
    },
    [stage],
  );

  if (error) {
    return (
      <Text size="sm" c="var(--bad-text)" role="alert">
        The mesh could not be loaded: {error.message}
      </Text>
    );
  }
  const told = model.provenance["shape_names"]?.split(", ") ?? [];
  const nameOf = (at: number): string => (told.length === model.shape_parameters.length ? formatName(told[at] ?? "") : `Component ${at + 1}`);
  const count = Math.min(SLIDERS, geometry?.shapeCount ?? 0);
  const set = (at: number, value: number): void => setShape(Array.from({ length: count }, (_, other) => (other === at ? value : (shape[other] ?? 0))));
  return (
    <section className={`card ${classes.live}`} aria-label="The model">
      <div ref={parts.holder} className={classes.liveView} role="img" aria-label={`Mesh of ${model.name}`}>
        <canvas ref={parts.canvas} aria-hidden />
      </div>
      <div className={classes.sliders} tabIndex={0} role="group" aria-label="Shape">
        <Group justify="space-between">
          <Title order={3}>Shape</Title>
          <Button size="compact-xs" variant="subtle" disabled={shape.every((value) => value === 0)} onClick={() => setShape([])}>
            Mean
          </Button>
        </Group>
        {geometry && count === 0 && (
          <Text size="xs" className="quiet">
            This model has no shape space.
          </Text>
        )}
        {Array.from({ length: count }, (_, at) => (
          <div key={at}>
            <Group justify="space-between">
              <Text size="xs">{nameOf(at)}</Text>
              <Text size="xs" className="quiet">
                {formatNumber(shape[at] ?? 0, 1)} sd
              </Text>
            </Group>
            <Slider size="sm" min={-3} max={3} step={0.1} label={null} thumbLabel={`${nameOf(at)}, standard deviations`} value={shape[at] ?? 0} onChange={(value) => set(at, value)} />
          </div>
        ))}
      </div>
    </section>
  );
}
