"""Bones of a T16 model at rest: from the motion beside it, or from its mesh, weights and lengths."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tests.tracker.model.test_hand_axes import flat_hand
from tracker.model.hand_axes import find_flexion_axis
from tracker.model.joints import FINGERS
from tracker.model.t16_bind import estimate_frames, estimate_joints, find_motion_beside, turn_to_flexion


@pytest.fixture
def off(tmp_path: Path) -> Path:
    """`models/hand.OFF` with nothing beside it."""
    (tmp_path / "models").mkdir()
    return tmp_path / "models" / "hand.OFF"


def put(path: Path) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("")
    return path


def test_a_motion_in_the_model_s_own_folder_comes_before_those_of_sequences(off: Path) -> None:
    assert find_motion_beside(off) is None
    far = put(off.parents[1] / "seq" / "02" / "hand.MOTION")
    found = find_motion_beside(off)
    assert found is not None and found.samefile(far)
    first = put(off.parents[1] / "seq" / "01" / "hand.MOTION.gz")
    found = find_motion_beside(off)
    assert found is not None and found.samefile(first), "the first by name, packed or not"
    assert find_motion_beside(put(off.parent / "hand.MOTION") and off) == off.parent / "hand.MOTION"


def test_what_only_looks_like_a_motion_is_left(off: Path) -> None:
    for name in ("hand.MOTION.bak", "hand.MOTION~", "other.MOTION", "hand_2.MOTION"):
        put(off.parent / name)
    (off.parent / "hand.MOTION").mkdir()
    assert find_motion_beside(off) is None


def rod(bones: int, blur: float) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (V, 3) along x, a bone each 0.1 m, and weights (V, B) that go over within `blur`, m, of each joint."""
    x = np.linspace(0.0, 0.1 * bones, 100 * bones + 1)
    over = [np.clip(0.5 + (x - 0.1 * b) / (2.0 * blur), 0.0, 1.0) for b in range(1, bones)]
    steps = [np.ones_like(x), *over, np.zeros_like(x)]
    return np.column_stack([x, 0 * x, 0 * x]), np.stack([steps[b] - steps[b + 1] for b in range(bones)], axis=1)


def test_joints_are_where_the_weights_of_a_bone_and_its_parent_overlap() -> None:
    vertices, weights = rod(4, 0.02)
    joints = estimate_joints(vertices, weights, np.array([-1, 0, 1, 2]), np.full(4, 0.1))
    np.testing.assert_allclose(joints[1:], [[0.1, 0, 0], [0.2, 0, 0], [0.3, 0, 0]], atol=1e-9)
    np.testing.assert_allclose(joints[0], weights[:, 0] @ vertices / weights[:, 0].sum(), atol=1e-12)


def test_two_joints_in_a_row_are_moved_along_their_bone_until_its_length_fits() -> None:
    vertices, weights = rod(3, 0.02)
    for length in (0.06, 0.1, 0.14):
        joints = estimate_joints(vertices, weights, np.array([-1, 0, 1]), np.array([0.1, length, 0.1]))
        np.testing.assert_allclose(joints[1:, 0], [0.15 - length / 2, 0.15 + length / 2], atol=1e-9)


def test_a_bone_that_branches_off_the_root_starts_towards_the_root_from_its_child() -> None:
    """Two fingers of two bones on one palm."""
    vertices = np.array([[0.0, 0, 0], [0.10, 0.02, 0], [0.14, 0.02, 0], [0.10, -0.02, 0], [0.14, -0.02, 0]])
    weights = np.eye(5)
    weights[2, 1:3] = weights[4, 3:5] = 0.5
    parents, lengths = np.array([-1, 0, 1, 0, 3]), np.array([0.0, 0.05, 0.02, 0.03, 0.02])
    joints = estimate_joints(vertices, weights, parents, lengths)
    np.testing.assert_allclose(joints[[2, 4]], vertices[[2, 4]], atol=1e-12)
    for bone, child in ((1, 2), (3, 4)):
        along = joints[child] - joints[bone]
        assert np.linalg.norm(along) == pytest.approx(lengths[bone])
        to_root = joints[child] - joints[0]
        np.testing.assert_allclose(along / lengths[bone], to_root / np.linalg.norm(to_root), atol=1e-12)


def test_without_an_overlap_a_bone_s_own_vertices_tell_and_without_those_all_do() -> None:
    vertices = np.random.default_rng(0).normal(size=(6, 3))
    weights = np.zeros((6, 3))
    weights[:4, 0] = weights[4:, 1] = 1.0
    joints = estimate_joints(vertices, weights, np.array([-1, 0, 0]), np.zeros(3))
    np.testing.assert_allclose(joints[1], vertices[4:].mean(axis=0))
    np.testing.assert_allclose(joints[2], vertices.mean(axis=0))


def test_frames_lie_along_their_bones_by_the_smallest_turn() -> None:
    rng = np.random.default_rng(1)
    joints, along = rng.normal(size=(20, 3)), rng.normal(size=(20, 3))
    along[:2] = [[2.0, 0.0, 0.0], [-3.0, 0.0, 0.0]]
    Ts = estimate_frames(joints, joints + along)
    np.testing.assert_array_equal(Ts[:, :3, 3], joints)
    unit = along / np.linalg.norm(along, axis=1, keepdims=True)
    np.testing.assert_allclose(Ts[:, :3, 0], unit, atol=1e-12)
    np.testing.assert_allclose(np.linalg.det(Ts[:, :3, :3]), 1.0)
    turns = Rotation.from_matrix(Ts[:, :3, :3]).magnitude()
    np.testing.assert_allclose(turns, np.arccos(np.clip(unit[:, 0], -1.0, 1.0)), atol=1e-7)
    np.testing.assert_array_equal(Ts[0, :3, :3], np.eye(3))


@pytest.mark.parametrize("side", ["right", "left"])
def test_each_bone_is_rolled_until_its_axis_in_the_file_runs_against_flexion(side: str) -> None:
    chains = flat_hand(side)
    rng = np.random.default_rng(2)
    bones, ends, fingers = [], [], {}
    for finger in FINGERS:
        points = chains.fingers[finger]
        fingers[finger] = tuple(range(len(bones), len(bones) + len(points) - 1))
        bones += list(points[:-1])
        ends += list(points[1:])
    Ts = estimate_frames(np.array(bones), np.array(ends))
    before = Ts.copy()
    angles = rng.uniform(0.0, 2.0 * np.pi, len(bones))
    axes = {n: np.array([0.3, np.cos(a), np.sin(a)]) for n, a in enumerate(angles)}
    turned = turn_to_flexion(Ts, chains, fingers, axes)
    np.testing.assert_array_equal(Ts, before)
    np.testing.assert_array_equal(turned[:, :3, 3], Ts[:, :3, 3])
    np.testing.assert_allclose(turned[:, :3, 0], Ts[:, :3, 0], atol=1e-12)
    np.testing.assert_allclose(np.linalg.det(turned[:, :3, :3]), 1.0)
    for finger in FINGERS:
        for bone in fingers[finger]:
            own = axes[bone] * [0.0, 1.0, 1.0]
            np.testing.assert_allclose(turned[bone, :3, :3] @ own, -find_flexion_axis(chains, finger), atol=1e-9)
