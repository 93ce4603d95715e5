"""Fingertips that show beyond a thing which hides the rest of their finger."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from tracker.capture.camera import Camera
from tracker.fitting.attempt import Attempt, attempt_fit
from tracker.fitting.finger_search import list_finger_angles
from tracker.fitting.frame_fit import FitOptions, draw
from tracker.fitting.measure_quality import ALIKE, HandPlace, measure_quality
from tracker.fitting.objective import Objective
from tracker.fitting.setup import TrackSetup
from tracker.fitting.sighting import Sightings
from tracker.model.joints import FINGERS
from tracker.model.scene import Scene
from tracker.observation import HAND, Observation
from tracker.observation.islands import find_islands
from tracker.rendering import View
from tracker.search.joint_descent import JointDescent
from tracker.terms.marked_joints import mark_joints

Array = npt.NDArray[np.float64]

EXPLAINED = 0.1
"""Of a tip that no finger is drawn on at most this share of the pixels agrees with the drawn hand."""

REACH = 1.1
"""A finger reaches its own length from its knuckle; hands differ."""

FLESH = 0.006
"""A fingertip's bone ends so far behind its skin, m."""

GAIN = 0.005
"""A finger is taken to a tip if the hand then agrees better with the depth by this."""

STEPS = 10
"""From where a finger is to the tip that shows."""


def reach_shown_tips(
    setup: TrackSetup, seen: Observation, best: Attempt, objective: Objective, options: FitOptions, sightings: Sightings
) -> Attempt | None:
    """A better attempt with a hidden finger whose tip shows and is not drawn; None where no tip shows so.

    Neither the depth image nor a network draws a finger there: its matches are too far away, and all but the tip of it
    is hidden. [T16] §3.2.5 lets salient points find their fingertips likewise. To the largest such tip each finger is
    drawn that reaches it. Of those that then look most like the depth image (one that shows elsewhere leaves its own
    tip) the one that has to turn least is fitted.
    """
    view = draw(setup.scene.pose_at(best.pose), seen)
    for hand in best.qualities:

        def look_alike(pose: Array, hand: int = hand) -> float:
            return measure_quality(draw(setup.scene.pose_at(pose), seen), seen, hand).score

        for tip in find_shown_tips(view, seen, hand):
            reaching = [reach(setup, best.pose, hand, finger, tip, sightings.camera) for finger in range(len(FINGERS))]
            starts = [(cost, look_alike(pose), pose) for pose, cost in reaching if np.isfinite(cost)]
            if starts:
                most = max(score for _, score, _ in starts)
                start = min((one for one in starts if one[1] > most - GAIN), key=lambda one: one[0])[2]
                other = attempt_fit(setup, seen, start, start, objective, options, sightings)
                return other if other.agreement > best.agreement + GAIN else best
    return None


def find_shown_tips(view: View, seen: Observation, hand: int) -> list[Array]:
    """(3,) world, m, what may be tips of one hand's fingers and is not drawn; the largest first."""
    place = HandPlace.of(view.posed.landmarks(hand))
    is_own = (view.face >= 0) & (view.posed.scene.face_models[np.maximum(view.face, 0)] == hand)
    drawn = np.where(is_own, 1.0 / np.where(is_own, view.inverse_depth, 1.0), 0.0)
    is_alike = is_own & (np.abs(drawn - seen.depth) < ALIKE)
    tips = []
    for island in find_islands((seen.labels & HAND) > 0, seen.depth, seen.K):
        middle = np.median(seen.points[island.is_in].astype(np.float64), axis=0)
        if np.mean(is_alike[island.is_in]) < EXPLAINED and (middle - place.wrist) @ place.forward > 0.0:
            tips.append(middle)
    return tips


def reach(setup: TrackSetup, pose: Array, hand: int, finger: int, tip: Array, camera: Camera) -> tuple[Array, float]:
    """The pose (D,) with a finger's tip where one shows, (3,) world, m, and its cost; infinite if it is too short."""
    where, model = setup.scene.pose_slices[hand], setup.models[hand]
    scene = Scene((model,))
    rest = pose[where].copy()
    rest[6 + list_finger_angles(model, finger)] = 0.0
    straight, joints = scene.pose_at(rest).landmarks(0), scene.pose_at(pose[where]).landmarks(0)
    own = slice(1 + 4 * finger, 5 + 4 * finger)
    if np.linalg.norm(tip - straight[own][0]) > REACH * np.linalg.norm(np.diff(straight[own], axis=0), axis=1).sum():
        return pose, np.inf
    ray = tip - camera.T_world_camera[:3, 3]
    joints[own][-1] = tip + FLESH * ray / np.linalg.norm(ray)
    known = np.ones(21, dtype=np.bool_)
    known[own] = False, False, False, True
    points = np.column_stack([camera.project(joints), np.where(known, 2.0, 0.0)])
    descent = JointDescent(scene, mark_joints(scene, 0, points, camera), joints, known)
    found = pose.copy()
    found[where], cost = descent.descend(rest, rest, STEPS)
    return found, cost
