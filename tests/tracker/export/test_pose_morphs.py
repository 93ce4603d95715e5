"""Morph targets: no vertex of any frame is off, no target more than needed, no weight beyond one."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tests.tracker.random_blend import random_blend
from tests.tracker.toys import tube
from tracker.export.pose_morphs import choose_morphs, find_pose_morphs
from tracker.model.pose_blend import PoseBlend

MODEL = random_blend()
PARENTS = np.asarray(MODEL.parents)
BLEND = PoseBlend(np.arange(1, MODEL.num_bones), MODEL.pose_directions)


def move(turns: np.ndarray) -> np.ndarray:
    """(T, B, 4, 4) motions from rest of bones turned by rotation vectors (T, B, 3) about their parents' axes."""
    motions = np.tile(np.eye(4), (*turns.shape[:2], 1, 1))
    for bone, parent in enumerate(PARENTS):
        own = Rotation.from_rotvec(turns[:, bone]).as_matrix()
        motions[:, bone, :3, :3] = own if parent < 0 else motions[:, parent, :3, :3] @ own
    return motions


def blend_by_hand(turns: np.ndarray) -> np.ndarray:
    """(T, V, 3) what the blend shapes add: directions times R - I of every bone but the root."""
    Rs = np.array([Rotation.from_rotvec(one[1:]).as_matrix() - np.eye(3) for one in turns])
    return np.einsum("vxp,tp->tvx", MODEL.pose_directions, Rs.reshape(len(turns), -1))


def measure_missed(morphs, turns: np.ndarray, count: int | None = None) -> float:
    """Farthest that a vertex of any frame is from where the blend shapes put it, m."""
    made = np.einsum("tk,kvx->tvx", morphs.weights[:, :count], morphs.targets[:count])
    return float(np.linalg.norm(made - blend_by_hand(turns), axis=2).max())


@pytest.mark.parametrize("frames", [1, 2, 12])
def test_every_frame_is_met_with_the_fewest_targets(frames: int, rng: np.random.Generator) -> None:
    turns = 0.5 * rng.normal(size=(frames, MODEL.num_bones, 3))
    morphs = choose_morphs(BLEND, PARENTS, move(turns))
    assert measure_missed(morphs, turns) < 1.001e-4, "m"
    assert len(morphs.targets) <= frames
    assert measure_missed(morphs, turns, len(morphs.targets) - 1) > 1e-4, "one fewer misses"
    assert np.abs(morphs.weights).max() == pytest.approx(1.0)


def test_two_poses_over_and_over_need_two_targets(rng: np.random.Generator) -> None:
    turns = np.tile(0.5 * rng.normal(size=(2, MODEL.num_bones, 3)), (10, 1, 1))
    assert len(choose_morphs(BLEND, PARENTS, move(turns)).targets) == 2


def test_at_rest_and_when_only_the_root_turns_nothing_is_added() -> None:
    turns = np.zeros((4, MODEL.num_bones, 3))
    turns[:, 0] = [[0, 0, 0], [1, 0, 0], [0, 2, 0], [1, 1, 1]]
    morphs = choose_morphs(BLEND, PARENTS, move(turns))
    assert len(morphs.targets) == 1
    assert np.abs(np.einsum("tk,kvx->tvx", morphs.weights, morphs.targets)).max() < 1e-9, "m"


def test_a_model_that_is_only_skinned_has_none() -> None:
    assert find_pose_morphs(tube(), np.tile(np.eye(4), (5, 3, 1, 1))) is None
