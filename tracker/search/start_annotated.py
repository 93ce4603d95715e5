"""Start a hand at the joints that somebody marked in the frame."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import numpy.typing as npt

from tracker.capture.camera import Camera
from tracker.fitting.attempt import SCORED_PIXELS
from tracker.fitting.finger_search import curl_fingers
from tracker.fitting.frame_fit import draw
from tracker.fitting.measure_quality import measure_quality
from tracker.fitting.objective import Objective
from tracker.model.articulated import ArticulatedModel
from tracker.model.scene import Scene
from tracker.observation import HAND, Observation
from tracker.search.joint_descent import BENDS, FEW_STEPS, JointDescent
from tracker.terms.marked_joints import mark_joints

Array = npt.NDArray[np.float64]

FLESH = 0.009
"""A joint lies about this far behind the skin that is seen before it, m."""


def with_marks(objective: Objective, scene: Scene, names: tuple[str, ...], marks: dict, camera: Camera) -> Objective:
    """The objective of the first frame: hands keep the joints (21, 3) that somebody marked, by name, where they are."""
    terms = dict(objective.terms)
    for model, name in enumerate(names):
        if name in marks:
            terms[f"marks_{name}"] = mark_joints(scene, model, marks[name], camera)
    return replace(objective, terms=terms)


def undistort_points(points: Array, camera: Camera) -> Array:
    """Marked joints (21, 3) of a recorded image as an ideal pinhole camera of the same K would show them."""
    if not camera.distortion.size:
        return points
    ideal = points.copy()
    ideal[:, :2] = cv2.undistortPoints(points[:, None, :2], camera.K, camera.distortion, P=camera.K)[:, 0]
    return ideal


def start_hand(
    model: ArticulatedModel,
    points: Array,
    camera: Camera,
    observation: Observation | None,
    iterations: int = 40,
    relative: Array | None = None,
    bent: Array | None = None,
) -> Array:
    """(D,) pose of one hand whose joints lie on the marked pixels and, where visible, at the depth seen there.

    Of several bends the one that comes nearest to a person's marks is taken; of a detector's (`relative` is given) the
    one that looks most like the depth image. A hand that tilts towards the camera has its joints on the same pixels as
    one that tilts away, and where a thing hides the palm the detector only guesses its joints.

    Args:
        model: The hand.
        points: (21, 3) x, y px of the image and v.
        camera: Undistorted camera.
        observation: Of the whole image or of a region with the marked joints; None where there is no depth.
        iterations: Gauss-Newton steps from each bend.
        relative: (21,) depth of the joints, m, each against the others, if it is known.
        bent: (A,) angles to start from; three bends of all fingers are tried when left out.
    """
    scene = Scene((model,))
    joints = mark_joints(scene, 0, points, camera)
    if observation is None:
        lifted, seen = _lift_by_size(points, camera, scene.pose_at(scene.rest_pose()).landmarks(0))
    else:
        lifted, seen = _lift(points, camera, observation, np.zeros(21) if relative is None else relative)
    descent, known = JointDescent(scene, joints, lifted, seen), points[:, 2] > 0
    ways = []
    for angles in [bent] if bent is not None else [curl_fingers(model, curl) for curl in BENDS]:
        rest = descent.rest(angles, known)
        ways.append((rest, *descent.descend(rest, rest, min(FEW_STEPS, iterations))))
    if observation is None or relative is None:
        rest, pose, _ = min(ways, key=lambda way: way[2])
    else:
        thin = observation.thin_to(SCORED_PIXELS)
        rest, pose, _ = max(ways, key=lambda way: measure_quality(draw(scene.pose_at(way[1]), thin), thin).score)
    return descent.descend(pose, rest, max(0, iterations - FEW_STEPS))[0]


def _lift(
    points: Array, camera: Camera, observation: Observation, relative: Array
) -> tuple[Array, npt.NDArray[np.bool_]]:
    """Marked joints in space: (21, 3) world, m, and (21,) whether the depth there was seen.

    A joint without depth of its own gets the median depth of the others, and what is known of its own against theirs.
    """
    depths = np.zeros(21)
    seen = np.zeros(21, dtype=bool)
    height, width = observation.labels.shape
    region = observation.region
    for joint in np.flatnonzero(points[:, 2] == 2):
        column, row = round(points[joint, 0]) - region.column, round(points[joint, 1]) - region.row
        rows, columns = slice(max(0, row - 2), min(height, row + 3)), slice(max(0, column - 2), min(width, column + 3))
        values = observation.depth[rows, columns][(observation.labels[rows, columns] & HAND) > 0]
        if values.size:
            depths[joint] = float(np.median(values)) + FLESH
            seen[joint] = True
    everywhere = observation.depth[(observation.labels & HAND) > 0]
    fallback = float(np.median(everywhere)) if everywhere.size else 0.5
    if seen.any():
        fallback = float(np.median(depths[seen] - relative[seen]))
    depths[~seen] = fallback + relative[~seen]
    return camera.lift(points[:, :2], depths), seen


def _lift_by_size(points: Array, camera: Camera, rest: Array) -> tuple[Array, npt.NDArray[np.bool_]]:
    """Marked joints in space, (21, 3) world, m, all at the distance at which a hand looks so large; none is seen.

    A hand that is bent or turned away looks smaller, never larger: of all pairs of marked joints those count that look
    largest for their length at rest (21, 3) m.
    """
    first, second = np.triu_indices(21, 1)
    both = (points[first, 2] > 0) & (points[second, 2] > 0)
    first, second = first[both], second[both]
    lengths = np.linalg.norm(rest[first] - rest[second], axis=1)
    apart = np.linalg.norm((points[first, :2] - points[second, :2]) / camera.K[[0, 1], [0, 1]], axis=1)
    depth = float(np.percentile(lengths / np.maximum(apart, 1e-4), 20)) if len(first) else 0.5
    return camera.lift(points[:, :2], np.full(21, depth)), np.zeros(21, dtype=bool)
