"""Several models with one stacked pose, and the scene at one pose."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from tracker.geometry import se3
from tracker.geometry.vertex_normals import normals_into
from tracker.model.articulated import ArticulatedModel
from tracker.model.kinematics import SceneArrays, move_bones_into
from tracker.model.pose_blend import NEGLIGIBLE, join_pose_blends, stack_pose_blend
from tracker.model.skinning import MAX_WEIGHTS, PoseBlendArrays, add_pose_blend, skin_into, vertex_rows_into

Array = npt.NDArray[np.float64]

PARALLEL = 0.999
"""Cosine above which two axes are one."""


@dataclass(frozen=True)
class Scene:
    """Models that are tracked together; their poses are stacked in order, [T16] §3.1.

    Attributes:
        models: At least one.
    """

    models: tuple[ArticulatedModel, ...]

    @cached_property
    def num_dofs(self) -> int:
        return sum(model.num_dofs for model in self.models)

    @cached_property
    def pose_slices(self) -> tuple[slice, ...]:
        """Where each model's parameters stand in the pose."""
        return _slices([model.num_dofs for model in self.models])

    @cached_property
    def vertex_slices(self) -> tuple[slice, ...]:
        return _slices([len(model.vertices) for model in self.models])

    @cached_property
    def bone_slices(self) -> tuple[slice, ...]:
        return _slices([model.skeleton.num_bones for model in self.models])

    @cached_property
    def face_models(self) -> npt.NDArray[np.int32]:
        """(F,) index of the model that a face belongs to."""
        return np.repeat(np.arange(len(self.models), dtype=np.int32), [len(model.faces) for model in self.models])

    @cached_property
    def open_faces(self) -> npt.NDArray[np.bool_]:
        """(F,) whether a face belongs to a mesh with holes, so that its inside can be seen."""
        has_holes = [not model.is_closed for model in self.models]
        return np.repeat(np.array(has_holes, dtype=np.bool_), [len(model.faces) for model in self.models])

    @cached_property
    def landmark_slices(self) -> tuple[slice, ...]:
        """Where each model's landmarks stand among the scene's vertices, behind the vertices of all models.

        A hand has its 21 joints, an object the joints of its bones. As vertices that no face uses they move, and are
        differentiated, like any other.
        """
        vertices = sum(len(model.vertices) for model in self.models)
        lengths = [21 if model.hand else model.skeleton.num_bones for model in self.models]
        return tuple(slice(s.start + vertices, s.stop + vertices) for s in _slices(lengths))

    @cached_property
    def vertex_models(self) -> npt.NDArray[np.int32]:
        """(V,) index of the model that a vertex, landmarks included, belongs to."""
        models = np.zeros(self.landmark_slices[-1].stop, dtype=np.int32)
        for index, (vertices, landmarks) in enumerate(zip(self.vertex_slices, self.landmark_slices, strict=True)):
            models[vertices] = models[landmarks] = index
        return models

    @cached_property
    def is_palm(self) -> npt.NDArray[np.bool_]:
        """(V,) whether a vertex follows the root of a hand most."""
        arrays = self.arrays
        roots = [bones.start for model, bones in zip(self.models, self.bone_slices, strict=True) if model.hand]
        return np.isin(arrays.weight_bones[np.arange(len(arrays.weights)), arrays.weights.argmax(axis=1)], roots)

    @cached_property
    def angle_dofs(self) -> npt.NDArray[np.int64]:
        """(K,) places of the joint angles in the pose."""
        return np.concatenate([np.arange(s.start + 6, s.stop) for s in self.pose_slices])

    @cached_property
    def bends(self) -> npt.NDArray[np.int64]:
        """(K, 2) places in the pose of joints of an object and of the joint about the same axis of the bone before.

        Hands have none: their fingers do not bend evenly.
        """
        pairs = []
        for model, where in zip(self.models, self.pose_slices, strict=True):
            skeleton = model.skeleton
            if model.hand is not None:
                continue
            for dof, bone in enumerate(skeleton.dof_bones):
                for other in np.flatnonzero(skeleton.dof_bones == skeleton.parents[bone]):
                    if skeleton.dof_axes[dof] @ skeleton.dof_axes[other] > PARALLEL:
                        pairs.append((where.start + 6 + dof, where.start + 6 + int(other)))
        return np.array(pairs, dtype=np.int64).reshape(-1, 2)

    @cached_property
    def lower(self) -> Array:
        """(D,) lower limits, rad; -inf for the roots."""
        return np.concatenate([np.r_[np.full(6, -np.inf), model.skeleton.lower] for model in self.models])

    @cached_property
    def upper(self) -> Array:
        """(D,) upper limits, rad; +inf for the roots."""
        return np.concatenate([np.r_[np.full(6, np.inf), model.skeleton.upper] for model in self.models])

    @cached_property
    def arrays(self) -> SceneArrays:
        return _stack(self)

    @cached_property
    def bone_pairs(self) -> tuple[npt.NDArray[np.int32], npt.NDArray[np.int32]]:
        """(N, 2) pairs of bones with weight on a common face, the lower first; (B, B) place of a pair, -1 for none."""
        arrays = self.arrays
        bones = len(arrays.parents)
        follows = np.zeros((len(arrays.vertices), bones), dtype=bool)
        for slot in range(arrays.weights.shape[1]):
            used = arrays.weights[:, slot] > 0
            follows[np.flatnonzero(used), arrays.weight_bones[used, slot]] = True
        on_face = follows[arrays.faces].any(axis=1).astype(np.int64)
        on_vertex = follows.astype(np.int64)
        shared = (np.matmul(on_face.T, on_face) + np.matmul(on_vertex.T, on_vertex)) > 0
        j, k = np.nonzero(np.triu(shared))
        places = np.full((bones, bones), -1, dtype=np.int32)
        places[j, k] = places[k, j] = np.arange(len(j))
        return np.stack([j, k], axis=1).astype(np.int32), places

    @cached_property
    def pose_blends(self) -> PoseBlendArrays | None:
        """How surfaces at rest change with the pose; None where they do not."""
        parts = []
        for model, vs, bs, ls in zip(
            self.models, self.vertex_slices, self.bone_slices, self.landmark_slices, strict=True
        ):
            if model.pose_blend is None:
                continue
            assert model.hand is not None, "only hands have pose blend shapes"
            marks = np.flatnonzero(model.hand.joint_vertices >= 0)
            own = model.pose_blend.directions
            directions = np.concatenate([own, own[model.hand.joint_vertices[marks]]])
            places = np.concatenate([np.arange(vs.start, vs.stop), ls.start + marks])
            parts.append(stack_pose_blend(directions, model.pose_blend.bones + bs.start, places, NEGLIGIBLE))
        return join_pose_blends(parts) if parts else None

    def surface_at(self, Ms: Array) -> Array:
        """(V, 3) the surfaces at rest as they are at a pose, given by the bones' motions (B, 3, 4), m."""
        blends = self.pose_blends
        if blends is None:
            return self.arrays.vertices
        rest = self.arrays.vertices.copy()
        add_pose_blend(rest, Ms, self.arrays.parents, blends)
        return rest

    def rest_pose(self) -> Array:
        """(D,) every model as in its file."""
        return np.zeros(self.num_dofs)

    def pose_at(self, pose: Array) -> PosedScene:
        """The scene at the pose (D,)."""
        assert pose.shape == (self.num_dofs,)
        arrays = self.arrays
        Ms = np.zeros((len(arrays.parents), 3, 4))
        twists = np.zeros((self.num_dofs, 6))
        vertices = np.zeros((len(arrays.vertices), 3))
        bone_vertices = np.zeros((*arrays.weights.shape, 3))
        normals = np.zeros_like(vertices)
        pose = np.ascontiguousarray(pose, dtype=np.float64)
        move_bones_into(Ms, twists, arrays, pose)
        skin_into(vertices, bone_vertices, self.surface_at(Ms), arrays, Ms)
        normals_into(normals, vertices, arrays.faces)
        return PosedScene(self, pose, Ms, twists, vertices, bone_vertices, normals)

    def retract(self, pose: Array, step: Array) -> Array:
        """The pose after an increment (D,): angles add, roots are turned from the left about their joint."""
        assert pose.shape == step.shape == (self.num_dofs,)
        result = pose + step
        for model, where in zip(self.models, self.pose_slices, strict=True):
            root = slice(where.start, where.start + 6)
            T = se3.exp(pose[root])
            center = se3.transform(T, model.skeleton.joints_rest[0])
            increment = se3.exp(step[root])
            increment[:3, 3] += center - increment[:3, :3] @ center
            result[root] = se3.log(increment @ T)
        return result


