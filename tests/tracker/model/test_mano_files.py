"""Files of MANO and SMPL-H come in as they are meant, every quirk of them included, and go out again."""

from __future__ import annotations

import pickle
import shutil
import sys

import numpy as np
import pytest
from scipy import sparse
from scipy.spatial.transform import Rotation

from benchmarks.smplx_agreement import BAR, compare
from tests.tracker.chumpy_objects import Ch, Select, chumpy_installed
from tests.tracker.model.mirrored_poses import mirror_blend_pose
from tests.tracker.random_blend import random_blend, random_pose
from tracker.errors import ModelFileError
from tracker.export.mano_parameters import MANO_JOINTS
from tracker.model.blend_mirroring import mirror_blend
from tracker.model.blend_model import BLEND_JOINTS, BLEND_PARENTS
from tracker.model.joints import HAND_JOINTS
from tracker.model.mano_conventions import (
    CONVENTIONS,
    OPENPOSE_ORDER,
    SMPLH_TIP_VERTICES,
    TIP_VERTICES,
    ManoConvention,
    pose_of_parameters,
    present,
)
from tracker.model.mano_files import BODY_JOINTS, SMPLH_JOINTS, load_mano
from tracker.model.mano_writer import save_mano


def mano_parts(seed: int = 0, vertices: int = 778) -> dict:
    """Arrays of a file as MANO's is, filled with random numbers."""
    rng = np.random.default_rng(seed)
    regressor = sparse.random(16, vertices, 0.02, random_state=seed) + sparse.eye(16, vertices)
    return {
        "v_template": 0.05 * rng.standard_normal((vertices, 3)),
        "f": rng.integers(0, vertices, (1538, 3)).astype(np.uint32),
        "weights": rng.dirichlet(np.ones(16), vertices),
        "shapedirs": 0.001 * rng.standard_normal((vertices, 3, 10)),
        "posedirs": 0.001 * rng.standard_normal((vertices, 3, 135)),
        "J_regressor": sparse.csc_matrix(regressor / regressor.sum(axis=1)),
        "J": np.zeros((16, 3)),
        "kintree_table": np.stack([np.r_[2**32 - 1, BLEND_PARENTS[1:]], np.arange(16)]).astype(np.uint32),
        "hands_components": np.linalg.qr(rng.standard_normal((45, 45)))[0],
        "hands_mean": rng.standard_normal(45),
        "hands_coeffs": rng.standard_normal((30, 45)),
        "bs_type": "lrotmin",
        "bs_style": "lbs",
    }


def write(path, parts: dict, protocol: int = 2) -> None:
    with chumpy_installed():
        path.write_bytes(pickle.dumps(parts, protocol))


@pytest.fixture
def right(tmp_path):
    write(tmp_path / "MANO_RIGHT.pkl", mano_parts())
    return tmp_path / "MANO_RIGHT.pkl"


def test_the_published_kind_of_file_with_chumpy_objects_is_read(tmp_path):
    parts = mano_parts()
    whole = np.concatenate([parts["shapedirs"], np.zeros((778, 3, 5))], axis=2)
    places = np.arange(whole.size).reshape(whole.shape)[:, :, :10].ravel()
    write(
        tmp_path / "MANO_RIGHT.pkl",
        {**parts, "shapedirs": Select(Ch(whole), places, (778, 3, 10)), "posedirs": Ch(parts["posedirs"])},
    )
    model = load_mano(tmp_path / "MANO_RIGHT.pkl")
    np.testing.assert_array_equal(model.shape_directions, parts["shapedirs"])
    np.testing.assert_array_equal(model.pose_directions, parts["posedirs"])
    np.testing.assert_array_equal(model.joint_regressor.toarray(), parts["J_regressor"].toarray())
    np.testing.assert_array_equal(model.parents, BLEND_PARENTS)  # 2^32 - 1 at the root is -1
    np.testing.assert_array_equal(model.faces, parts["f"])
    np.testing.assert_array_equal(model.pose_mean, parts["hands_mean"])
    assert model.joint_names == BLEND_JOINTS and model.side == "right"


