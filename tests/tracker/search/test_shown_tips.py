"""A finger hidden by a thing is found by its tip that shows beyond it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tracker.capture.camera import Camera
from tracker.capture.frame import Frame
from tracker.fitting.attempt import attempt_fit, look
from tracker.fitting.finger_search import list_finger_angles
from tracker.fitting.frame_fit import FitOptions
from tracker.fitting.objective import Objective
from tracker.fitting.options import TrackOptions
from tracker.fitting.setup import TrackSetup
from tracker.fitting.sighting import Sightings
from tracker.geometry import se3
from tracker.model.default_hand import default_hand
from tracker.model.joints import FINGERS, HAND_JOINTS
from tracker.rendering import render_view
from tracker.search.shown_tips import reach_shown_tips

CAMERA = Camera("cam0", 320, 240, np.array([[240.0, 0, 160], [0, 240.0, 120], [0, 0, 1]]), np.zeros(0), np.eye(4))
MIDDLE = FINGERS.index("middle")


@pytest.fixture(scope="module")
def setup() -> TrackSetup:
    return TrackSetup(("right",), (default_hand("right"),), "cam0", TrackOptions(calibrate=False))


@pytest.fixture(scope="module")
def open_hand(setup) -> np.ndarray:
    """(D,) palm to the camera, fingers up, half a metre away."""
    pose = setup.scene.rest_pose()
    joints = setup.scene.pose_at(pose).landmarks(0)
    up = joints[9] - joints[0]
    up /= np.linalg.norm(up)
    across = joints[5] - joints[17]
    out = np.cross(up, across)
    out /= np.linalg.norm(out)
    R = np.stack([np.cross(-up, out), -up, out])
    T = np.eye(4)
    T[:3, :3] = R
    T[:3, 3] = (0.0, 0.02, 0.5) - R @ joints[9]
    pose[:6] = se3.log(T @ se3.exp(pose[:6]))
    return pose


def photograph(setup: TrackSetup, pose: np.ndarray, covered: slice) -> Frame:
    """The hand, with a thing before its middle finger from some rows (of the image) to others."""
    drawn = render_view(setup.scene.pose_at(pose), CAMERA.K, CAMERA.T_world_camera, 240, 320)
    is_hand = drawn.face >= 0
    depth = np.where(is_hand, 1.0 / np.where(is_hand, drawn.inverse_depth, 1.0), 0.0).astype(np.float32)
    columns = CAMERA.project(setup.scene.pose_at(pose).landmarks(0)[9:13])[:, 0]
    thing = (covered, slice(int(columns.min()) - 9, int(columns.max()) + 10))
    depth[thing], is_hand[thing] = 0.42, False
    return Frame(0, "cam0", None, depth, is_hand=is_hand)


def rows_of_the_middle_finger(setup: TrackSetup, pose: np.ndarray) -> np.ndarray:
    return CAMERA.project(setup.scene.pose_at(pose).landmarks(0))[9:13, 1]


def bend_middle_finger(setup: TrackSetup, pose: np.ndarray) -> np.ndarray:
    """The pose with that finger in the palm."""
    model, bent = setup.models[0], pose.copy()
    far = np.where(-model.skeleton.lower > model.skeleton.upper, model.skeleton.lower, model.skeleton.upper)
    angles = list_finger_angles(model, MIDDLE)
    wide = angles[(model.skeleton.upper - model.skeleton.lower)[angles] > 1.0]
    bent[6 + wide] = 0.9 * far[wide]
    return bent


def test_a_finger_that_was_taken_for_bent_is_laid_out_to_the_tip_that_shows(setup, open_hand):
    knuckle, _, last, _ = rows_of_the_middle_finger(setup, open_hand)
    frame = photograph(setup, open_hand, slice(int(last) + 2, int(knuckle) - 3))
    start = bend_middle_finger(setup, open_hand)
    seen = look(frame, CAMERA, setup, start)
    assert seen is not None
    sightings = Sightings(frame, CAMERA, {}, tells_color=True)
    bent = attempt_fit(setup, seen, start, start, Objective(), FitOptions(), sightings)
    found = reach_shown_tips(setup, seen, bent, Objective(), FitOptions(), sightings)
    assert found is not None and found is not bent
    place = HAND_JOINTS.index("middle_tip")
    truth = setup.scene.pose_at(open_hand).landmarks(0)[place]
    apart = [1e3 * np.linalg.norm(setup.scene.pose_at(fit.pose).landmarks(0)[place] - truth) for fit in (bent, found)]
    assert apart[0] > 25.0  # mm: the fit alone leaves the finger in the palm
    assert apart[1] < 6.0
    assert found.agreement > bent.agreement


def test_where_no_tip_shows_nothing_is_tried(setup, open_hand):
    frame = photograph(setup, open_hand, slice(0, 0))
    seen = look(frame, CAMERA, setup, open_hand)
    assert seen is not None
    sightings = Sightings(frame, CAMERA, {}, tells_color=True)
    best = attempt_fit(setup, seen, open_hand, open_hand, Objective(), FitOptions(), sightings)
    assert reach_shown_tips(setup, seen, best, Objective(), FitOptions(), sightings) is None


def test_a_tip_that_no_finger_reaches_is_left_alone(setup, open_hand):
    frame = photograph(setup, open_hand, slice(0, 0))
    assert frame.depth is not None and frame.is_hand is not None
    top = int(rows_of_the_middle_finger(setup, open_hand).min())
    far = (slice(top - 34, top - 28), slice(20, 26))
    depth, is_hand = frame.depth.copy(), frame.is_hand.copy()
    depth[far], is_hand[far] = 0.5, True
    frame = replace(frame, depth=depth, is_hand=is_hand)
    seen = look(frame, CAMERA, setup, open_hand)
    assert seen is not None
    sightings = Sightings(frame, CAMERA, {}, tells_color=True)
    best = attempt_fit(setup, seen, open_hand, open_hand, Objective(), FitOptions(), sightings)
    assert reach_shown_tips(setup, seen, best, Objective(), FitOptions(), sightings) in (None, best)
