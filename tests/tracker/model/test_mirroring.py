"""The other hand: reflected once it is the mirror image, twice the hand itself."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from tests.tracker.grips import ball
from tests.tracker.model.mirrored_poses import mirror_pose
from tests.tracker.model.test_npz_files import assert_same
from tests.tracker.random_blend import random_blend
from tracker.model.blend_articulated import articulated_of
from tracker.model.decimation import compute_volume
from tracker.model.default_hand import default_hand
from tracker.model.mirroring import MIRROR, mirror, mirror_name, mirror_pose_directions, mirror_provenance
from tracker.model.scene import Scene


def with_marks(model):
    """The same with joints where some annotator puts them."""
    offsets = 0.004 * np.random.default_rng(0).normal(size=(21, 3))
    return replace(model, hand=replace(model.hand, joint_offsets=offsets))


@pytest.mark.parametrize(
    "model",
    [with_marks(default_hand("right")), articulated_of(random_blend()), ball()],
    ids=["default", "blend", "ball"],
)
def test_mirrored_twice_every_part_is_as_it_was(model) -> None:
    twice = mirror(mirror(model))
    assert_same(replace(twice, provenance=model.provenance), model)


@pytest.mark.parametrize("model", [with_marks(default_hand("left")), ball()], ids=["hand", "ball"])
def test_at_the_mirrored_pose_vertices_joints_and_marks_are_the_mirror_image(model, rng) -> None:
    pose = rng.normal(scale=0.4, size=model.num_dofs)
    posed, other = Scene((model,)).pose_at(pose), Scene((mirror(model),)).pose_at(mirror_pose(pose))
    np.testing.assert_allclose(other.vertices, posed.vertices * MIRROR, atol=1e-9)


def test_a_mirrored_hand_is_of_the_other_side_and_looks_outwards_with_the_same_limits() -> None:
    right = default_hand("right")
    left = mirror(right)
    assert left.hand is not None and left.hand.side == "left" and "left" in left.name.lower()
    assert compute_volume(left.vertices, left.faces) == pytest.approx(compute_volume(right.vertices, right.faces))
    np.testing.assert_array_equal(left.skeleton.lower, right.skeleton.lower)
    np.testing.assert_array_equal(left.skeleton.upper, right.skeleton.upper)
    assert mirror(ball()).hand is None


@settings(max_examples=20)
@given(st.lists(st.floats(-3.0, 3.0), min_size=3, max_size=3))
def test_pose_blend_shapes_of_the_mirrored_hand_answer_the_mirrored_rotation(vector) -> None:
    directions = np.random.default_rng(1).normal(size=(4, 3, 18))
    S = np.diag(MIRROR)
    R = Rotation.from_rotvec(vector).as_matrix()
    features = [np.tile((turn - np.eye(3)).ravel(), 2) for turn in (R, S @ R @ S)]
    mirrored = mirror_pose_directions(directions, MIRROR)
    np.testing.assert_allclose(mirrored @ features[1], (directions @ features[0]) * MIRROR, atol=1e-12)
    np.testing.assert_array_equal(mirror_pose_directions(mirrored, MIRROR), directions)


@pytest.mark.parametrize(
    ("name", "other"),
    [
        ("right hand", "left hand"),
        ("Left glove of anna", "Right glove of anna"),
        ("bright copyright", "bright copyright"),
        ("", ""),
    ],
)
def test_only_whole_words_of_a_name_change_sides(name: str, other: str) -> None:
    assert mirror_name(name) == other
    assert mirror_name(other) == name


def test_the_provenance_tells_a_mirrored_hand_and_keeps_the_rest() -> None:
    told = {"license": "CC0", "file": "hand.npz"}
    once = mirror_provenance(told)
    assert once == {**told, "mirrored": "yes"} and "mirrored" not in told
    assert mirror_provenance(once) == {**told, "mirrored": "no"}