def test_the_npz_variant_is_the_same_model(tmp_path, right):
    parts = mano_parts()
    parts["J_regressor"] = parts["J_regressor"].toarray()
    parts["v_template"] = np.asfortranarray(parts["v_template"])
    np.savez(tmp_path / "model.npz", **parts, extra=np.array([{}], dtype=object))
    model, other = load_mano(tmp_path / "model.npz", side="right"), load_mano(right)
    for name in ("template", "pose_directions", "shape_directions", "pose_components", "tips"):
        np.testing.assert_array_equal(getattr(model, name), getattr(other, name))


# Quirk 1: the left hand's shape directions were copied from the right hand without mirroring them.


def test_the_left_hand_s_shape_directions_are_mirrored_when_asked_for(tmp_path):
    parts = mano_parts()
    for name in ("MANO_LEFT.pkl", "MANO_RIGHT.pkl"):
        write(tmp_path / name, parts)
    as_is = load_mano(tmp_path / "MANO_LEFT.pkl", convention=CONVENTIONS["dexycb"])
    fixed = load_mano(tmp_path / "MANO_LEFT.pkl", convention=CONVENTIONS["interhand2.6m"])
    np.testing.assert_array_equal(as_is.shape_directions, parts["shapedirs"])
    np.testing.assert_array_equal(fixed.shape_directions[:, 0], -parts["shapedirs"][:, 0])
    np.testing.assert_array_equal(fixed.shape_directions[:, 1:], parts["shapedirs"][:, 1:])
    untouched = load_mano(tmp_path / "MANO_RIGHT.pkl", convention=CONVENTIONS["interhand2.6m"])
    np.testing.assert_array_equal(untouched.shape_directions, parts["shapedirs"])


def test_a_left_hand_that_we_wrote_needs_no_fix(tmp_path):
    left = random_blend(side="left")
    save_mano(left, tmp_path / "MANO_LEFT.pkl")
    again = load_mano(tmp_path / "MANO_LEFT.pkl", convention=CONVENTIONS["interhand2.6m"])
    np.testing.assert_array_equal(again.shape_directions, left.shape_directions)


# Quirk 2: mean pose or flat hand, and how many components.


def test_poses_count_from_the_mean_or_from_the_flat_hand(right):
    model = load_mano(right)
    zero = np.zeros(3)
    for name, flat in (("smplx", False), ("manopth", True), ("manotorch", True)):
        assert CONVENTIONS[name].flat_hand_mean is flat
        pose = pose_of_parameters(model, np.zeros(CONVENTIONS[name].num_components), zero, CONVENTIONS[name])
        np.testing.assert_array_equal(pose[1:].ravel(), np.zeros(45) if flat else model.pose_mean)
    np.testing.assert_array_equal(load_mano(right, convention=CONVENTIONS["manopth"]).pose_mean, np.zeros(45))


@pytest.mark.parametrize("count", [6, 10, 15])
def test_few_parameters_are_coefficients_and_45_are_rotation_vectors(right, count, rng):
    model, values = load_mano(right), rng.standard_normal(45)
    convention = ManoConvention(num_components=count)
    pose = pose_of_parameters(model, values[:count], values[:3], convention)
    expected = values[:count] @ model.pose_components[:count] + model.pose_mean
    np.testing.assert_allclose(pose.ravel(), np.r_[values[:3], expected], atol=1e-12)
    pose = pose_of_parameters(model, values, values[:3], ManoConvention(num_components=45))
    np.testing.assert_allclose(pose[1:].ravel(), values + model.pose_mean, atol=1e-15)


def test_the_side_is_told_by_the_file_s_name_or_by_the_caller(tmp_path, right):
    shutil.copy(right, tmp_path / "MANO_LEFT.pkl")
    shutil.copy(right, tmp_path / "hand.pkl")
    assert load_mano(tmp_path / "MANO_LEFT.pkl").side == "left"
    assert load_mano(tmp_path / "hand.pkl", side="left").side == "left"
    with pytest.raises(ModelFileError, match="RIGHT or LEFT"):
        load_mano(tmp_path / "hand.pkl")


# Quirk 3: the order of the joints.


