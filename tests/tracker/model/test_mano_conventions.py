"""Ways of programs around MANO: parameters in, vertices and joints out."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.random_blend import random_blend, random_pose
from tracker.model.blend_model import BLEND_JOINTS
from tracker.model.mano_conventions import (
    CONVENTIONS,
    OPENPOSE_ORDER,
    SMPLH_TIP_VERTICES,
    TIP_VERTICES,
    ManoConvention,
    pose_of_parameters,
    present,
)

MODEL = random_blend()
POSED = MODEL.pose_at(*random_pose(MODEL))


@pytest.mark.parametrize("name", CONVENTIONS)
def test_every_named_convention_names_known_tips_and_a_joint_that_it_gives(name: str) -> None:
    convention = CONVENTIONS[name]
    assert convention.tips in TIP_VERTICES
    joints = present(POSED, convention)[1]
    assert len(joints) == (21 if convention.with_tips else 16)
    if convention.center_joint is not None:
        np.testing.assert_array_equal(joints[convention.center_joint], np.zeros(3))


@pytest.mark.parametrize("joint", [0, 4, 9])
@pytest.mark.parametrize("with_tips", [True, False])
def test_the_centre_is_a_joint_of_the_order_that_comes_out_and_is_taken_off_vertices_too(joint, with_tips) -> None:
    plain = present(POSED, ManoConvention(with_tips=with_tips))
    centred = present(POSED, ManoConvention(with_tips=with_tips, center_joint=joint, units_per_metre=10.0))
    for without, off in zip(plain, centred, strict=True):
        np.testing.assert_allclose(off, 10.0 * (without - plain[1][joint]), atol=1e-12)


def test_without_tips_joints_are_mano_s_and_with_them_the_tips_come_fourth() -> None:
    np.testing.assert_array_equal(present(POSED, ManoConvention())[1], POSED.joints)
    joints = present(POSED, ManoConvention(with_tips=True))[1]
    np.testing.assert_array_equal(joints[4::4], POSED.vertices[MODEL.tips])
    np.testing.assert_array_equal(joints[5:8], POSED.joints[[BLEND_JOINTS.index(f"index{n}") for n in (1, 2, 3)]])
    assert sorted(OPENPOSE_ORDER) == list(range(21))


def test_what_is_presented_leaves_the_posed_hand_as_it_is() -> None:
    before = POSED.vertices.copy(), POSED.joints.copy()
    present(POSED, CONVENTIONS["manopth"])
    np.testing.assert_array_equal(POSED.vertices, before[0])
    np.testing.assert_array_equal(POSED.joints, before[1])


@pytest.mark.parametrize("flat", [True, False])
def test_45_numbers_are_rotation_vectors_and_the_same_coefficients_go_through_the_pose_space(flat, rng) -> None:
    orient, values = rng.normal(size=3), rng.normal(size=45)
    mean = np.zeros(45) if flat else MODEL.pose_mean
    whole = pose_of_parameters(MODEL, values, orient, ManoConvention(flat, 45))
    assert whole.shape == (16, 3)
    np.testing.assert_allclose(whole.ravel(), np.r_[orient, values + mean], atol=1e-12)
    few = pose_of_parameters(MODEL, values[:10], orient, ManoConvention(flat, 10))
    np.testing.assert_allclose(few.ravel(), np.r_[orient, values[:10] @ MODEL.pose_components[:10] + mean], atol=1e-12)


def test_fewer_coefficients_than_a_convention_has_are_those_of_the_first_components(rng) -> None:
    values = rng.normal(size=4)
    short = pose_of_parameters(MODEL, values, np.zeros(3), ManoConvention(num_components=15))
    padded = pose_of_parameters(MODEL, np.r_[values, np.zeros(11)], np.zeros(3), ManoConvention(num_components=15))
    np.testing.assert_allclose(short, padded, atol=1e-12)


@pytest.mark.parametrize("tips", TIP_VERTICES)
def test_tips_are_five_vertices_of_the_778_for_each_side(tips: str) -> None:
    assert set(TIP_VERTICES[tips]) == {"right", "left"}
    for vertices in TIP_VERTICES[tips].values():
        assert len(set(vertices)) == 5 and min(vertices) >= 0 and max(vertices) < 778
    assert not set(SMPLH_TIP_VERTICES["right"]) & set(SMPLH_TIP_VERTICES["left"])


def test_a_convention_is_changed_by_a_copy() -> None:
    mine = replace(CONVENTIONS["manotorch"], units_per_metre=100.0)
    np.testing.assert_allclose(present(POSED, mine)[0], 100.0 * present(POSED, CONVENTIONS["manotorch"])[0])
    assert CONVENTIONS["manotorch"].units_per_metre == 1.0
