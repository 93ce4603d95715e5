import { expect, test } from "vitest";
import { cumulative, readReport } from "./trainingReport";

test("shares of the variance add up, one component after the other", () => {
  expect(cumulative([0.5, 0.25, 0.125])).toEqual({ components: [1, 2, 3], values: [0.5, 0.75, 0.875] });
});

test("a report is read whole", () => {
  const report = readReport({
    registrations: 360,
    people: 12,
    residual_mm: 0.41,
    rounds_mm: [1.2, 0.6, 0.41],
    shape_space: [0.6, 0.2],
    pose_space: [0.3, 0.2, 0.1],
    by_pose: { fist: { registrations: 12, residual_mm: 0.7 }, flat: { registrations: 12, residual_mm: 0.3 } },
    seconds: { poses: 20, templates: 3 },
    study: {
      shape_generalisation: [{ components: 1, mean_mm: 2, sd_mm: 0.1 }, { components: 2, mean_mm: 1, sd_mm: 0.1 }],
      models: { learned: { scan_to_mesh_mm: 0.3 }, untrained: { scan_to_mesh_mm: 0.9 } },
    },
  });
  expect(report.byPose.map((one) => one.name)).toEqual(["fist", "flat"]);
  expect(report.poseCompactness.components).toEqual([1, 2, 3]);
  expect(report.shapeGeneralisation).toEqual({ components: [1, 2], values: [2, 1] });
  expect(report.comparison[1]).toEqual({ name: "untrained", value: 0.9, count: null });
  expect(report.seconds.map((one) => one.value)).toEqual([20, 3]);
});

test("what is not there, or something else, is nothing and never a fault", () => {
  for (const odd of [{}, { shape_space: "many", by_pose: [1, 2], rounds_mm: [null, "x", 3], study: { shape_generalisation: [{ components: 1 }, "x"], models: [3] } }]) {
    const report = readReport(odd);
    expect(report.shapeCompactness.values).toEqual([]);
    expect(report.byPose).toEqual([]);
    expect(report.shapeGeneralisation.values).toEqual([]);
  }
});