def test_the_little_finger_comes_before_the_ring_finger_and_the_thumb_last():
    assert BLEND_JOINTS[7:10] == ("little1", "little2", "little3") and BLEND_JOINTS[10] == "ring1"
    assert BLEND_JOINTS[13] == "thumb1"
    assert [name.split("_")[0] for name in MANO_JOINTS] == [name[:-1] for name in BLEND_JOINTS[1:]]


def test_openpose_s_order_is_that_of_our_21_joints():
    tips = ("thumb", "index", "middle", "ring", "little")
    names = [*BLEND_JOINTS, *(f"{finger}_tip" for finger in tips)]
    places = {"1": ("mcp", "cmc"), "2": ("pip", "mcp"), "3": ("dip", "ip")}
    for ours, place in zip(HAND_JOINTS, OPENPOSE_ORDER, strict=True):
        name = names[place]
        if name[-1] in places:
            name = f"{name[:-1]}_{places[name[-1]][name.startswith('thumb')]}"
        assert name == ours


def test_smplx_gives_16_joints_and_manopth_21(right):
    posed = load_mano(right).pose_at()
    assert present(posed, CONVENTIONS["smplx"])[1].shape == (16, 3)
    assert present(posed, CONVENTIONS["manopth"])[1].shape == (21, 3)


# Quirk 4: which vertices are fingertips.


@pytest.mark.parametrize("side", ["right", "left"])
@pytest.mark.parametrize("tips", ["smplx", "manopth", "ho3d"])
def test_fingertips_are_the_chosen_program_s(tmp_path, side, tips):
    write(tmp_path / "hand.pkl", mano_parts())
    model = load_mano(tmp_path / "hand.pkl", side=side, convention=ManoConvention(tips=tips, with_tips=True))
    np.testing.assert_array_equal(model.tips, TIP_VERTICES[tips][side])
    posed = model.pose_at()
    _, joints = present(posed, ManoConvention(tips=tips, with_tips=True))
    np.testing.assert_array_equal(joints[4::4], posed.vertices[list(TIP_VERTICES[tips][side])])


def test_manopth_s_left_middle_finger_ends_one_vertex_further():
    assert TIP_VERTICES["manopth"]["left"][2] == TIP_VERTICES["manopth"]["right"][2] + 1


def test_fingertips_of_another_topology_are_found(tmp_path):
    model = random_blend()
    save_mano(model, tmp_path / "MANO_RIGHT.npz")
    parts = dict(np.load(tmp_path / "MANO_RIGHT.npz"))
    del parts["tips"]
    np.savez(tmp_path / "MANO_RIGHT.npz", **parts)
    found = load_mano(tmp_path / "MANO_RIGHT.npz").tips
    assert np.linalg.norm(model.template[found] - model.template[model.tips], axis=1).max() < 0.006


# Quirk 5: millimetres, and a joint subtracted.


def test_manopth_gives_millimetres_from_a_joint_and_manotorch_metres(right, rng):
    model = load_mano(right)
    pose, shape, translation = random_pose(model)
    posed = model.pose_at(pose, shape, translation)
    in_mm, joints_mm = present(posed, CONVENTIONS["manopth"])
    in_m, joints_m = present(posed, CONVENTIONS["manotorch"])
    np.testing.assert_allclose(in_mm, 1000.0 * in_m, atol=1e-9)
    np.testing.assert_allclose(joints_mm, 1000.0 * joints_m, atol=1e-9)
    np.testing.assert_array_equal(joints_m[0], np.zeros(3))
    np.testing.assert_allclose(in_m, posed.vertices - posed.joints[0], atol=1e-15)


# Quirk 6: the root turns about its joint, whose place depends on the shape.


def test_turning_the_root_is_not_turning_the_vertices(right):
    model = load_mano(right)
    turn = np.array([0.2, 1.0, -0.4])
    R = Rotation.from_rotvec(turn).as_matrix()
    pose = np.zeros((16, 3))
    pose[0] = turn
    offsets = []
    for shape in (np.zeros(10), np.ones(10)):
        at_rest, turned = model.pose_at(shape=shape), model.pose_at(pose, shape)
        root = at_rest.joints[0]
        np.testing.assert_allclose(turned.vertices, at_rest.vertices @ R.T + (root - R @ root), atol=1e-12)
        offsets.append(root - R @ root)
    assert np.abs(offsets[0]).max() > 1e-3 and np.abs(offsets[0] - offsets[1]).max() > 1e-5


