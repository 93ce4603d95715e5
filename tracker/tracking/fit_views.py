"""Fit a scene to what several colour views saw at one moment, and judge each hand."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from time import perf_counter

import numpy as np
import numpy.typing as npt

from tracker.capture.camera import Camera
from tracker.capture.frame import Frame
from tracker.detection.image_hands import name_hands
from tracker.fitting.frame_fit import Fit, FitOptions, fit_frame
from tracker.fitting.objective import Objective
from tracker.fitting.setup import TrackSetup
from tracker.fitting.view_hands import FOLLOWS, HOLDS, REACH, ViewHands
from tracker.geometry import se3
from tracker.landmarks import DetectedHand, HandDetector
from tracker.model.scene import PosedScene
from tracker.observation.image_edges import find_image_edges
from tracker.terms.contours import Contours
from tracker.terms.joint_prior import Regularization
from tracker.tracking.recovery import list_hands

Array = npt.NDArray[np.float64]

FAR_REACH = 4.0 * REACH
"""mm; the first iterations of a frame hear joints from farther off, where a hand moved fast."""

MANY = 4
"""Where so many views or more are tracked in, contours hold a hand better than single joints do, and the constants
below count. They were chosen on rendered views (docs/studies/rendered_views.md); the real recordings at hand have two
or three views, in which nothing changes."""

MANY_REACH = 5.0
"""mm; the reach of joints in the iterations with contours."""

MANY_CONTOUR_ITERATIONS = 8

MANY_REGULARIZATION = 0.1
"""Weight of the pull to the frame before: a hidden finger that few joints tell of must not run away."""

ALL_TURNS = (0, 1, 2, 3)

CONTOUR_ITERATIONS = 4
"""Iterations with contours: they are drawn anew in each, and the joints have brought them near."""

EDGE_MARGIN = 0.015
"""m around the scene in which edges are looked for."""

NEAREST = 0.05
"""m before a camera; what is nearer is not drawn."""

MOST = 11
"""So many of the 21 joints are most of a hand."""


def see_hands(
    setup: TrackSetup, cameras: tuple[Camera, ...], frames: Sequence[Frame], posed: PosedScene, gone: set[int]
) -> ViewHands:
    """The hands in all views of a moment, looked for where the pose has them, and in whole images where that fails.

    While two views see every hand, one view a frame is looked through for what it does not see, in turn.

    Args:
        setup: Models and options.
        cameras: Of the views.
        frames: Of the views.
        posed: Where the hands are expected.
        gone: Hands that nobody knows the place of.
    """
    detector = setup.hand_detector
    assert detector is not None, "find_tracking_faults has seen to it"
    names = setup.hand_names
    known = [hand for hand in list_hands(setup) if hand not in gone]
    seen = []
    for camera, frame in zip(cameras, frames, strict=True):
        expected = {setup.names[hand]: _expect(posed, hand, setup.names[hand], camera) for hand in known}
        places = {name: hand for name, hand in expected.items() if hand is not None}
        seen.append(_find(detector, frame, names, places, ()) if places else {})
    for view, frame in enumerate(frames):
        is_scarce = any(sum(name in hands for hands in seen) < min(2, len(cameras)) for name in names)
        if len(seen[view]) < len(names) and (is_scarce or frame.index % len(frames) == view):
            turns = ALL_TURNS if gone else (0, 1 + frame.index % 3)
            seen[view] = _find(detector, frame, names, seen[view], turns)
    return ViewHands(cameras, tuple(seen))


def fit_views(
    setup: TrackSetup, objective: Objective, seen: ViewHands, frames: Sequence[Frame], pose: Array, iterations: int
) -> Fit:
    """Fit the scene from a pose (D,) to what the views saw.

    First far joints alone count, then near ones with what the run's terms add, at last the contours in the images too.
    """
    scene, names = setup.scene, setup.names
    has_many = len(seen.cameras) >= MANY
    if has_many:
        objective = replace(objective, regularization=Regularization(weight=MANY_REGULARIZATION))
    far = seen.add_to(replace(objective, terms={}), scene, names, FAR_REACH)
    first = fit_frame(scene, None, pose, pose, far, FitOptions(iterations=max(1, iterations // 2), fine=0))
    near = seen.add_to(objective, scene, names)
    second = fit_frame(scene, None, first.pose, pose, near, FitOptions(iterations=iterations))
    started = perf_counter()
    last = seen.add_to(objective, scene, names, MANY_REACH) if has_many else near
    drawn = add_contours(last, scene.pose_at(second.pose), seen.cameras, frames)
    stages = {"finding edges": perf_counter() - started}
    count = MANY_CONTOUR_ITERATIONS if has_many else CONTOUR_ITERATIONS
    third = fit_frame(scene, None, second.pose, pose, drawn, FitOptions(iterations=count))
    for fit in (first, second, third):
        for name, seconds in fit.stages.items():
            stages[name] = stages.get(name, 0.0) + seconds
    return Fit(third.pose, (*first.costs, *second.costs, *third.costs), stages)


def add_contours(
    objective: Objective, posed: PosedScene, cameras: Sequence[Camera], frames: Sequence[Frame]
) -> Objective:
    """The objective with the edges of each image near the scene."""
    terms = dict(objective.terms)
    for camera, frame in zip(cameras, frames, strict=True):
        assert frame.color is not None
        points, margin = find_place(posed, camera)
        edges = find_image_edges(frame.color, camera, points, margin) if len(points) else None
        if edges is not None:
            terms[f"contours_{camera.id}"] = Contours(edges)
    return replace(objective, terms=terms)


def find_place(posed: PosedScene, camera: Camera) -> tuple[Array, float]:
    """Where an ideal lens shows the vertices (N, 2) px that are well before a camera, and px of `EDGE_MARGIN` there."""
    points = se3.transform(camera.T_camera_world, posed.vertices)
    points = points[points[:, 2] > NEAREST]
    if not len(points):
        return np.zeros((0, 2)), 0.0
    pixels = points[:, :2] / points[:, 2:] * camera.K[[0, 1], [0, 1]] + camera.K[:2, 2]
    return pixels, EDGE_MARGIN * float(camera.K[0, 0] / np.median(points[:, 2]))


def judge_hand(setup: TrackSetup, seen: ViewHands, posed: PosedScene, hand: int) -> tuple[bool, bool]:
    """Whether a fitted hand is to be believed, and whether it is to be followed from where it is.

    Two views must agree with it to be believed, or one where it is outside of all other images.
    """
    apart = seen.measure(posed, hand, setup.names[hand])
    inside = sum(_is_inside(posed, hand, camera) for camera in seen.cameras)
    is_held = int(np.count_nonzero(apart < HOLDS)) >= min(2, max(1, inside))
    return is_held, is_held or bool(np.any(apart < FOLLOWS))


def _find(
    detector: HandDetector,
    frame: Frame,
    names: tuple[str, ...],
    before: Mapping[str, DetectedHand],
    turns: tuple[int, ...],
) -> dict[str, DetectedHand]:
    assert frame.color is not None
    found = detector.find(frame.color, len(names), [before[name] for name in names if name in before], turns)
    return name_hands(found, names)


def _expect(posed: PosedScene, hand: int, name: str, camera: Camera) -> DetectedHand | None:
    """A hand as its pose says that an image shows it; None where most of it is outside."""
    if not _is_inside(posed, hand, camera):
        return None
    right = 1.0 if name == "right" else 0.0
    return DetectedHand(camera.project(posed.landmarks(hand)), np.zeros((21, 3)), 1.0, right)


def _is_inside(posed: PosedScene, hand: int, camera: Camera) -> bool:
    """Whether most of a hand is in an image."""
    return int(np.count_nonzero(camera.can_see(posed.landmarks(hand)))) >= MOST
