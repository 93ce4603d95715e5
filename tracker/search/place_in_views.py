"""Place a hand where several views see its joints."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import numpy.typing as npt

from tracker.capture.triangulation import triangulate
from tracker.fitting.finger_search import curl_fingers
from tracker.fitting.view_hands import HOLDS, ViewHands
from tracker.model.articulated import ArticulatedModel
from tracker.model.scene import Scene
from tracker.search.joint_descent import BENDS, FEW_STEPS, JointDescent

Array = npt.NDArray[np.float64]

STEPS = 30
"""Gauss-Newton steps from the triangulated joints."""

FEW_JOINTS = 8
"""With fewer joints that views agree on there is no hand to place."""


def place_in_views(model: ArticulatedModel, name: str, seen: ViewHands) -> Array | None:
    """(D,) pose of one hand on the joints that the views saw; None where too few of them agree.

    Two views are enough; of more, those that agree with each other are taken. A single one tells the distance as well
    as the hand's size is known.

    Args:
        model: The hand.
        name: `right` or `left`.
        seen: Of one moment.
    """
    views = [view for view, hands in enumerate(seen.hands) if name in hands]
    if len(views) == 1:
        return _place_by_size(model, name, seen, views[0])
    best, best_merit = None, 0.0
    for pair in combinations(views, 2):
        others = [view for view in views if view not in pair]
        pose = _descend(model, name, seen.without(name, others))
        if pose is None:
            continue
        merit = _count_agreement(model, name, seen, pose)
        if merit > best_merit:
            best, best_merit = pose, merit
        if merit > 0.9 * len(views) * (1.0 - HOLDS):
            break
    if best is None or len(views) == 2:
        return best
    apart = seen.measure(Scene((model,)).pose_at(best), 0, name)
    return _descend(model, name, seen.without(name, [view for view in views if apart[view] > HOLDS]))


def _count_agreement(model: ArticulatedModel, name: str, seen: ViewHands, pose: Array) -> float:
    """Views that hold the hand at a pose, each as far as it does."""
    apart = seen.measure(Scene((model,)).pose_at(pose), 0, name)
    return float(np.sum(np.maximum(1.0 - apart[np.isfinite(apart)], 0.0) * (apart[np.isfinite(apart)] < HOLDS)))


def _descend(model: ArticulatedModel, name: str, seen: ViewHands) -> Array | None:
    """The pose on joints that are triangulated from all views of the hand."""
    views = [view for view, hands in enumerate(seen.hands) if name in hands]
    if len(views) < 2:
        return None
    places = triangulate([seen.cameras[view] for view in views], seen.points(name)[:, views]).points
    known = np.asarray(np.isfinite(places).all(axis=1))
    if known.sum() < FEW_JOINTS:
        return None
    return _descend_from(model, name, seen, np.nan_to_num(places), known)


def _descend_from(
    model: ArticulatedModel, name: str, seen: ViewHands, places: Array, known: npt.NDArray[np.bool_]
) -> Array:
    """The pose on the joints that were seen, from the bend whose joints come nearest to them.

    Args:
        model: The hand.
        name: Its name.
        seen: The views to believe.
        places: (21, 3) joints in space, world, m.
        known: (21,) which of them there are.
    """
    scene = Scene((model,))
    descent = JointDescent(scene, seen.rays(scene, 0, name), places, known)
    ways = []
    for curl in BENDS:
        rest = descent.rest(curl_fingers(model, curl), known)
        ways.append((rest, *descent.descend(rest, rest, FEW_STEPS)))
    rest, pose, _ = min(ways, key=lambda way: way[2])
    return descent.descend(pose, rest, STEPS - FEW_STEPS)[0]


def _place_by_size(model: ArticulatedModel, name: str, seen: ViewHands, view: int) -> Array | None:
    """The pose on the joints of one view, at the distance at which this hand looks so large.

    The detector tells the joints' depths against each other for a hand of its own size.
    """
    camera, hand = seen.cameras[view], seen.hands[view][name]
    scene = Scene((model,))
    own = _measure_bones(scene.pose_at(scene.rest_pose()).landmarks(0))
    larger = own / max(_measure_bones(hand.points_3d), 1e-9)
    depth = larger * camera.K[0, 0] / max(hand.pixels_per_metre, 1e-9)
    depths = depth + larger * (hand.points_3d[:, 2] - hand.points_3d[:, 2].mean())
    places = camera.lift(hand.points, depths)
    known = np.asarray(np.isfinite(places).all(axis=1)) & (depths > 0.0)
    if known.sum() < FEW_JOINTS:
        return None
    return _descend_from(model, name, seen, np.nan_to_num(places), known)


def _measure_bones(joints: Array) -> float:
    """Summed length of the bones between joints (21, 3)."""
    fingers = joints[1:].reshape(5, 4, 3)
    return float(np.linalg.norm(np.diff(fingers, axis=1), axis=2).sum())
