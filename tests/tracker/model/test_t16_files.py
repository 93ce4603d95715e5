"""Models and motions of T16's authors."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import least_squares

from tracker.geometry import se3
from tracker.geometry.triangles import is_watertight
from tracker.model.articulated import ArticulatedModel
from tracker.model.scene import Scene
from tracker.model.t16_files import load_t16_model, load_t16_motion

HANDS = ("Model_Hand_R", "Model_Hand_L")
OBJECT_DOFS = {
    "Model_Object_Ball": 6,
    "Model_Object_Cube": 6,
    "Model_Object_Pipe_Gray": 7,
    "Model_Object_Pipe_Green_Long": 76,
}


@pytest.fixture(scope="module")
def models(shared_data: Path) -> Path:
    return shared_data / "ijcv16" / "models"


@pytest.mark.shared_data
@pytest.mark.parametrize("name", HANDS)
def test_a_hand_has_31_revolute_joints_and_37_degrees_of_freedom(models: Path, name: str) -> None:
    model = load_t16_model(models / f"{name}.OFF")
    assert model.num_dofs == 37
    assert len(model.skeleton.dof_bones) == 31
    np.testing.assert_allclose(np.linalg.norm(model.skeleton.dof_axes, axis=1), 1.0, atol=1e-12)
    assert np.all(model.skeleton.lower <= 0.0) and np.all(model.skeleton.upper >= 0.0)
    assert np.all(model.skeleton.lower < model.skeleton.upper)


@pytest.mark.shared_data
@pytest.mark.parametrize(("name", "dofs"), OBJECT_DOFS.items())
def test_an_object_has_the_joints_of_its_file(models: Path, name: str, dofs: int) -> None:
    model = load_t16_model(models / f"{name}.OFF")
    assert model.num_dofs == dofs
    assert model.hand is None


@pytest.mark.shared_data
@pytest.mark.parametrize("name", HANDS)
def test_the_21_joints_are_where_the_files_say(models: Path, name: str) -> None:
    full = load_t16_model(models / f"{name}.OFF", max_faces=None)
    model = load_t16_model(models / f"{name}.OFF")
    assert model.hand is not None and full.hand is not None
    assert model.hand.side == ("right" if name.endswith("R") else "left")
    rows = (models / f"{name}.VOI").read_text().split()
    assert [int(v) for v in rows[:5]] == [int(v) for v in full.hand.joint_vertices[[20, 16, 12, 8, 4]]]
    posed, full_posed = (Scene((m,)).pose_at(np.zeros(37)).landmarks(0) for m in (model, full))
    np.testing.assert_allclose(posed, full_posed, atol=1e-12)
    names = model.skeleton.bone_names
    side = name[-1]
    assert [names[bone] for bone in model.hand.joint_bones[[0, 1, 2, 3, 5, 17]]] == [
        f"Lower Arm {side}",
        f"{side}Fing.4_Hand",
        f"{side}Fing.4_0",
        f"{side}Fing.4_1",
        f"{side}Fing.3_0",
        f"{side}Fing.0_0",
    ]


@pytest.mark.shared_data
@pytest.mark.parametrize("name", HANDS)
def test_fingertips_lie_within_two_centimetres_of_the_tip(models: Path, name: str) -> None:
    model = load_t16_model(models / f"{name}.OFF")
    assert model.hand is not None
    used = set(np.unique(model.faces).tolist())
    for tip, ids in zip(model.hand.joint_vertices[[4, 8, 12, 16, 20]], model.hand.fingertips, strict=True):
        assert len(ids) >= 5 and set(ids.tolist()) <= used
        assert np.linalg.norm(model.vertices[ids] - model.vertices[tip], axis=1).max() < 0.02


@pytest.mark.shared_data
@pytest.mark.parametrize("name", [*HANDS, *OBJECT_DOFS])
def test_every_model_is_in_metres_watertight_and_its_weights_sum_to_one(models: Path, name: str) -> None:
    model = load_t16_model(models / f"{name}.OFF")
    assert len(model.faces) <= 1530
    assert is_watertight(model.faces)
    assert 0.03 < np.ptp(model.vertices, axis=0).max() < 0.5
    np.testing.assert_allclose(model.skinning_weights.sum(axis=1), 1.0, atol=1e-12)


def fit_pose(model: ArticulatedModel, Ts_world_bone: np.ndarray, bind: np.ndarray) -> tuple[float, np.ndarray]:
    """Root-mean-square distance, m, of the best pose of the model to a motion's frame, at points around its bones."""
    scene = Scene((model,))
    names = model.skeleton.num_bones
    corners = 0.01 * np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    targets = np.einsum("bij,pj->bpi", Ts_world_bone[:, :3, :3], corners) + Ts_world_bone[:, None, :3, 3]
    local = np.einsum("bij,pj->bpi", bind[:, :3, :3], corners) + bind[:, None, :3, 3]

    def residual(pose: np.ndarray) -> np.ndarray:
        Ms = scene.pose_at(pose).Ms
        return (np.einsum("bij,bpj->bpi", Ms[:, :, :3], local) + Ms[:, None, :, 3] - targets).ravel()

    start = np.zeros(model.num_dofs)
    start[:6] = se3.log(Ts_world_bone[0] @ se3.inverse(bind[0]))
    solution = least_squares(residual, start, method="lm")
    return float(np.sqrt(np.mean(solution.fun**2) * 3.0)), solution.fun.reshape(names, 4, 3)


@pytest.mark.shared_data
def test_the_joints_follow_the_published_motion_within_a_tenth_of_a_millimetre(shared_data: Path, models: Path) -> None:
    model = load_t16_model(models / "Model_Hand_R.OFF", max_faces=200)
    names, motion, bind = load_t16_motion(shared_data / "ijcv16" / "seq" / "09" / "Model_Hand_R.MOTION.gz")
    assert names == model.skeleton.bone_names and motion.shape == (138, 20, 4, 4)
    rms = [fit_pose(model, frame, bind)[0] for frame in motion[::23]]
    assert max(rms) < 1e-4


@pytest.mark.shared_data
def test_a_bent_pipe_turns_about_the_axis_in_its_file(shared_data: Path, models: Path) -> None:
    model = load_t16_model(models / "Model_Object_Pipe_Gray.OFF", max_faces=200)
    _, motion, bind = load_t16_motion(shared_data / "ijcv16" / "seq" / "17" / "Model_Object_Pipe_Gray.MOTION.gz")
    assert max(fit_pose(model, frame, bind)[0] for frame in motion[::80]) < 1e-5
