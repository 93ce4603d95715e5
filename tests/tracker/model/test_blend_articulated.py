"""The tracker's hand made of a blend model is that blend model, moved as a hand's joints move."""

from __future__ import annotations

from dataclasses import fields

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tests.tracker.model.mirrored_poses import mirror_pose
from tests.tracker.model.test_npz_files import assert_same
from tests.tracker.random_blend import random_blend
from tracker.errors import ModelFileError
from tracker.geometry.triangles import is_watertight
from tracker.model import Scene, decimate, load_model, mirror, save_model, with_shape
from tracker.model.articulated import ArticulatedModel
from tracker.model.blend_articulated import articulated_of, close_wrist
from tracker.model.blend_files import save_blend_model
from tracker.model.blend_limits import CHAINS
from tracker.model.blend_mirroring import mirror_blend
from tracker.model.blend_model import BlendModel
from tracker.model.decimation import compute_volume
from tracker.model.default_hand import default_hand
from tracker.model.joints import FINGERS, HAND_JOINTS
from tracker.model.mano_writer import save_mano
from tracker.model.pose_blend import PoseBlend
from tracker.model.untrained_hand import untrained_hand


def random_angles(model: ArticulatedModel, seed: int = 0) -> np.ndarray:
    """A pose within the limits, anywhere in the world."""
    rng = np.random.default_rng(seed)
    return np.r_[0.5 * rng.standard_normal(6), rng.uniform(model.skeleton.lower, model.skeleton.upper)]


def same_pose(blend: BlendModel, hand: ArticulatedModel, pose: np.ndarray, shape: np.ndarray) -> np.ndarray:
    """Vertices of the blend model at the rotations that the tracker's hand has at a pose."""
    assert hand.hand is not None
    posed = Scene((hand,)).pose_at(pose)
    bones = np.zeros(16, dtype=int)
    for finger, first in CHAINS.items():
        place = HAND_JOINTS.index(f"{finger}_{'cmc' if finger == 'thumb' else 'mcp'}")
        bones[first : first + 3] = hand.hand.joint_bones[place : place + 3]
    G = posed.Ms[bones, :, :3]
    local = np.concatenate([G[:1], G[blend.parents[1:]].swapaxes(1, 2) @ G[1:]])
    shaped = blend.shaped(shape)
    root = blend.joints_of(shaped)[0]
    translation = posed.Ms[0, :, :3] @ root + posed.Ms[0, :, 3] - root
    return blend.pose_at(Rotation.from_matrix(local).as_rotvec(), shape, translation).vertices


@pytest.mark.parametrize("side", ["right", "left"])
@pytest.mark.parametrize("seed", [0, 1, 2])
def test_it_has_the_surface_of_the_blend_model_in_every_pose(side, seed):
    blend = random_blend(seed, side=side)
    hand = articulated_of(blend)
    pose = random_angles(hand, seed)
    posed = Scene((hand,)).pose_at(pose)
    count = len(blend.template)
    vertices = same_pose(blend, hand, pose, np.zeros(blend.num_shape))
    # what is left out of a vertex as negligible is at most 1e-5 m for each of the 15 bones
    np.testing.assert_allclose(posed.vertices[:count], vertices, atol=1e-7)
    tips = posed.landmarks(0)[[HAND_JOINTS.index(f"{finger}_tip") for finger in FINGERS]]
    np.testing.assert_allclose(tips, vertices[blend.tips], atol=1e-7)


def test_its_shape_basis_is_the_blend_model_s(rng):
    blend = random_blend()
    hand = articulated_of(blend)
    assert hand.shape is not None and hand.shape.names[:2] == ("size", "shape_1")
    shape = rng.standard_normal(blend.num_shape)
    shaped = with_shape(hand, np.r_[0.0, shape])
    pose = random_angles(hand)
    posed = Scene((shaped,)).pose_at(pose)
    np.testing.assert_allclose(posed.vertices[: len(blend.template)], same_pose(blend, shaped, pose, shape), atol=1e-7)
    larger = with_shape(hand, np.r_[1.0, np.zeros(blend.num_shape)])
    ratio = (larger.vertices - hand.skeleton.joints_rest[0]) / (hand.vertices - hand.skeleton.joints_rest[0])
    np.testing.assert_allclose(ratio, 1.06, atol=1e-9)


def test_the_untrained_hand_is_skinned_only():
    assert articulated_of(untrained_hand()).pose_blend is None
    assert Scene((default_hand("right"),)).pose_blends is None


def test_the_wrist_is_closed_and_looks_outwards():
    blend = untrained_hand()
    assert not is_watertight(blend.faces)
    hand = articulated_of(blend)
    assert is_watertight(hand.faces) and compute_volume(hand.vertices, hand.faces) > 2e-4
    assert len(hand.vertices) == len(blend.template) + 1
    np.testing.assert_array_equal(hand.vertices[: len(blend.template)], blend.template)


def test_a_closed_surface_stays_as_it_is():
    cube = articulated_of(untrained_hand())
    vertices, faces, loops = close_wrist(cube.vertices, cube.faces)
    assert not loops and len(vertices) == len(cube.vertices) and len(faces) == len(cube.faces)


@pytest.mark.parametrize("side", ["right", "left"])
def test_all_21_joints_tips_and_finger_parts_are_there(side):
    blend = random_blend(side=side)
    hand = articulated_of(blend)
    assert hand.hand is not None and hand.hand.side == side
    landmarks = Scene((hand,)).pose_at(np.zeros(hand.num_dofs)).landmarks(0) - hand.hand.joint_offsets
    joints = blend.joints_of(blend.template)
    for name, place in (("wrist", 0), ("thumb_cmc", 13), ("index_mcp", 1), ("little_dip", 9), ("ring_pip", 11)):
        np.testing.assert_allclose(landmarks[HAND_JOINTS.index(name)], joints[place], atol=1e-12)
    assert set(hand.hand.finger_parts) == {"wrist"} | {
        f"{finger}_{segment}"
        for finger in FINGERS
        for segment in (("metacarpal", "proximal") if finger == "thumb" else ("proximal", "middle"))
    } | {f"{finger}_distal" for finger in FINGERS}
    assert all(len(ids) >= 10 for ids in (*hand.hand.fingertips, *hand.hand.finger_parts.values()))