# Quirk 7: joints are regressed before posing.


def test_posed_joints_are_carried_and_not_regressed_from_posed_vertices():
    model = random_blend()
    posed = model.pose_at(*random_pose(model))
    assert np.linalg.norm(model.joint_regressor @ posed.vertices - posed.joints, axis=1).max() > 0.002


# Quirk 8: a rotation vector of the left hand has other signs of y and z.


def test_the_left_hand_s_pose_is_the_right_one_s_with_y_and_z_turned_round():
    across = np.array([-1.0, 1.0, 1.0])
    np.testing.assert_array_equal(mirror_blend_pose(np.array([1.0, 2.0, 3.0]), across), [1.0, -2.0, -3.0])
    right = random_blend()
    left = mirror_blend(right, across)
    pose, shape, translation = random_pose(right)
    signs = np.array([1.0, -1.0, -1.0])
    posed = left.pose_at(pose * signs, shape, translation * across)
    np.testing.assert_allclose(posed.vertices * across, right.pose_at(pose, shape, translation).vertices, atol=1e-12)


# Quirk 9: chumpy cannot be installed; the files hold it (see test_restricted_pickle). SMPL-H.


def smplh_parts(vertices: int = 150) -> dict:
    rng = np.random.default_rng(0)
    parents = [-1, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 9, 9, 12, 13, 14, 16, 17, 18, 19]
    for wrist in (20, 21):
        first = len(parents)
        parents += [wrist if parent == 0 else first + parent - 1 for parent in BLEND_PARENTS[1:]]
    assert len(parents) == 52
    parts = mano_parts(vertices=vertices) | {
        "v_template": rng.standard_normal((vertices, 3)),
        "weights": rng.dirichlet(np.ones(52), vertices),
        "shapedirs": 0.01 * rng.standard_normal((vertices, 3, 16)),
        "posedirs": 0.01 * rng.standard_normal((vertices, 3, 459)),
        "J_regressor": rng.dirichlet(np.ones(vertices), 52),
        "kintree_table": np.stack([np.array(parents) % 2**32, np.arange(52)]).astype(np.uint32),
    }
    for name in ("components", "mean", "coeffs"):
        value = parts.pop(f"hands_{name}")
        parts |= {f"hands_{name}l": 2.0 * value, f"hands_{name}r": value}
    return parts


def test_smplh_is_read_with_both_hands_pose_spaces(tmp_path):
    parts = smplh_parts()
    write(tmp_path / "SMPLH_MALE.pkl", parts)
    model = load_mano(tmp_path / "SMPLH_MALE.pkl")
    assert (model.side, model.num_bones, model.num_shape) == ("body", 52, 16) and model.joint_names == SMPLH_JOINTS
    pose = model.pose_of(np.eye(90)[3])
    expected = np.zeros(153)
    expected[63:108] = parts["hands_meanl"] + parts["hands_componentsl"][3]
    expected[108:] = parts["hands_meanr"]
    np.testing.assert_allclose(pose.ravel(), expected, atol=1e-15)
    posed = model.pose_at(*random_pose(model))
    step = 1e-6 * np.random.default_rng(1).standard_normal(model.num_parameters)
    ahead = model.pose_at(*model.retract(posed.pose, posed.shape, posed.translation, step))
    linear = posed.vertices + posed.vertex_jacobian() @ step
    np.testing.assert_allclose(ahead.vertices, linear, atol=1e-9)


def test_smplh_without_a_pose_space_gets_the_identity(tmp_path):
    parts = {key: value for key, value in smplh_parts().items() if not key.startswith("hands_")}
    parts["J_regressor"] = np.asarray(parts["J_regressor"])
    np.savez(tmp_path / "model.npz", **parts)
    model = load_mano(tmp_path / "model.npz")
    np.testing.assert_array_equal(model.pose_mean, np.zeros(153))
    np.testing.assert_array_equal(model.pose_of(np.arange(90.0)).ravel()[3 * len(BODY_JOINTS) - 3 :], np.arange(90.0))


