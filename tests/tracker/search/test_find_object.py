"""Objects that nobody placed are found, whatever their form, or said not to be there."""

from __future__ import annotations

import numpy as np
import pytest

from tests.tracker.search.drawn_objects import CAMERA, draw_frame, load_mesh, surface_error
from tracker.capture.recorded_object import RecordedObject
from tracker.errors import TrackingError
from tracker.geometry import se3
from tracker.model.scene import Scene
from tracker.observation import Preprocessing
from tracker.search.find_object import find_object
from tracker.search.start_object import start_object

PLACE = np.array([0.10, 0.02, 0.45])


def place(model, turn: np.ndarray, at: np.ndarray = PLACE) -> np.ndarray:
    T = se3.exp(np.r_[0.0, 0.0, 0.0, turn])
    T[:3, 3] = at - T[:3, :3] @ model.skeleton.joints_rest[0]
    return se3.log(T)


@pytest.mark.parametrize("coloured", [True, False], ids=["by colour", "by depth alone"])
@pytest.mark.parametrize("name", ["ball", "box", "cone", "bracket"])
def test_a_mesh_is_found_beside_a_hand_within_two_millimetres(tmp_path, name, coloured):
    model = load_mesh(tmp_path, name)
    rng = np.random.default_rng(5)
    for _ in range(3):
        true = place(model, rng.normal(size=3), PLACE + 0.01 * rng.normal(size=3))
        drawn = draw_frame(model, true, coloured)
        others = [(drawn.hand, drawn.hand_pose)]
        found = find_object(model, drawn.frame, CAMERA, Preprocessing(), others)
        assert found is not None and found.is_believable
        assert surface_error(model, found.pose, true) < 2e-3  # m


def test_an_object_on_a_table_is_found(tmp_path):
    model = load_mesh(tmp_path, "bracket")
    true = place(model, np.array([0.3, 0.4, 0.2]))
    drawn = draw_frame(model, true, coloured=True, table=0.60)
    found = find_object(model, drawn.frame, CAMERA, Preprocessing(), [(drawn.hand, drawn.hand_pose)])
    assert found is not None and found.is_believable
    assert surface_error(model, found.pose, true) < 2e-3  # m


def test_a_recorded_place_is_taken_as_it_is_and_no_frame_is_read(tmp_path):
    model = load_mesh(tmp_path, "box")
    T = se3.exp(np.r_[0.1, 0.2, 0.5, 0.3, -0.2, 0.9])

    def never():
        raise AssertionError("a frame was read")
        yield

    pose = start_object(model, RecordedObject("box", "box.ply", T), never(), Preprocessing(), [])
    np.testing.assert_allclose(Scene((model,)).pose_at(pose).T_world_model(0), T, atol=1e-12)


@pytest.mark.parametrize("coloured", [True, False], ids=["by colour", "by depth alone"])
def test_what_is_not_there_is_refused_with_the_facts(tmp_path, coloured):
    model = load_mesh(tmp_path, "bracket")
    drawn = draw_frame(model, place(model, np.zeros(3), np.array([0.0, 0.0, -1.0])), coloured)
    views, others = [(drawn.frame, CAMERA)], [(drawn.hand, drawn.hand_pose)]
    with pytest.raises(TrackingError, match=r"bracket: not found in frames 0: .*Needed: .*initial\.T_world_object"):
        start_object(model, RecordedObject("bracket", "bracket.ply"), views, Preprocessing(), others)


def test_a_ball_is_not_taken_for_a_bracket(tmp_path):
    ball, model = load_mesh(tmp_path, "ball"), load_mesh(tmp_path, "bracket")
    drawn = draw_frame(ball, place(ball, np.array([0.4, 0.3, 0.1])), coloured=True)
    views, others = [(drawn.frame, CAMERA)], [(drawn.hand, drawn.hand_pose)]
    with pytest.raises(TrackingError, match="not found"):
        start_object(model, RecordedObject("bracket", "bracket.ply"), views, Preprocessing(), others)


def test_a_doubtful_find_is_told(tmp_path, caplog):
    box, model = load_mesh(tmp_path, "box"), load_mesh(tmp_path, "ball")
    drawn = draw_frame(box, place(box, np.array([0.4, 0.3, 0.1])), coloured=True)
    others = [(drawn.hand, drawn.hand_pose)]
    start_object(model, RecordedObject("ball", "ball.ply"), [(drawn.frame, CAMERA)], Preprocessing(), others)
    assert any("ball: found in frame 0" in r.message and r.levelname == "WARNING" for r in caplog.records)


def test_an_object_seen_later_starts_from_a_guess(tmp_path):
    model = load_mesh(tmp_path, "box")
    true = place(model, np.array([0.4, 0.3, 0.1]))
    away = draw_frame(model, place(model, np.zeros(3), np.array([0.0, 0.0, -1.0])), coloured=True)
    there = draw_frame(model, true, coloured=True, index=5)
    views = [(away.frame, CAMERA), (there.frame, CAMERA)]
    pose = start_object(model, RecordedObject("box", "b"), views, Preprocessing(), [(away.hand, away.hand_pose)])
    assert surface_error(model, pose, true) < 2e-3  # m
