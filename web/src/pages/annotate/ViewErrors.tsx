import { Text, Tooltip } from "@mantine/core";
import type { TriangulatedJoint } from "../../api/triangulation";
import { jointLabel } from "../../model/joints";
import { errorOf, gradeOf, worstMarks } from "../../model/triangulated";
import { useKeyOf } from "../../state/keys";
import { useAnnotating } from "./annotating";
import { useAnnotation, useOpenRecording } from "./reading";
import classes from "./ViewErrors.module.css";

const GRADES = { good: "", fair: "±", bad: "!" } as const;

/** An error with its grade, which is told apart by sign as well as colour. */
export function Pixels({ error }: { error: number }) {
  const grade = gradeOf(error);
  return (
    <span className={classes.pixels} data-grade={grade}>
      {GRADES[grade] && <span aria-hidden>{GRADES[grade]} </span>}
      {error.toFixed(1)} px
    </span>
  );
}

/** How far a joint's marks are off at worst, px; null where nothing can be compared. */
export function largestError(joint: TriangulatedJoint | undefined): number | null {
  const errors = joint?.views.flatMap((view) => errorOf(joint, view) ?? []) ?? [];
  return errors.length > 0 ? Math.max(...errors) : null;
}

/** How well the marks of the active joint agree, camera by camera. */
export function ViewErrors({ joints }: { joints: readonly TriangulatedJoint[] | null }) {
  const { act, run } = useAnnotating();
  const recording = useOpenRecording();
  const joint = useAnnotation((state) => state.joint);
  const camera = useAnnotation((state) => state.camera);
  const keyOf = useKeyOf();
  if (recording.cameras.length < 2) return null;
  const here = joints?.[joint];
  const worst = worstMarks(joints ?? [])[0];
  const views = here?.views.filter((view) => view.residual_px !== null) ?? [];
  return (
    <section className={classes.section} aria-label="Agreement of the cameras">
      <Text size="xs" fw={600}>
        {jointLabel(joint)} in the cameras
      </Text>
      {views.length === 0 && (
        <Text size="xs" className="quiet">
          {here && here.refusal && !here.refusal.startsWith("Marked in") ? here.refusal : "Mark it in two cameras to see how well they agree."}
        </Text>
      )}
      {views.map((view) => {
        const [own, left] = [view.residual_px, view.left_out_px];
        return (
          <Tooltip
            key={view.camera}
            position="left"
            label={left === null ? "From the mark to the point that both views make" : `${left.toFixed(2)} px to the point of the other views, ${own?.toFixed(2)} px to the point of all that count`}
          >
            <button type="button" className={classes.view} aria-current={view.camera === camera} onClick={() => act((now) => ({ ...now, camera: view.camera, draft: null }), undefined)}>
              <span className="one-line">{view.camera}</span>
              {!view.is_used && <span className={classes.aside}>set aside</span>}
              <Pixels error={(here && errorOf(here, view)) ?? 0} />
            </button>
          </Tooltip>
        );
      })}
      {here?.point && (
        <Text size="xs" className="quiet">
          rays meet at {here.angle_deg?.toFixed(0)}°, ±{here.std_mm?.toFixed(1)} mm for 1 px
        </Text>
      )}
      {worst && (
        <button type="button" className={classes.worst} onClick={() => run("views.worst")}>
          Worst ({keyOf("views.worst")}): {jointLabel(worst.joint)}, {worst.camera} <Pixels error={worst.error} />
        </button>
      )}
    </section>
  );
}
