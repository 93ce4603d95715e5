"""The body with hands keeps what docs and issue promise of it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from benchmarks.body_model import ANSUR, compare_hands, count_open_edges, measure_people, measure_seam
from tracker.errors import ModelFileError
from tracker.model.blend_files import save_blend_model
from tracker.model.body_hands import body_hand, body_pose
from tracker.model.body_model import body_model, default_body, load_body_model, save_body_model
from tracker.model.mano_files import SMPLH_JOINTS, load_mano
from tracker.model.mano_writer import save_mano, smplx_vertex_ids
from tracker.model.trained_hand import trained_hand

BODY = body_model()


def test_it_is_one_closed_surface_with_smplhs_joints_and_weights_that_sum_to_one() -> None:
    assert BODY.joint_names == SMPLH_JOINTS and BODY.num_bones == 52
    assert count_open_edges(BODY.faces) == 0
    assert np.abs(BODY.skinning_weights.sum(axis=1) - 1.0).max() < 1e-12 and BODY.skinning_weights.min() >= 0.0


def test_left_is_the_mirror_image_of_right() -> None:
    joints = BODY.joints_of(BODY.template)
    for name in SMPLH_JOINTS:
        other = name.replace("left", "right") if "left" in name else name.replace("right", "left")
        mirrored = joints[SMPLH_JOINTS.index(other)] * [-1.0, 1.0, 1.0]
        assert np.allclose(joints[SMPLH_JOINTS.index(name)], mirrored, atol=2e-5), name


def test_its_hands_are_the_trained_hand() -> None:
    hands = {side: trained_hand(side) for side in ("right", "left")}
    assert max(compare_hands(BODY, hands, poses=20).values()) < 1e-3, "mm; the bar is 0.3"


def test_the_seam_is_no_rougher_than_the_hand_beside_it() -> None:
    seam = measure_seam(BODY, poses=10)
    assert seam["mean_mm"] < 0.5, "the bar"
    assert seam["p95_mm"] < seam["hand_p95_mm"], "less than where nothing is sewn"
    assert seam["smooth_max_mm"] > 0.5 > seam["forearm_max_mm"], "triangles alone miss the bar, unless they are even"


@pytest.mark.parametrize("sex", ANSUR)
def test_stature_and_hand_length_are_spread_as_peoples_are(sex: str) -> None:
    found, (mean, deviation, correlation) = measure_people(body_model(sex), 3000), ANSUR[sex]
    assert np.abs(np.array(found["mean"]) / mean - 1.0).max() < 0.03
    assert np.abs(np.array(found["deviation"]) / deviation - 1.0).max() < 0.03
    assert abs(found["correlation"] - correlation) < 0.05


@pytest.mark.parametrize("name", ["SMPLH_NEUTRAL.pkl", "SMPLH_NEUTRAL.npz"])
def test_the_file_for_smplx_comes_back_as_the_same_body(name: str, tmp_path: Path) -> None:
    save_mano(BODY, tmp_path / name)
    found = load_mano(tmp_path / name)
    for array in ("template", "faces", "shape_directions", "pose_directions", "skinning_weights", "pose_mean", "tips"):
        assert np.array_equal(getattr(found, array), getattr(BODY, array)), array
    assert np.array_equal(found.joint_regressor.toarray(), BODY.joint_regressor.toarray())
    assert np.array_equal(found.parents, BODY.parents) and found.side == "body"
    assert set(smplx_vertex_ids(BODY)) >= {"nose", "rthumb", "lpinky", "LHeel"}


def test_six_numbers_or_all_pose_a_hand_and_leave_the_other_at_its_mean() -> None:
    few = np.array([0.5, -0.2, 0.1, 0.0, 0.3, -0.4])
    right, left = body_hand(BODY, "right"), body_hand(BODY, "left")
    pose = body_pose(BODY, np.zeros(3), np.zeros((21, 3)), {"right": few})
    flat = body_pose(BODY, np.zeros(3), np.zeros((21, 3)), {"right": pose[right.fingers].ravel()}, is_flat_mean=True)
    assert np.allclose(flat[right.fingers], pose[right.fingers]) and np.all(flat[left.fingers] == 0.0)
    assert np.allclose(pose[left.fingers].ravel(), BODY.pose_mean.reshape(-1, 3)[left.fingers - 1].ravel())


def test_its_own_file_keeps_every_number_and_a_hand_is_no_body(tmp_path: Path) -> None:
    save_body_model(default_body(), tmp_path / "body.npz")
    found = load_body_model(tmp_path / "body.npz")
    assert np.array_equal(found.blend.pose_directions, default_body().blend.pose_directions)
    assert np.array_equal(found.populations["female"].factor, default_body().populations["female"].factor)
    save_blend_model(trained_hand("right"), tmp_path / "hand.npz")
    with pytest.raises(ModelFileError, match="a right hand"):
        load_body_model(tmp_path / "hand.npz")
