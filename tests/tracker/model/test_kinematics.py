"""A scene moves as [T16] Eq. 1-4 say, and its Jacobian is exact."""

from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.toys import tube
from tracker.geometry import se3
from tracker.model.default_hand import default_hand
from tracker.model.scene import Scene


def random_pose(scene: Scene, rng: np.random.Generator) -> np.ndarray:
    return rng.normal(scale=0.5, size=scene.num_dofs)


def skin_plainly(scene: Scene, pose: np.ndarray) -> np.ndarray:
    """[T16] Eq. 1 in NumPy, one model and one bone at a time."""
    vertices = []
    for model, where in zip(scene.models, scene.pose_slices, strict=True):
        own, skeleton = pose[where], model.skeleton
        Ms = np.zeros((skeleton.num_bones, 4, 4))
        for bone, parent in enumerate(skeleton.parents):
            Ms[bone] = se3.exp(own[:6]) if parent < 0 else Ms[parent]
            for k in np.flatnonzero(skeleton.dof_bones == bone):
                axis, point = skeleton.dof_axes[k], skeleton.joints_rest[bone]
                Ms[bone] = Ms[bone] @ se3.exp(own[6 + k] * np.concatenate([np.cross(point, axis), axis]))
        homogeneous = np.c_[model.vertices, np.ones(len(model.vertices))]
        vertices.append(np.einsum("vb,bij,vj->vi", model.skinning_weights, Ms, homogeneous)[:, :3])
    return np.concatenate(vertices)


def test_kernels_agree_with_plain_skinning(rng):
    scene = Scene((tube(3), tube(4)))
    pose = random_pose(scene, rng)
    vertices = scene.pose_at(pose).vertices[: scene.vertex_slices[-1].stop]
    np.testing.assert_allclose(vertices, skin_plainly(scene, pose), atol=1e-12)


def test_landmarks_of_an_object_are_the_joints_of_its_bones(rng):
    scene = Scene((tube(3), tube(4)))
    pose = random_pose(scene, rng)
    posed = scene.pose_at(pose)
    second = Scene((tube(4),)).pose_at(pose[scene.pose_slices[1]])
    joints = np.einsum("bij,bj->bi", second.Ms[:, :, :3], tube(4).skeleton.joints_rest) + second.Ms[:, :, 3]
    np.testing.assert_allclose(posed.landmarks(1), joints, atol=1e-12)


def test_the_rest_pose_leaves_every_vertex_where_it_is():
    scene = Scene((tube(),))
    vertices = scene.pose_at(scene.rest_pose()).vertices[: scene.vertex_slices[0].stop]
    np.testing.assert_allclose(vertices, tube().vertices, atol=1e-15)


def test_vertex_jacobian_agrees_with_finite_differences(rng):
    scene = Scene((tube(3), tube(4)))
    pose = random_pose(scene, rng)
    posed = scene.pose_at(pose)
    ids = np.arange(len(posed.vertices), dtype=np.int32)
    jacobian = posed.vertex_jacobian(ids)
    step = 1e-6
    for dof in range(scene.num_dofs):
        delta = np.zeros(scene.num_dofs)
        delta[dof] = step
        ahead = scene.pose_at(scene.retract(pose, delta)).vertices
        behind = scene.pose_at(scene.retract(pose, -delta)).vertices
        np.testing.assert_allclose(jacobian[:, :, dof], (ahead - behind) / (2 * step), atol=1e-8)


def test_normals_of_a_closed_tube_point_outward(rng):
    scene = Scene((tube(),))
    posed = scene.pose_at(scene.rest_pose())
    vertices, normals = posed.vertices[scene.vertex_slices[0]], posed.normals[scene.vertex_slices[0]]
    nearest_axis = vertices.copy()
    nearest_axis[:, 1:] = 0.0
    nearest_axis[:, 0] = np.clip(nearest_axis[:, 0], 0.0, 0.09)
    assert np.all(np.einsum("vi,vi->v", normals, vertices - nearest_axis) > 0)
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1.0)


def test_a_joint_marked_elsewhere_rides_on_its_bone_and_leaves_everything_else_alone(rng):
    hand = default_hand("right")
    assert hand.hand is not None
    offsets = np.zeros((21, 3))
    offsets[[0, 6, 8]] = rng.normal(scale=0.01, size=(3, 3))
    marked = replace(hand, hand=replace(hand.hand, joint_offsets=offsets))
    pose = rng.uniform(-0.4, 0.4, hand.num_dofs)
    plain, moved = Scene((hand,)).pose_at(pose), Scene((marked,)).pose_at(pose)
    count = len(hand.vertices)
    np.testing.assert_array_equal(moved.vertices[:count], plain.vertices[:count])
    apart = moved.landmarks(0) - plain.landmarks(0)
    for joint in (0, 6):  # at a bone's joint: turned exactly as the bone is
        turn = plain.Ms[hand.hand.joint_bones[joint]][:, :3]
        np.testing.assert_allclose(apart[joint], turn @ offsets[joint], atol=1e-12)
    assert np.linalg.norm(apart[8]) == pytest.approx(np.linalg.norm(offsets[8]), rel=0.05)
    assert not apart[[index for index in range(21) if index not in (0, 6, 8)]].any()
