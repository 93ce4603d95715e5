"""Where an object starts: where somebody placed it, else where one of the first frames shows it."""

from __future__ import annotations

import logging
from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.grips import ball, cube
from tests.tracker.scenes import CAMERA, photograph
from tests.tracker.toys import tube
from tracker.capture.frame import Frame
from tracker.capture.recorded_object import RecordedObject
from tracker.errors import TrackingError
from tracker.geometry import se3
from tracker.model.scene import Scene
from tracker.observation import Preprocessing
from tracker.search.find_object import find_object
from tracker.search.start_object import place_object, start_object

BALL, CUBE, ROPE = ball(0.03), cube(), tube(4)
T_WORLD_OBJECT = se3.exp(np.array([0.1, -0.2, 0.5, 0.3, 2.0, -0.4]))
PLACE = np.array([0.02, 0.01, 0.45, 0.0, 0.0, 0.0])
HOW = Preprocessing(bilateral_diameter=0)


def bones_at(pose: np.ndarray) -> np.ndarray:
    return Scene((ROPE,)).pose_at(pose).landmarks(0)


def bent_rope() -> np.ndarray:
    return np.r_[se3.log(T_WORLD_OBJECT), np.tile([0.3, -0.2], 3)]


def told_rope(pose: np.ndarray, bones=ROPE.skeleton.bone_names) -> RecordedObject:
    """The rope's root, and where some of its bones are."""
    joints = dict(zip(ROPE.skeleton.bone_names, bones_at(pose), strict=True))
    return RecordedObject("rope", "rope.glb", T_WORLD_OBJECT, {bone: joints[bone] for bone in bones})


def test_a_rigid_object_is_just_where_it_was_placed_and_frames_are_not_asked():
    item = RecordedObject("cube", "cube.ply", T_WORLD_OBJECT)

    def unread():
        raise AssertionError("no frame is read")
        yield

    pose = start_object(CUBE, item, unread(), HOW, [])
    np.testing.assert_allclose(se3.exp(pose), T_WORLD_OBJECT, atol=1e-12)
    np.testing.assert_array_equal(pose, place_object(CUBE, item))


def test_an_articulated_object_bends_until_its_bones_are_where_they_were_placed():
    found = place_object(ROPE, told_rope(bent_rope()))
    assert np.linalg.norm(bones_at(found) - bones_at(bent_rope()), axis=1).max() < 1e-3
    straight = place_object(ROPE, replace(told_rope(bent_rope()), joints={}))
    np.testing.assert_array_equal(straight[6:], 0.0)


def test_bones_that_nobody_placed_and_the_order_of_those_that_somebody_did_do_not_matter():
    names = ROPE.skeleton.bone_names
    some = place_object(ROPE, told_rope(bent_rope(), names[-2:]))
    other = place_object(ROPE, told_rope(bent_rope(), names[-2:][::-1]))
    np.testing.assert_allclose(some, other, atol=1e-9)
    assert np.linalg.norm(bones_at(some) - bones_at(bent_rope()), axis=1)[-2:].max() < 2e-3
    foreign = told_rope(bent_rope())
    foreign.joints["handle"] = np.zeros(3)
    np.testing.assert_array_equal(place_object(ROPE, foreign), place_object(ROPE, told_rope(bent_rope())))


def test_an_object_that_nobody_placed_or_that_has_other_bones_is_refused_by_name():
    with pytest.raises(TrackingError, match=r"rope: bones \['handle'\]"):
        place_object(ROPE, RecordedObject("rope", "rope.glb", T_WORLD_OBJECT, {"handle": np.zeros(3)}))
    with pytest.raises(
        TrackingError, match=r"ball: it has no place in the first frame; needed `initial\.T_world_object`"
    ):
        place_object(BALL, RecordedObject("ball", "ball.ply"))


def frames(*shown: bool):
    """Frames with the ball, or with nothing."""
    whole = photograph(Scene((BALL,)), PLACE)
    for index, is_shown in enumerate(shown):
        depth = whole.depth if is_shown else np.zeros((240, 320), np.float32)
        yield Frame(index, "cam0", None, depth), CAMERA


def test_an_object_that_nobody_placed_is_found_in_the_first_frame_that_shows_it(caplog):
    item = RecordedObject("ball", "ball.ply")
    rest = frames(False, True, True)
    with caplog.at_level(logging.INFO):
        pose = start_object(BALL, item, rest, HOW, [])
    assert np.linalg.norm(se3.exp(pose)[:3, 3] - PLACE[:3]) < 2e-3
    assert "ball: found in frame 1" in caplog.text
    assert [frame.index for frame, _ in rest] == [2], "frames behind it are not read"


def test_an_object_that_the_first_frame_shows_badly_and_a_later_one_well_starts_from_the_guess_in_the_first(caplog):
    whole = photograph(Scene((BALL,)), PLACE)
    assert whole.depth is not None
    shown = whole.depth.copy()
    shown[70:190, 57:177] = 0.3  # a thing before most of it
    hidden = replace(whole, depth=shown, is_hand=None)
    guess = find_object(BALL, hidden, CAMERA, HOW, [])
    assert guess is not None and not guess.is_believable
    views = ((hidden, CAMERA), (replace(whole, index=1), CAMERA))
    pose = start_object(BALL, RecordedObject("ball", "ball.ply"), views, HOW, [])
    np.testing.assert_array_equal(pose, guess.pose)
    assert "frame 0 shows it too badly" in caplog.text


def test_what_stood_in_the_first_frame_where_the_object_is_later_hides_it_only_then():
    item, place = RecordedObject("ball", "ball.ply"), PLACE + np.r_[0.0, 0.0, 0.01, np.zeros(3)]
    first = photograph(Scene((CUBE,)), PLACE)
    views = ((first, CAMERA), (replace(photograph(Scene((BALL,)), place), index=1), CAMERA))
    pose = start_object(BALL, item, views, HOW, [(CUBE, PLACE)])
    assert np.linalg.norm(se3.exp(pose)[:3, 3] - place[:3]) < 2e-3


def test_an_object_that_no_frame_shows_is_refused_with_the_frames_and_what_to_do():
    with pytest.raises(
        TrackingError, match=r"ball: not found in frames 0, 1: nothing there could be the object"
    ) as refused:
        start_object(BALL, RecordedObject("ball", "ball.ply"), frames(False, False), HOW, [])
    assert "initial.T_world_object" in str(refused.value)
