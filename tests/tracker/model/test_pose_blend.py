"""Pose blend shapes, flat for the kernels, with what moves next to nothing left out."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from tracker.model.pose_blend import LARGEST_CHANGE, PoseBlend, join_pose_blends, stack_pose_blend
from tracker.model.skinning import add_pose_blend

PARENTS = np.array([-1, 0, 0, 0])


def apply(arrays, local: np.ndarray, count: int) -> np.ndarray:
    """(count, 3) what is added at the local rotations (3, 3, 3) of bones 1, 2 and 3."""
    Ts = np.zeros((4, 3, 4))
    Ts[:, :, :3] = np.concatenate([np.eye(3)[None], local])
    rest = np.zeros((count, 3))
    add_pose_blend(rest, Ts, PARENTS, arrays)
    return rest


def draw(seed: int, scale: float) -> tuple[np.ndarray, np.ndarray]:
    """Directions (5, 3, 27) of very different sizes, and three rotations."""
    rng = np.random.default_rng(seed)
    directions = scale * rng.normal(size=(5, 3, 3, 9)) * 10.0 ** rng.uniform(-3, 0, (5, 1, 3, 1))
    return directions.reshape(5, 3, 27), Rotation.random(3, rng=rng).as_matrix()


@settings(max_examples=25)
@given(st.integers(0, 10_000))
def test_what_is_left_out_as_negligible_moves_no_vertex_by_more_in_any_pose(seed: int) -> None:
    directions, local = draw(seed, 1e-3)
    negligible = 1e-4
    bones = np.array([1, 2, 3])
    whole, kept = stack_pose_blend(directions, bones), stack_pose_blend(directions, bones, negligible=negligible)
    left_out = np.diff(whole.starts) - np.diff(kept.starts)
    away = np.linalg.norm(apply(whole, local, 5) - apply(kept, local, 5), axis=1)
    assert (away <= negligible * left_out).all()
    np.testing.assert_array_equal(away[left_out == 0], 0.0)


def test_no_rotation_changes_more_than_half_a_turn() -> None:
    turns = Rotation.random(500, rng=np.random.default_rng(0)).as_matrix()
    assert np.linalg.norm(turns - np.eye(3), axis=(1, 2)).max() <= LARGEST_CHANGE
    half = Rotation.from_rotvec([0.0, np.pi, 0.0]).as_matrix()
    assert np.linalg.norm(half - np.eye(3)) == pytest.approx(LARGEST_CHANGE)


def test_the_offset_is_linear_in_the_elements_of_the_rotation_less_the_identity() -> None:
    directions, local = draw(1, 1.0)
    plain = directions @ (local - np.eye(3)).ravel()
    np.testing.assert_allclose(apply(stack_pose_blend(directions, np.array([1, 2, 3])), local, 5), plain, atol=1e-12)
    assert not apply(stack_pose_blend(directions, np.array([1, 2, 3])), np.tile(np.eye(3), (3, 1, 1)), 5).any()


def test_in_whatever_order_bones_are_named_their_blocks_go_with_them() -> None:
    directions, local = draw(2, 1.0)
    order = [2, 0, 1]
    shuffled = directions.reshape(5, 3, 3, 9)[:, :, order].reshape(5, 3, 27)
    found = apply(stack_pose_blend(shuffled, np.array([1, 2, 3])[order]), local, 5)
    np.testing.assert_allclose(found, apply(stack_pose_blend(directions, np.array([1, 2, 3])), local, 5), atol=1e-12)


def test_joined_parts_are_what_one_stack_of_all_of_them_is() -> None:
    directions, local = draw(3, 1.0)
    bones, places = np.array([1, 2, 3]), np.array([7, 0, 3, 5, 2])
    parts = [stack_pose_blend(directions[s], bones, places[s]) for s in (slice(2), slice(2, 2), slice(2, 5))]
    joined, whole = join_pose_blends(parts), stack_pose_blend(directions, bones, places)
    for name in whole._fields:
        np.testing.assert_array_equal(getattr(joined, name), getattr(whole, name), err_msg=name)
    found = apply(joined, local, 8)
    np.testing.assert_allclose(found[places], directions @ (local - np.eye(3)).ravel(), atol=1e-12)
    assert not found[[1, 4, 6]].any()


def test_blend_shapes_of_no_bone_add_nothing_and_a_block_too_few_is_refused() -> None:
    nothing = stack_pose_blend(np.zeros((5, 3, 0)), np.zeros(0, dtype=np.int64))
    assert not apply(nothing, draw(4, 1.0)[1], 5).any() and nothing.starts.tolist() == [0] * 6
    with pytest.raises(AssertionError, match=r"\(5, 3, 18\)"):
        PoseBlend(np.array([1, 2, 3]), np.zeros((5, 3, 18)))
