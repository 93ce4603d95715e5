import { describe, expect, it } from "vitest";
import { AT_REST, BODY_SLIDERS, frameOfSetting } from "./bodyPose";

describe("a setting of the body's sliders", () => {
  it("is the rest pose where nothing is set", () => {
    expect(frameOfSetting(AT_REST)).toEqual({ pose: null, joints: {}, hands: { left: [], right: [] }, translation: [0, 0, 0] });
  });

  it("turns joints of both sides as mirror images", () => {
    for (const { key, most, turns } of BODY_SLIDERS) {
      const { joints } = frameOfSetting({ ...AT_REST, angles: { [key]: most } });
      expect(Object.keys(joints ?? {}).sort()).toEqual(Object.keys(turns).sort());
      for (const [name, vector] of Object.entries(joints ?? {})) {
        const other = (joints ?? {})[name.replace("left_", "right_")] as number[];
        if (name.startsWith("left_")) expect(other).toEqual([vector[0], 0 - (vector[1] ?? 0), 0 - (vector[2] ?? 0)]);
      }
    }
  });

  it("adds what two sliders do to one joint", () => {
    const { joints } = frameOfSetting({ ...AT_REST, angles: { forearms: 30, wrists: 60 } });
    expect(joints?.["left_wrist"]).toEqual([Math.PI / 6, 0, -Math.PI / 3]);
  });
});