def test_smplh_s_fingertips_are_within_its_6890_vertices():
    for side in ("right", "left"):
        assert len(set(SMPLH_TIP_VERTICES[side])) == 5 and max(SMPLH_TIP_VERTICES[side]) < 6890


# Bad files.


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"weights": None}, "no 'weights'"),
        ({"v_template": np.full((778, 3), np.nan)}, "'v_template' with values"),
        ({"posedirs": np.zeros((778, 3, 207))}, "'posedirs', float64 778x3x207"),
        ({"weights": np.full((778, 24), 1 / 24)}, "24 joints"),
        ({"weights": np.full((778, 16), 0.5)}, "sum to one"),
        ({"f": np.full((4, 3), 778)}, "faces"),
        ({"kintree_table": np.zeros((2, 16), dtype=np.uint32) + 20}, "one tree"),
        ({"kintree_table": np.zeros((3, 16))}, "kintree_table"),
        ({"J_regressor": np.zeros((24, 778))}, "'J_regressor', float64 24x778"),
        ({"hands_components": np.zeros((45, 44))}, "'hands_components', float64 45x44"),
    ],
)
def test_a_wrong_array_is_named(tmp_path, change, message):
    write(tmp_path / "MANO_RIGHT.pkl", mano_parts() | change)
    with pytest.raises(ModelFileError, match=message):
        load_mano(tmp_path / "MANO_RIGHT.pkl")


# Writing, and other programs reading.


@pytest.mark.parametrize("suffix", ["pkl", "npz"])
@pytest.mark.parametrize("side", ["right", "left"])
def test_what_was_written_is_read_back_to_the_last_bit(tmp_path, side, suffix):
    model = random_blend(side=side)
    path = tmp_path / f"MANO_{side.upper()}.{suffix}"
    save_mano(model, path)
    again = load_mano(path)
    posed, other = (m.pose_at(*random_pose(model)) for m in (model, again))
    np.testing.assert_array_equal(posed.vertices, other.vertices)
    np.testing.assert_array_equal(posed.joints, other.joints)
    np.testing.assert_array_equal(again.tips, model.tips)
    assert (again.name, again.side, again.provenance) == (model.name, model.side, model.provenance)


def test_a_written_pickle_names_nothing_but_numpy_and_scipy_by_their_old_names(tmp_path):
    save_mano(random_blend(), tmp_path / "MANO_RIGHT.pkl")
    content = (tmp_path / "MANO_RIGHT.pkl").read_bytes()
    assert b"cnumpy.core.multiarray\n_reconstruct\n" in content and b"cscipy.sparse.csc\ncsc_matrix\n" in content
    assert b"numpy._core" not in content and b"_csc" not in content and b"chumpy" not in content
    with pytest.warns(DeprecationWarning, match="deprecated"):
        loaded = pickle.loads(content, encoding="latin1")
    np.testing.assert_array_equal(loaded["J_regressor"].toarray(), random_blend().joint_regressor.toarray())


def test_a_short_pose_space_is_completed_by_directions_square_to_it(tmp_path):
    model = random_blend()
    short = type(model)(**{**vars_of(model), "pose_components": 3.0 * model.pose_components[:6]})
    save_mano(short, tmp_path / "MANO_RIGHT.npz")
    components = np.load(tmp_path / "MANO_RIGHT.npz")["hands_components"]
    np.testing.assert_array_equal(components[:6], short.pose_components)
    assert components.shape == (45, 45) and np.linalg.matrix_rank(components) == 45
    np.testing.assert_allclose(components[6:] @ components[:6].T, 0.0, atol=1e-12)


def vars_of(model) -> dict:
    return {name: getattr(model, name) for name in model.__dataclass_fields__}


@pytest.mark.parametrize("side", ["right", "left"])
def test_smplx_makes_the_same_vertices_of_an_exported_model(side):
    pytest.importorskip("smplx", reason="smplx is not installed; python -m benchmarks.smplx_agreement --python PYTHON")
    pytest.importorskip("torch", reason="torch is not installed; python -m benchmarks.smplx_agreement --python PYTHON")
    for row in compare(random_blend(side=side), sys.executable, 4):
        assert row["vertices"] < BAR and row["joints"] < BAR, row
