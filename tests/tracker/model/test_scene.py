"""A scene stacks its models: every pose parameter, vertex, face and landmark belongs to one of them, in order."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.toys import tube
from tracker.geometry import se3
from tracker.model.default_hand import default_hand
from tracker.model.scene import Scene

HAND, TUBE = default_hand("right"), tube(3)
SCENE = Scene((TUBE, HAND))


@pytest.mark.parametrize("name", ["pose_slices", "vertex_slices", "bone_slices"])
def test_slices_follow_each_other_without_a_gap(name: str) -> None:
    first, second = getattr(SCENE, name)
    assert first.start == 0 and first.stop == second.start
    alone = getattr(Scene((HAND,)), name)[0]
    assert second.stop - second.start == alone.stop - alone.start


def test_landmarks_stand_behind_the_vertices_of_all_models() -> None:
    tubes, hands = SCENE.landmark_slices
    assert tubes.start == SCENE.vertex_slices[-1].stop and tubes.stop == hands.start
    assert (tubes.stop - tubes.start, hands.stop - hands.start) == (TUBE.skeleton.num_bones, 21)
    posed = SCENE.pose_at(SCENE.rest_pose())
    np.testing.assert_allclose(posed.landmarks(0), TUBE.skeleton.joints_rest, atol=1e-12)
    assert posed.landmarks(1).shape == (21, 3) and len(SCENE.vertex_models) == hands.stop
    assert (SCENE.vertex_models[hands] == 1).all() and (SCENE.vertex_models[tubes] == 0).all()


def test_faces_belong_to_the_model_of_their_vertices() -> None:
    owner = SCENE.vertex_models[SCENE.arrays.faces]
    np.testing.assert_array_equal(owner, np.repeat(SCENE.face_models[:, None], 3, axis=1))
    for number, model in enumerate(SCENE.models):
        assert (SCENE.open_faces[SCENE.face_models == number] != model.is_closed).all()


def test_angles_have_limits_and_roots_have_none() -> None:
    roots = np.concatenate([np.arange(s.start, s.start + 6) for s in SCENE.pose_slices])
    assert np.isinf(SCENE.lower[roots]).all() and np.isinf(SCENE.upper[roots]).all()
    assert (SCENE.lower[SCENE.angle_dofs] < SCENE.upper[SCENE.angle_dofs]).all()
    assert sorted([*roots, *SCENE.angle_dofs]) == list(range(SCENE.num_dofs))


def test_chains_hold_every_parameter_that_moves_a_bone_and_no_other(rng: np.random.Generator) -> None:
    pose = 0.2 * rng.normal(size=SCENE.num_dofs)
    before = SCENE.pose_at(pose).Ms
    for dof in range(SCENE.num_dofs):
        moved = pose.copy()
        moved[dof] += 0.1
        is_moved = np.abs(SCENE.pose_at(moved).Ms - before).max(axis=(1, 2)) > 1e-12
        np.testing.assert_array_equal(is_moved, (SCENE.arrays.chains == dof).any(axis=1), err_msg=str(dof))


def test_pairs_of_bones_are_those_with_weight_on_a_common_face() -> None:
    pairs, places = SCENE.bone_pairs
    assert (pairs[:, 0] <= pairs[:, 1]).all() and (places == places.T).all()
    np.testing.assert_array_equal(places[pairs[:, 0], pairs[:, 1]], np.arange(len(pairs)))
    arrays = SCENE.arrays
    for face in arrays.faces[:: len(arrays.faces) // 60]:
        bones = np.unique(arrays.weight_bones[face][arrays.weights[face] > 0])
        assert (places[np.ix_(bones, bones)] >= 0).all()
    across = places[SCENE.bone_slices[0], SCENE.bone_slices[1]]
    assert (across == -1).all(), "models share no face"


def test_a_step_and_back_is_no_step_and_a_root_turns_about_its_joint(rng: np.random.Generator) -> None:
    pose = 0.3 * rng.normal(size=SCENE.num_dofs)
    for where in SCENE.pose_slices:
        step = np.zeros(SCENE.num_dofs)
        step[where.start + 3 : where.start + 6] = 0.4 * rng.normal(size=3)
        turned = SCENE.retract(pose, step)
        np.testing.assert_allclose(SCENE.retract(turned, -step), pose, atol=1e-9)
        model = SCENE.pose_slices.index(where)
        joint = SCENE.models[model].skeleton.joints_rest[0]
        before, after = (se3.transform(se3.exp(p[where.start : where.start + 6]), joint) for p in (pose, turned))
        np.testing.assert_allclose(before, after, atol=1e-12)


def test_joints_of_an_object_that_turn_about_one_axis_are_pairs_and_those_of_a_hand_are_not() -> None:
    bends = SCENE.bends
    assert len(bends) and (bends < SCENE.pose_slices[0].stop).all()
    axes = TUBE.skeleton.dof_axes[bends - 6]
    np.testing.assert_allclose(np.einsum("kx,kx->k", axes[:, 0], axes[:, 1]), 1.0, atol=1e-3)
    assert Scene((HAND,)).bends.shape == (0, 2)


def test_the_palm_is_a_hands_alone() -> None:
    assert not SCENE.is_palm[SCENE.vertex_slices[0]].any()
    share = SCENE.is_palm[SCENE.vertex_slices[1]].mean()
    assert 0.05 < share < 0.6


def test_a_vertex_keeps_its_heaviest_bones_and_their_weights_sum_to_one() -> None:
    weights = np.tile([0.3, 0.25, 0.2, 0.15, 0.1], (len(tube(5).vertices), 1))
    arrays = Scene((replace(tube(5), skinning_weights=weights),)).arrays
    own = arrays.weights[: len(weights)]
    np.testing.assert_allclose(own.sum(axis=1), 1.0, atol=1e-12)
    assert set(np.unique(arrays.weight_bones[: len(weights)][own > 0])) == {0, 1, 2, 3}, "the fifth is the lightest"
