"""Fit a scene to what several views saw at one moment, and judge each hand."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from time import perf_counter

import numpy as np
import numpy.typing as npt

from tracker.capture.frame import CameraFrame
from tracker.fitting.attempt import UNSETTLED
from tracker.fitting.depth_view import DepthView
from tracker.fitting.frame_fit import Fit, FitOptions, draw, fit_frame
from tracker.fitting.measure_quality import measure_quality
from tracker.fitting.objective import Objective
from tracker.fitting.region import choose_stride, region_around
from tracker.fitting.setup import TrackSetup
from tracker.fitting.sighting import find_hand_pixels
from tracker.fitting.view_contours import ViewContours
from tracker.fitting.view_hands import FOLLOWS, HOLDS, REACH, ViewHands
from tracker.fitting.view_hold import choose_hold
from tracker.model.scene import PosedScene
from tracker.observation import observe
from tracker.terms.contours import Contours
from tracker.terms.joint_prior import Regularization
from tracker.terms.marked_joints import MarkedJoints
from tracker.terms.residual import Term
from tracker.tracking.see_hands import is_inside
from tracker.tracking.view_edges import EDGE_MARGIN, find_edges
from tracker.tracking.view_objects import find_object_contours

Array = npt.NDArray[np.float64]

FAR_REACH = 4.0 * REACH
"""mm; the first iterations of a frame hear joints from farther off, where a hand moved fast."""

BESIDE_JOINTS = 0.2
"""Share of their weights that the terms of depth have beside detected joints. Of 0.2, 1 and 10 this one follows
`d405_take001` farthest (112, 105 and 93 of 126 frames, depth by stereo matching) and nearest to its marks."""


def fit_views(
    setup: TrackSetup, objective: Objective, seen: ViewHands, views: Sequence[CameraFrame], pose: Array, iterations: int
) -> Fit:
    """Fit the scene from a pose (D,) to what the views saw.

    First far joints alone count, then near ones with depth images, the contours of objects and what the run's terms
    add, at last all contours in colour images.
    """
    scene, names = setup.scene, setup.names
    hold = choose_hold(seen)
    objective = replace(objective, regularization=Regularization(weight=hold.regularization))
    far = seen.add_to(replace(objective, terms={}), scene, names, FAR_REACH)
    first = fit_frame(scene, None, pose, pose, far, FitOptions(iterations=max(1, iterations // 2), fine=0))
    started = perf_counter()
    near = compose_near(objective, setup, seen, views, scene.pose_at(first.pose))
    stages = {"preparing depth": perf_counter() - started}
    objects = find_object_contours(setup, views, scene.pose_at(first.pose))
    held = near if objects is None else replace(near, terms=near.terms | {"objects": objects})
    second = fit_frame(scene, None, first.pose, pose, held, FitOptions(iterations=iterations))
    started = perf_counter()
    last = seen.add_to(near, scene, names, hold.reach)
    drawn = add_contours(last, scene.pose_at(second.pose), views, setup.options.threads)
    stages["finding edges"] = perf_counter() - started
    count = FitOptions(iterations=hold.iterations)
    third = fit_frame(scene, None, second.pose, pose, drawn, count)
    settled = leave_to_depth(drawn, scene.pose_at(third.pose))
    if settled is not None:
        third = fit_frame(scene, None, third.pose, pose, settled, count)
    for fit in (first, second, third):
        for name, seconds in fit.stages.items():
            stages[name] = stages.get(name, 0.0) + seconds
    return Fit(third.pose, (*first.costs, *second.costs, *third.costs), stages)


def add_contours(objective: Objective, posed: PosedScene, views: Sequence[CameraFrame], threads: int = 1) -> Objective:
    """The objective with the edges of each image near the scene."""
    edges = find_edges(posed.vertices, views, EDGE_MARGIN, threads)
    own = ViewContours({camera_id: Contours(seen) for camera_id, seen in edges.items()}, threads)
    return replace(objective, terms=objective.terms | {"contours": own})


def compose_near(
    objective: Objective, setup: TrackSetup, seen: ViewHands, views: Sequence[CameraFrame], posed: PosedScene
) -> Objective:
    """The objective with the joints of all views and the depth images of those that have some, around the scene."""
    depths: dict[str, Term] = {}
    for camera, frame in ((view.camera, view.frame) for view in views):
        region = None if frame.depth is None else region_around(posed.vertices, camera)
        if region is None:
            continue
        hands = seen.of_camera(camera.id)
        if len(hands) == len(setup.hand_names):
            frame = replace(
                frame, is_hand=find_hand_pixels(frame, camera, {name: hand.points for name, hand in hands.items()})
            )
        observation = observe(frame, camera, region, setup.preprocessing, choose_stride(region, camera))
        depths[f"depth_{camera.id}"] = DepthView.of(observation, BESIDE_JOINTS)
    near = seen.add_to(objective, setup.scene, setup.names)
    return replace(near, terms=near.terms | depths)


def leave_to_depth(objective: Objective, posed: PosedScene) -> Objective | None:
    """The objective without detected joints where depth images settle all hands; None where they do not, or are none.

    A joint that the detector tells is some pixels off: a hand that the depth shows wherever it is drawn needs none.
    """
    depths = {name: term for name, term in objective.terms.items() if isinstance(term, DepthView)}
    hands = [index for index, model in enumerate(posed.scene.models) if model.hand]
    for depth in depths.values():
        drawn = draw(posed, depth.observation)
        if any(measure_quality(drawn, depth.observation, hand).misfit > UNSETTLED for hand in hands):
            return None
    if not depths:
        return None
    terms = {name: term for name, term in objective.terms.items() if not isinstance(term, MarkedJoints)}
    whole = {name: DepthView.of(depth.observation, 1.0) for name, depth in depths.items()}
    return replace(objective, terms=terms | whole)


def judge_hand(setup: TrackSetup, seen: ViewHands, posed: PosedScene, hand: int) -> tuple[bool, bool]:
    """Whether a fitted hand is to be believed, and whether it is to be followed from where it is.

    Two views must agree with it to be believed, or one where it is outside of all other images. A hand that is outside
    of all of them is not.
    """
    apart = seen.measure(posed, hand, setup.names[hand])
    inside = sum(is_inside(posed, hand, camera) for camera in seen.cameras)
    is_held = inside > 0 and int(np.count_nonzero(apart < HOLDS)) >= min(2, inside)
    return is_held, is_held or bool(np.any(apart < FOLLOWS))
