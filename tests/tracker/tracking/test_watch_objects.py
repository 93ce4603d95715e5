"""A followed object is judged in every frame: believed, hidden, lost, and found again."""

from __future__ import annotations

import numpy as np
import pytest

from tests.tracker.search.drawn_objects import CAMERA, draw_frame, hand_pose, load_mesh, surface_error
from tests.tracker.search.test_find_object import PLACE, place
from tracker.fitting.frame_fit import draw
from tracker.fitting.object_quality import measure_object_quality
from tracker.fitting.options import TrackOptions
from tracker.fitting.region import region_around
from tracker.fitting.setup import TrackSetup
from tracker.model.default_hand import default_hand
from tracker.model.scene import Scene
from tracker.observation import observe
from tracker.tracking.watch_objects import stop_unseen, watch_objects

TURN = np.array([0.4, 0.3, 0.1])


@pytest.fixture(params=[True, False], ids=["by colour", "by depth alone"])
def coloured(request) -> bool:
    return request.param


def judge(tmp_path, name, true, believed, coloured, index=0, recover=True, hands_known=True):
    """What `watch_objects` makes of an object that is at `true` and believed to be elsewhere."""
    model = load_mesh(tmp_path, name)
    drawn = draw_frame(model, true(model), coloured, index)
    setup = TrackSetup(("right", name), (drawn.hand, model), "cam0", TrackOptions())
    pose = np.r_[drawn.hand_pose, believed(model)]
    scene = Scene(setup.models)
    region = region_around(scene.pose_at(pose).vertices, CAMERA)
    assert region is not None
    seen = observe(drawn.frame, CAMERA, region, setup.preprocessing)
    known = {1: measure_object_quality(draw(scene.pose_at(pose), seen), seen, 1)} if hands_known else None
    after, watched = watch_objects(drawn.frame, CAMERA, setup, pose, known, recover)
    return model, setup, pose, after, watched[0]


def here(model):
    return place(model, TURN)


def aside(model):
    return place(model, TURN, PLACE + np.array([0.02, -0.08, 0.0]))


def test_where_it_should_be_it_is_believed_and_not_moved(tmp_path, coloured):
    _, _, pose, after, one = judge(tmp_path, "box", here, here, coloured)
    assert one.status == "ok"
    assert one.quality.score > 0.9
    assert np.array_equal(pose, after)


def test_eight_centimetres_aside_it_is_lost(tmp_path, coloured):
    _, _, pose, after, one = judge(tmp_path, "box", here, aside, coloured, recover=False)
    assert one.status == "lost"
    assert np.array_equal(pose, after)


@pytest.mark.parametrize("index", [0, 2], ids=["in the whole image", "near its last place"])
def test_it_is_found_again_and_the_hand_is_left_alone(tmp_path, coloured, index):
    model, setup, pose, after, one = judge(tmp_path, "box", here, aside, coloured, index)
    assert one.status == "recovered"
    own = setup.scene.pose_slices[1]
    assert surface_error(model, after[own], here(model)) < 2e-3  # m
    assert np.array_equal(after[: own.start], pose[: own.start])


def test_it_is_found_without_knowing_where_the_hands_are(tmp_path):
    model, setup, _, after, one = judge(tmp_path, "box", here, aside, coloured=True, hands_known=False)
    assert one.status == "recovered"
    assert surface_error(model, after[setup.scene.pose_slices[1]], here(model)) < 2e-3  # m


def test_an_object_that_is_gone_is_lost_and_not_put_anywhere(tmp_path, coloured):
    gone = lambda model: place(model, TURN, np.array([0.0, 0.0, -1.0]))  # noqa: E731
    _, _, pose, after, one = judge(tmp_path, "box", gone, here, coloured)
    assert one.status == "lost"
    assert np.array_equal(pose, after)


def test_behind_a_hand_it_is_hidden_not_lost(tmp_path):
    hand = default_hand("right")
    palm = Scene((hand,)).pose_at(hand_pose(hand)).landmarks(0)[[0, 5, 9, 17]].mean(axis=0)
    ball = lambda model: place(model, TURN, 1.12 * palm)  # noqa: E731
    _, _, pose, after, one = judge(tmp_path, "ball", ball, ball, coloured=True)
    assert one.status == "hidden"
    assert np.array_equal(pose, after)


def test_what_was_not_followed_does_not_go_on_moving(tmp_path):
    _, setup, pose, after, one = judge(tmp_path, "box", here, aside, coloured=True)
    own = setup.scene.pose_slices[1]
    earlier = stop_unseen(setup, after, pose - 0.01, [one])
    assert np.array_equal(earlier[own], after[own])
    assert np.array_equal(earlier[: own.start], (pose - 0.01)[: own.start])
