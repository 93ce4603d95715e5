import { expect, test } from "vitest";
import { readReport } from "./trainingReport";

const row = (components: number, mean_mm: number) => ({ components, mean_mm, sd_mm: 0.1 });

test("a report is read whole", () => {
  const report = readReport({
    registrations: 360,
    people: 12,
    residual_mm: 0.41,
    rounds_mm: [1.2, 0.6, 0.41],
    shape_space: [0.6, 0.8],
    pose_space: [0.3, 0.5, 0.6],
    by_pose: { fist: { registrations: 12, residual_mm: 0.7 }, flat: { registrations: 12, residual_mm: 0.3 } },
    seconds: { poses: 20, templates: 3 },
    study: {
      shape_generalisation: [row(1, 2), row(2, 1)],
      people: ["S32", "S33"],
      scans: 24,
      floor_mm: 0.36,
      models: { learned: { scan_to_mesh_mm: 0.3, vertices_mm: 0.4 }, untrained: { scan_to_mesh_mm: 0.9, vertices_mm: 2 } },
      own_template: { learned: { scan_to_mesh_mm: 0.31, vertices_mm: 0.2 } },
      pose_generalisation: { learned: [row(0, 3), row(45, 0.3)], "right hands only": [row(0, 3), row(20, 0.4)] },
      not_compared: { "plain skinning": "Too few." },
    },
  });
  expect(report.byPose.map((one) => one.name)).toEqual(["fist", "flat"]);
  expect(report.poseCompactness).toEqual({ components: [1, 2, 3], values: [0.3, 0.5, 0.6] });
  expect(report.shapeGeneralisation).toEqual({ components: [1, 2], values: [2, 1] });
  expect(report.heldOut?.models.vertices[1]).toEqual({ name: "untrained", value: 2, count: null });
  expect(report.heldOut?.ownTemplate.scanToMesh).toEqual([{ name: "learned", value: 0.31, count: null }]);
  expect(report.heldOut?.poseGeneralisation.map(({ name, curve }) => [name, curve.components])).toEqual([
    ["learned", [0, 45]],
    ["right hands only", [0, 20]],
  ]);
  expect(report.heldOut?.notCompared).toEqual([{ name: "plain skinning", why: "Too few." }]);
  expect(report.seconds.map((one) => one.value)).toEqual([20, 3]);
});

test("what is not there, or something else, is nothing and never a fault", () => {
  for (const odd of [{}, { shape_space: "many", by_pose: [1, 2], rounds_mm: [null, "x", 3], study: { shape_generalisation: [{ components: 1 }, "x"], models: [3], people: 3 } }]) {
    const report = readReport(odd);
    expect(report.shapeCompactness.values).toEqual([]);
    expect(report.byPose).toEqual([]);
    expect(report.shapeGeneralisation.values).toEqual([]);
    expect(report.heldOut).toBeNull();
  }
});
