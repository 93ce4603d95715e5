"""Follow both hands through a rendered recording with some of the terms of [T16] Table 15.

The frame is fitted by the tracker's own `fit_views`; without S, where that has no joints to come near with, contours
are looked for farther off first. As in the paper the first pose is given; what was lost is not looked for again. The
swarm gets the same images and joints, and starts each frame where the one before ended.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from time import perf_counter

import cv2
import numpy as np
import numpy.typing as npt

from benchmarks.baselines.swarm_options import SwarmOptions
from benchmarks.baselines.view_swarm import search_views
from benchmarks.rendered_views.setting import TIPS, Setting
from benchmarks.rendered_views.shown import Shown
from tracker.capture.frame import CameraFrame, Frame
from tracker.fitting.choose_views import PLENTY
from tracker.fitting.frame_fit import FitOptions, fit_frame
from tracker.fitting.objective import Objective
from tracker.fitting.options import TrackOptions
from tracker.fitting.setup import TrackSetup
from tracker.fitting.view_contours import ViewContours
from tracker.fitting.view_hands import ViewHands
from tracker.fitting.view_hold import BY_CONTOURS
from tracker.landmarks import DetectedHand
from tracker.model.scene import PosedScene
from tracker.observation.image_flow import find_image_flow
from tracker.synthesis.view_noise import ViewNoise, disturb_image, disturb_joints
from tracker.terms.collision import Collision
from tracker.terms.contours import Contours
from tracker.terms.flow import Flow, follow_surface, join_flows
from tracker.terms.joint_prior import Regularization
from tracker.tracking.fit_views import add_contours, fit_views
from tracker.tracking.see_hands import see_hands
from tracker.tracking.state import TrackState
from tracker.tracking.view_edges import EDGE_MARGIN, find_place
from tracker.tracking.view_objects import judge_objects, list_objects

Array = npt.NDArray[np.float64]

VISIBLE = 2
FAR_EDGE = 0.015
"""m; contours alone look so far for their edges at first."""

IMAGES, JOINTS = 1, 2
"""Streams of chance."""


@dataclass(frozen=True)
class Followed:
    """What one run gave.

    Attributes:
        joints: (T, 42, 3) of the hands, world, m.
        ball: (T, 1, 3) its middle, world, m; (T, 0, 3) where there is none.
        ball_score: (T, 1) as `ContourQuality` has it; (T, 0) likewise.
        seconds: (T,) without reading and disturbing the images.
    """

    joints: Array
    ball: Array
    ball_score: Array
    seconds: Array


def follow(shown: Shown, setting: Setting, moments: range | None = None) -> Followed:
    """Fit the frames one after the other.

    Args:
        shown: The recording.
        setting: What is switched on.
        moments: Consecutive frames; None for all.
    """
    cv2.setNumThreads(1)
    scene, sequence = shown.scene, shown.sequence
    cameras = tuple(sequence.cameras[: setting.cameras])
    options = TrackOptions(calibrate=False, cameras=",".join(camera.id for camera in cameras), use_depth=False)
    setup = TrackSetup(shown.names, scene.models, cameras[0].id, options, view_ids=options.view_ids)
    noise = replace(ViewNoise(), detected=setting.detected) if setting.is_noisy else None
    moments = moments or range(sequence.frame_count)
    first = shown.poses[moments[0]]
    state = TrackState(moments[0], first, first)
    before: tuple[list[Frame], list[npt.NDArray[np.bool_] | None]] | None = None
    joints, balls, scores, seconds = [], [], [], []
    for index in moments:
        frames, covers = _read(shown, cameras, index, noise, setting.seed)
        started = perf_counter()
        predicted = state.pose if setting.particles else state.predict(scene, bends=len(cameras) >= PLENTY)
        objective = Objective(terms={"collision": Collision()} if setting.has("C") else {})
        if setting.has("O") and before is not None:
            flow = _find_flow(scene.pose_at(state.pose), cameras, before, (frames, covers), setting.flow_weight)
            if flow is not None:
                objective = replace(objective, terms={**objective.terms, "flow": flow})
        seen = ViewHands((), ())
        if setting.has("S"):
            seen = _see(shown, setup, setting, cameras, frames, noise, scene.pose_at(predicted))
            followed = {hand: setup.names[hand] for hand in setup.hands}
            seen = seen.without_jumps(scene.pose_at(predicted), followed, sequence.fps)
        if setting.particles:
            how = SwarmOptions(particles=setting.particles, seed=setting.seed)
            pose = search_views(setup, seen, _pair(cameras, frames), predicted, how)
        elif setting.has("S"):
            pose = fit_views(setup, objective, seen, _pair(cameras, frames), predicted, setting.iterations).pose
        else:
            pose = _fit_contours(setup, objective, cameras, frames, predicted, setting.iterations)
        seconds.append(perf_counter() - started)
        state = TrackState(index + 1, pose, state.pose)
        posed = scene.pose_at(pose)
        joints.append(np.concatenate([posed.landmarks(0), posed.landmarks(1)]))
        watched = judge_objects(setup, _pair(cameras, frames), posed)
        balls.append([posed.T_world_model(index)[:3, 3] for index in list_objects(setup)])
        scores.append([one.quality.score for one in watched])
        before = frames, covers
    count = len(joints)
    ball, score = np.reshape(balls, (count, -1, 3)), np.reshape(scores, (count, -1))
    return Followed(np.array(joints), ball, score, np.array(seconds))


def _read(shown: Shown, cameras, index: int, noise: ViewNoise | None, seed: int):
    """The images of a moment, disturbed, and what the disturbance covers."""
    frames, covers = [], []
    for number, camera in enumerate(cameras):
        image, covered = shown.sequence.color(index, camera.id), None
        if noise is not None:
            image, covered = disturb_image(image, noise, np.random.default_rng([seed, IMAGES, index, number]))
        frames.append(Frame(index, camera.id, image, None))
        covers.append(covered)
    return frames, covers


def _pair(cameras, frames) -> list[CameraFrame]:
    return [CameraFrame(camera, frame) for camera, frame in zip(cameras, frames, strict=True)]


def _see(
    shown: Shown, setup: TrackSetup, setting: Setting, cameras, frames, noise: ViewNoise | None, posed: PosedScene
) -> ViewHands:
    """What is detected of the hands."""
    if setting.joints == "sees":
        return see_hands(setup, _pair(cameras, frames), posed, set())
    index, hands = frames[0].index, []
    for number in range(len(cameras)):
        rng = np.random.default_rng([setting.seed, JOINTS, index, number])
        own = {}
        for hand, name in enumerate(("right", "left")):
            where = slice(21 * hand, 21 * hand + 21)
            points = shown.truth.joints_2d[index, number, where].copy()
            is_seen = shown.truth.visibility[index, number, where] == VISIBLE
            points = (
                disturb_joints(points, is_seen, noise, rng) if noise else np.where(is_seen[:, None], points, np.nan)
            )
            if setting.joints == "tips":
                points[np.setdiff1d(np.arange(21), TIPS)] = np.nan
            own[name] = DetectedHand(points, np.zeros((21, 3)), 1.0, float(name == "right"))
        hands.append(own)
    return ViewHands(tuple(cameras), tuple(hands))


def _find_flow(posed: PosedScene, cameras, before, now, weight: float) -> Flow | None:
    """O in all views together; flow that begins or ends in a disc is dropped (§4.4.1)."""
    parts = []
    for number, camera in enumerate(cameras):
        points, margin = find_place(posed.vertices, camera, EDGE_MARGIN)
        first, second = before[1][number], now[1][number]
        covered = None if first is None else first | second
        images = before[0][number].color, now[0][number].color
        flow = find_image_flow(*images, camera, points, margin, covered) if len(points) else None
        if flow is not None:
            parts.append(follow_surface(posed, flow))
    return join_flows(parts, weight) if parts else None


def _fit_contours(setup: TrackSetup, objective: Objective, cameras, frames, pose: Array, iterations: int) -> Array:
    """The pose (D,) by contours without any joint, from far edges to near ones, as far as can be as `fit_views`."""
    scene, start = setup.scene, pose
    objective = replace(objective, regularization=Regularization(weight=BY_CONTOURS.regularization))
    for reach, count in ((FAR_EDGE, iterations), (Contours.max_distance, BY_CONTOURS.iterations)):
        drawn = add_contours(objective, scene.pose_at(pose), _pair(cameras, frames))
        terms = {
            name: term.reaching(reach) if isinstance(term, ViewContours) else term for name, term in drawn.terms.items()
        }
        how = FitOptions(iterations=count)
        pose = fit_frame(scene, None, pose, start, replace(drawn, terms=terms), how).pose
    return pose
