"""A scene comes to where it was drawn: in any world, with one thread or two, and not beyond the limits of a step."""

from __future__ import annotations

import numpy as np
import pytest

from tests.tracker.grips import ball
from tests.tracker.scenes import DrawnScene, drawn_tube, move_pose
from tracker.fitting.frame_fit import FitOptions, fit_frame, fit_from_afar, label_scene
from tracker.fitting.objective import Objective
from tracker.geometry import se3
from tracker.model.default_hand import default_hand
from tracker.model.scene import Scene
from tracker.observation import HAND, OTHER
from tracker.terms.joint_prior import Bending, Regularization


@pytest.fixture(scope="module")
def drawn() -> DrawnScene:
    return drawn_tube()


def fit(drawn: DrawnScene, start: np.ndarray, options: FitOptions, objective: Objective | None = None):
    return fit_frame(drawn.scene, drawn.observation, start, start, objective or Objective(), options)


def error(drawn: DrawnScene, pose: np.ndarray) -> float:
    """Of the surface, mean, m."""
    one, other = (drawn.scene.pose_at(each).vertices for each in (pose, drawn.pose))
    return float(np.linalg.norm(one - other, axis=1).mean())


def test_a_scene_comes_to_where_it_was_drawn_and_its_cost_goes_down(drawn, rng):
    start = drawn.disturbed(rng)
    found = fit(drawn, start, FitOptions(iterations=15, fine=15))
    assert error(drawn, start) > 5e-3 and error(drawn, found.pose) < 1.5e-3
    costs = [sum(each.values()) for each in found.costs]
    assert len(costs) == 15 and costs[-1] < 0.2 * costs[0]


def test_a_world_that_is_turned_and_moved_with_its_camera_has_the_same_fit(drawn, rng):
    T = se3.exp(np.array([0.4, 1.0, -2.0, 0.5, -1.2, 2.0]))
    there = drawn_tube(T)
    start = drawn.disturbed(rng)
    one = fit(drawn, start, FitOptions(iterations=10)).pose
    other = fit(there, move_pose(there.scene, T, start), FitOptions(iterations=10)).pose
    back = move_pose(there.scene, se3.inverse(T), other)
    apart = drawn.scene.pose_at(back).vertices - drawn.scene.pose_at(one).vertices
    assert np.linalg.norm(apart, axis=1).mean() < 5e-4


def test_two_threads_come_to_where_one_does_and_each_comes_there_again_to_the_last_bit(drawn, rng):
    start = drawn.disturbed(rng)
    one, two = (fit(drawn, start, FitOptions(iterations=6, threads=threads)) for threads in (1, 2))
    np.testing.assert_allclose(two.pose, one.pose, atol=1e-6)
    assert [list(each) for each in two.costs] == [list(each) for each in one.costs]
    for threads, before in ((1, one), (2, two)):
        np.testing.assert_array_equal(fit(drawn, start, FitOptions(iterations=6, threads=threads)).pose, before.pose)
    assert set(one.stages) == set(two.stages) == {"posing", "rendering", "solving", *Objective().terms}


@pytest.mark.parametrize(("max_turn", "max_shift"), [(0.01, 0.002), (1e-9, 0.05), (0.4, 1e-9)])
def test_no_step_turns_or_shifts_anything_by_more_than_it_may(drawn, rng, max_turn, max_shift):
    start = drawn.disturbed(rng, 0.2, 0.02)
    options = FitOptions(iterations=1, max_turn=max_turn, max_shift=max_shift)
    found = fit(drawn, start, options).pose
    assert np.abs(found[6:] - start[6:]).max() <= max_turn * (1 + 1e-9)
    centers = [drawn.scene.pose_at(pose).landmarks(0)[0] for pose in (found, start)]
    assert np.abs(centers[0] - centers[1]).max() <= max_shift * (1 + 1e-9)


def test_a_fit_without_iterations_is_its_start_and_one_at_rest_stops_early(drawn):
    none = fit(drawn, drawn.pose, FitOptions(iterations=0))
    np.testing.assert_array_equal(none.pose, drawn.pose)
    assert none.costs == ()
    assert len(fit(drawn, drawn.pose, FitOptions(iterations=20, stop_below=1e-3)).costs) == 2
    assert len(fit(drawn, drawn.pose, FitOptions(iterations=20, stop_below=0.0)).costs) == 20


def test_what_holds_an_angle_to_the_frame_before_is_that_frames_angle_and_not_the_starts(drawn, rng):
    start = drawn.disturbed(rng)
    stiff = Objective({}, regularization=Regularization(1.0), bending=Bending(0.0))
    found = fit_frame(drawn.scene, None, start, drawn.pose, stiff, FitOptions(iterations=20)).pose
    np.testing.assert_allclose(found[6:], drawn.pose[6:], atol=1e-3)
    np.testing.assert_allclose(found[:6], start[:6], atol=1e-9)


def test_from_afar_a_scene_comes_back_that_is_out_of_the_usual_reach(drawn):
    start = drawn.scene.retract(drawn.pose, np.r_[0.02, -0.015, 0.025, np.zeros(drawn.scene.num_dofs - 3)])
    far = fit_from_afar(drawn.scene, drawn.observation, start, Objective.wide(0.05, 2.0), 15)
    assert error(drawn, far) < 0.25 * error(drawn, start)


def test_vertices_and_faces_of_hands_match_skin_and_those_of_objects_the_rest_in_either_order():
    hand, thing = default_hand("right"), ball()
    for models in ((hand, thing), (thing, hand)):
        scene = Scene(models)
        vertices, faces = label_scene(scene)
        assert len(vertices) == scene.landmark_slices[-1].stop and len(faces) == len(scene.face_models)
        for index, model in enumerate(models):
            bit = HAND if model is hand else OTHER
            assert np.all(vertices[scene.vertex_slices[index]] == bit)
            assert np.all(vertices[scene.landmark_slices[index]] == bit)
            assert np.all(faces[scene.face_models == index] == bit)