@dataclass(frozen=True)
class PosedScene:
    """A scene at one pose.

    Attributes:
        scene: The scene.
        pose: (D,).
        Ms: (B, 3, 4) motion of each bone from rest to world, m.
        twists: (D, 6) world twist (u, ω) of each degree of freedom.
        vertices: (V, 3) world, m.
        bone_vertices: (V, W, 3) each vertex carried by each of its bones alone, world, m.
        normals: (V, 3) unit, world.
    """

    scene: Scene
    pose: Array
    Ms: Array
    twists: Array
    vertices: Array
    bone_vertices: Array
    normals: Array

    def landmarks(self, model: int) -> Array:
        """The 21 joints of a hand in the order of HAND_JOINTS, or (B, 3) the joints of an object's bones, world, m."""
        return self.vertices[self.scene.landmark_slices[model]]

    def vertex_jacobian(self, vertex_ids: npt.NDArray[np.integer]) -> Array:
        """Derivative of the posed vertices (N,) by the pose, their surface at rest held: (N, 3, D), m.

        Root parameters are increments multiplied from the left about the root's joint, as `Scene.retract` applies them.
        """
        ids = np.asarray(vertex_ids, dtype=np.int32)
        jacobian, nothing = np.empty((len(ids), 3, self.scene.num_dofs)), np.empty((len(self.Ms), 3, 0))
        rest = self.scene.surface_at(self.Ms)
        vertex_rows_into(jacobian, ids, rest, self.Ms, self.twists, self.scene.arrays, nothing, nothing)
        return jacobian

    def T_world_model(self, model: int) -> Array:
        """(4, 4) motion of the root of one model: its file's coordinates to world, m."""
        T = np.eye(4)
        T[:3] = self.Ms[self.scene.bone_slices[model].start]
        return T


