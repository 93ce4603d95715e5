"""Files for the programs that read MANO and SMPL-H: every array in its place, and nothing half written."""

from __future__ import annotations

import pickle
import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.tracker.random_blend import random_blend
from tracker.model.body_hands import body_hand
from tracker.model.body_model import body_model
from tracker.model.mano_writer import save_mano, smplx_vertex_ids

MODEL = random_blend()
BODY = body_model()


def read(path: Path) -> dict:
    """As a program of the authors' kind does."""
    if path.suffix.lower() == ".npz":
        return dict(np.load(path))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)
        return pickle.loads(path.read_bytes(), encoding="latin1")


@pytest.mark.parametrize("name", ["MANO_RIGHT.pkl", "MANO_RIGHT.NPZ"])
def test_arrays_have_the_names_and_kinds_that_mano_s_have(tmp_path: Path, name: str) -> None:
    save_mano(MODEL, tmp_path / name)
    parts = read(tmp_path / name)
    assert {"v_template", "f", "weights", "shapedirs", "posedirs", "J_regressor", "J", "kintree_table"} <= set(parts)
    assert parts["f"].dtype == parts["kintree_table"].dtype == np.uint32
    assert parts["kintree_table"][0, 0] == 2**32 - 1, "the root has no parent"
    np.testing.assert_array_equal(parts["kintree_table"][0, 1:], MODEL.parents[1:])
    np.testing.assert_array_equal(parts["kintree_table"][1], np.arange(16))
    np.testing.assert_allclose(parts["J"], MODEL.joint_regressor @ MODEL.template)
    assert (str(parts["bs_type"]), str(parts["bs_style"])) == ("lrotmin", "lbs")
    assert parts["hands_components"].shape == (45, 45) and parts["hands_coeffs"].shape == (0, 45)


def test_a_pose_space_of_nothing_is_the_identity_and_one_of_too_much_is_cut(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    for given, expected in ((np.zeros((0, 45)), np.eye(45)), (rng.normal(size=(60, 45)), None)):
        save_mano(replace(MODEL, pose_components=given), tmp_path / "MANO_RIGHT.pkl")
        found = read(tmp_path / "MANO_RIGHT.pkl")["hands_components"]
        np.testing.assert_array_equal(found, given[:45] if expected is None else expected)


def test_each_hand_of_a_body_has_its_own_pose_space_of_45(tmp_path: Path) -> None:
    few = replace(
        BODY,
        template=BODY.template[:60],
        faces=np.array([[0, 1, 2]]),
        shape_directions=BODY.shape_directions[:60],
        pose_directions=BODY.pose_directions[:60],
        skinning_weights=BODY.skinning_weights[:60],
        joint_regressor=BODY.joint_regressor[:, :60],
        tips=np.arange(10),
    )
    save_mano(few, tmp_path / "SMPLH_NEUTRAL.pkl")
    parts = read(tmp_path / "SMPLH_NEUTRAL.pkl")
    for letter, side in (("l", "left"), ("r", "right")):
        hand = body_hand(BODY, side)
        own = hand.components_of(BODY)
        components = parts[f"hands_components{letter}"]
        np.testing.assert_array_equal(components[: len(own)], own)
        assert np.linalg.matrix_rank(components) == 45
        np.testing.assert_array_equal(parts[f"hands_mean{letter}"], BODY.pose_mean[hand.columns])
    assert "hands_components" not in parts and parts["kintree_table"].shape == (2, 52)


@pytest.mark.parametrize("name", ["MANO_RIGHT.pkl", "MANO_RIGHT.npz"])
def test_a_file_that_cannot_be_put_in_its_place_leaves_nothing_beside_it(tmp_path: Path, name: str) -> None:
    (tmp_path / name).mkdir()
    (tmp_path / name / "kept").write_text("")
    with pytest.raises(OSError, match=name):
        save_mano(MODEL, tmp_path / name)
    assert [path.name for path in tmp_path.iterdir()] == [name]


def test_a_file_that_is_written_anew_takes_the_place_of_the_old_one(tmp_path: Path) -> None:
    path = tmp_path / "MANO_RIGHT.pkl"
    for seed in (1, 2):
        save_mano(random_blend(seed), path)
    np.testing.assert_array_equal(read(path)["posedirs"], random_blend(2).pose_directions)
    assert [found.name for found in tmp_path.iterdir()] == [path.name]


def test_landmarks_of_a_body_are_all_that_smplx_asks_for_each_at_a_vertex_of_its_own() -> None:
    ids = smplx_vertex_ids(BODY)
    face = {"nose", "reye", "leye", "rear", "lear"}
    feet = {f"{side}{part}" for side in "RL" for part in ("BigToe", "SmallToe", "Heel")}
    tips = {f"{side}{finger}" for side in "rl" for finger in ("thumb", "index", "middle", "ring", "pinky")}
    assert set(ids) == face | feet | tips
    assert len(set(ids.values())) == 21 and max(ids.values()) < len(BODY.template)


def test_landmarks_of_the_two_sides_are_mirror_images_and_lie_where_they_are_looked_for() -> None:
    """x to the body's left, y up, z to the front."""
    at = {name: BODY.template[vertex] for name, vertex in smplx_vertex_ids(BODY).items()}
    pairs = ("leye", "reye"), ("lear", "rear"), ("LHeel", "RHeel"), ("LBigToe", "RBigToe"), ("lpinky", "rpinky")
    for left, right in pairs:
        np.testing.assert_allclose(at[left] * [-1.0, 1.0, 1.0], at[right], atol=2e-3, err_msg=left)
        assert at[left][0] > 0.0 > at[right][0]
    assert abs(at["nose"][0]) < 0.01
    assert at["nose"][2] > at["leye"][2] > at["lear"][2] and at["lear"][0] > at["leye"][0]
    assert at["LBigToe"][2] > at["LHeel"][2] and at["LSmallToe"][0] > at["LBigToe"][0]
    assert at["nose"][1] - at["LHeel"][1] > 1.0, "m"


def test_a_hand_has_no_landmarks_of_a_body() -> None:
    with pytest.raises(AssertionError):
        smplx_vertex_ids(MODEL)