def test_mirrored_hands_are_mirror_images():
    right = articulated_of(random_blend())
    left = mirror(right)
    pose = random_angles(right)
    mirrored = Scene((left,)).pose_at(mirror_pose(pose)).vertices
    np.testing.assert_allclose(mirrored, Scene((right,)).pose_at(pose).vertices * [1.0, -1.0, 1.0], atol=1e-9)
    other = articulated_of(mirror_blend(random_blend()))
    np.testing.assert_allclose(left.vertices, other.vertices, atol=1e-12)
    np.testing.assert_allclose(left.skeleton.dof_axes, other.skeleton.dof_axes, atol=1e-9)


def test_the_landmarks_jacobian_leaves_out_only_what_pose_blend_shapes_do():
    """Skinning's part is exact; the rest is what docs/hand_models.md measures."""
    hand = articulated_of(untrained_hand())
    scene = Scene((hand, articulated_of(random_blend(side="left"))))
    pose = np.concatenate([random_angles(model, n) for n, model in enumerate(scene.models)])
    posed = scene.pose_at(pose)
    ids = np.arange(0, len(posed.vertices), 37).astype(np.int32)
    jacobian = posed.vertex_jacobian(ids)
    exact = np.zeros_like(jacobian)
    for column in range(scene.num_dofs):
        step = np.zeros(scene.num_dofs)
        step[column] = 1e-6
        ahead, behind = (scene.pose_at(scene.retract(pose, s)).vertices[ids] for s in (step, -step))
        exact[:, :, column] = (ahead - behind) / 2e-6
    first = scene.vertex_models[ids] == 0
    np.testing.assert_allclose(jacobian[first], exact[first], atol=1e-8)
    roots = [*range(6), *range(scene.pose_slices[1].start, scene.pose_slices[1].start + 6)]
    np.testing.assert_allclose(jacobian[:, :, roots], exact[:, :, roots], atol=1e-8)
    assert np.abs(jacobian - exact).max() > 1e-4


def test_a_second_hand_keeps_its_own_pose_blend_shapes():
    models = articulated_of(random_blend(0)), articulated_of(random_blend(1, side="left"))
    poses = [random_angles(model, n) for n, model in enumerate(models)]
    both = Scene(models)
    posed = both.pose_at(np.concatenate(poses))
    for n, (model, pose) in enumerate(zip(models, poses, strict=True)):
        alone = Scene((model,)).pose_at(pose)
        np.testing.assert_allclose(
            posed.vertices[both.vertex_slices[n]], alone.vertices[: len(model.vertices)], atol=1e-12
        )
        np.testing.assert_allclose(posed.landmarks(n), alone.landmarks(0), atol=1e-12)


def test_its_file_holds_the_pose_blend_shapes(tmp_path):
    hand = articulated_of(random_blend())
    save_model(hand, tmp_path / "hand.npz")
    assert_same(load_model(tmp_path / "hand.npz"), hand)


def test_decimated_it_still_changes_with_the_pose():
    hand = articulated_of(random_blend())
    coarse = decimate(hand, 800)
    assert coarse.pose_blend is not None and len(coarse.pose_blend.directions) == len(coarse.vertices)


@pytest.mark.parametrize("name", ["hand.npz", "MANO_RIGHT.pkl", "MANO_RIGHT.npz"])
def test_hand_files_of_every_kind_are_followed(tmp_path, name):
    blend = random_blend()
    (save_blend_model if name == "hand.npz" else save_mano)(blend, tmp_path / name)
    hand = load_model(tmp_path / name)
    expected = articulated_of(blend)
    for field in fields(ArticulatedModel):
        if field.name not in ("provenance", "shape", "name"):
            assert_same(getattr(hand, field.name), getattr(expected, field.name))


def test_what_is_no_hand_is_refused(tmp_path):
    (tmp_path / "other.pkl").write_bytes(b"\x80\x02}q\x00.")
    with pytest.raises(ModelFileError, match="found no 'v_template'"):
        load_model(tmp_path / "other.pkl")
    hand = articulated_of(random_blend())
    save_model(hand, tmp_path / "hand.npz")
    from tracker.model.npz_arrays import read_npz_arrays
    from tracker.model.npz_files import write_npz_arrays

    arrays = read_npz_arrays(tmp_path / "hand.npz")
    write_npz_arrays(tmp_path / "hand.npz", {**arrays, "blend_bones": np.ones(15, dtype=np.int64)})
    with pytest.raises(ModelFileError, match="one bone twice"):
        load_model(tmp_path / "hand.npz")


def test_pose_blend_shapes_of_nothing_move_nothing():
    hand = articulated_of(random_blend())
    assert hand.pose_blend is not None
    flat = type(hand)(
        **{field.name: getattr(hand, field.name) for field in fields(hand) if field.name != "pose_blend"},
        pose_blend=PoseBlend(hand.pose_blend.bones, np.zeros_like(hand.pose_blend.directions)),
    )
    plain = type(hand)(**{f.name: getattr(hand, f.name) for f in fields(hand) if f.name != "pose_blend"})
    pose = random_angles(hand)
    np.testing.assert_array_equal(Scene((flat,)).pose_at(pose).vertices, Scene((plain,)).pose_at(pose).vertices)