def _slices(lengths: list[int]) -> tuple[slice, ...]:
    ends = np.cumsum(lengths)
    return tuple(slice(int(end - length), int(end)) for end, length in zip(ends, lengths, strict=True))


def _stack(scene: Scene) -> SceneArrays:
    vertices, faces, weight_bones, weights, parents, root_joints = [], [], [], [], [], []
    landmarks: list[tuple[Array, npt.NDArray, npt.NDArray]] = []
    bone_dofs, axes, points = [], [], []
    for model, vs, bs, ps in zip(scene.models, scene.vertex_slices, scene.bone_slices, scene.pose_slices, strict=True):
        skeleton = model.skeleton
        order = np.argsort(-model.skinning_weights, axis=1, kind="stable")[:, :MAX_WEIGHTS]
        if order.shape[1] < MAX_WEIGHTS:
            order = np.pad(order, ((0, 0), (0, MAX_WEIGHTS - order.shape[1])), mode="edge")
        kept = np.take_along_axis(model.skinning_weights, order, axis=1)
        kept[:, min(MAX_WEIGHTS, skeleton.num_bones) :] = 0.0
        vertices.append(model.vertices)
        landmarks.append(_landmarks(model, bs.start, vs.start))
        faces.append(model.faces + vs.start)
        weight_bones.append(order + bs.start)
        weights.append(kept / kept.sum(axis=1, keepdims=True))
        parents.append(np.where(skeleton.parents < 0, -1, skeleton.parents + bs.start))
        root_joints.append(skeleton.joints_rest)
        for bone in range(skeleton.num_bones):
            root = np.arange(6 if skeleton.parents[bone] < 0 else 0)
            own = np.flatnonzero(skeleton.dof_bones == bone)
            bone_dofs.append(np.concatenate([root, own + 6]) + ps.start)
            axes.append(np.concatenate([np.zeros((len(root), 3)), skeleton.dof_axes[own]]))
            points.append(np.repeat(skeleton.joints_rest[bone][None], len(root) + len(own), axis=0))
    for index, (points_rest, bones, own_vertices) in enumerate(landmarks):
        ids = np.where(own_vertices >= 0, own_vertices - scene.vertex_slices[index].start, 0)
        at_bone = np.zeros((len(bones), MAX_WEIGHTS))
        at_bone[:, 0] = 1.0
        is_vertex = (own_vertices >= 0)[:, None]
        vertices.append(points_rest)
        weight_bones.append(np.where(is_vertex, weight_bones[index][ids], bones[:, None]))
        weights.append(np.where(is_vertex, weights[index][ids], at_bone))
    stacked_parents = np.concatenate(parents).astype(np.int32)
    return SceneArrays(
        vertices=np.ascontiguousarray(np.concatenate(vertices), dtype=np.float64),
        faces=np.ascontiguousarray(np.concatenate(faces), dtype=np.int32),
        weight_bones=np.ascontiguousarray(np.concatenate(weight_bones), dtype=np.int32),
        weights=np.ascontiguousarray(np.concatenate(weights), dtype=np.float64),
        parents=stacked_parents,
        root_joints=np.ascontiguousarray(np.concatenate(root_joints), dtype=np.float64),
        dof_starts=np.cumsum([0, *(len(own) for own in bone_dofs)]).astype(np.int32),
        dofs=np.concatenate(bone_dofs).astype(np.int32),
        axes=np.ascontiguousarray(np.concatenate(axes), dtype=np.float64),
        points=np.ascontiguousarray(np.concatenate(points), dtype=np.float64),
        chains=_chains(stacked_parents, bone_dofs),
    )


def _landmarks(model: ArticulatedModel, first_bone: int, first_vertex: int) -> tuple[Array, npt.NDArray, npt.NDArray]:
    """Rest positions, bones (-1 where a vertex is meant) and vertices (-1 where a bone is meant) of the landmarks."""
    joints, hand = model.skeleton.joints_rest, model.hand
    if hand is None:
        bones = np.arange(len(joints))
        return joints, bones + first_bone, np.full(len(joints), -1)
    at_bone = hand.joint_bones >= 0
    rest = np.where(at_bone[:, None], joints[hand.joint_bones], model.vertices[hand.joint_vertices])
    return (
        rest + hand.joint_offsets,
        np.where(at_bone, hand.joint_bones + first_bone, 0),
        np.where(at_bone, -1, hand.joint_vertices + first_vertex),
    )


def _chains(parents: npt.NDArray[np.int32], bone_dofs: list[npt.NDArray]) -> npt.NDArray[np.int32]:
    chains: list[list[int]] = []
    for parent, own in zip(parents, bone_dofs, strict=True):
        chains.append([*(chains[parent] if parent >= 0 else ()), *own.tolist()])
    longest = max(len(chain) for chain in chains)
    return np.array([chain + [-1] * (longest - len(chain)) for chain in chains], dtype=np.int32)
