"""A hand whose surface changes with person and pose before it is skinned: MANO's model class, [R17] Eq. 1-4."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import numpy.typing as npt
from scipy import sparse

from tracker.model.blend_kernels import (
    BlendArrays,
    PosedArrays,
    blend_jacobian_into,
    pose_into,
    shape_into,
    turn_into,
)
from tracker.model.pose_blend import stack_pose_blend

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

BLEND_JOINTS: tuple[str, ...] = (
    "wrist",
    *(f"{finger}{number}" for finger in ("index", "middle", "little", "ring", "thumb") for number in (1, 2, 3)),
)
"""The 16 joints in MANO's order: the little finger comes before the ring finger, the thumb last."""

BLEND_PARENTS = np.array([-1, 0, 1, 2, 0, 4, 5, 0, 7, 8, 0, 10, 11, 0, 13, 14])


@dataclass(frozen=True, eq=False)
class BlendModel:
    """Template, blend shapes, joints and skinning weights of a hand, [R17] Eq. 1-4.

    Parameters and their derivatives stand in this order, P = 6 + 3K + S of them: a turn of the root (3), the
    translation (3), a turn of each of the K other bones (3K), the shape (S). A turn δ multiplies from the left,
    R <- exp(δ) R: about the axes of the world for the root, of the parent bone for the others.

    Attributes:
        name: For people.
        side: "right" or "left"; "body" of SMPL-H, whose joints are 52 and whose tips are those of right and left hand.
        template: (V, 3) mean shape in the zero pose, model frame, m.
        faces: (F, 3) counter-clockwise seen from outside; open at the wrist.
        shape_directions: (V, 3, S) m per standard deviation.
        pose_directions: (V, 3, 9K) m, by the elements of R_k - I, row by row, for the K bones behind the root.
        skinning_weights: (V, B), rows sum to one.
        joint_regressor: (B, V) joints from the vertices of the unposed, shaped template.
        parents: (B,) -1 for the root, a parent before its children.
        joint_names: B names.
        pose_mean: (3K,) mean of the poses the pose space was learnt from, rad.
        pose_components: (C, 3K) its principal components, in rows; none for a model without a pose space.
        tips: (5,) or (10,) vertex at the tip of thumb, index, middle, ring, little finger.
        provenance: Where the model came from, licence, what was done to it.
    """

    name: str
    side: str
    template: Array
    faces: Ints
    shape_directions: Array
    pose_directions: Array
    skinning_weights: Array
    joint_regressor: sparse.csr_array
    parents: Ints
    joint_names: tuple[str, ...]
    pose_mean: Array
    pose_components: Array
    tips: Ints
    provenance: dict[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        vertices, bones = len(self.template), len(self.parents)
        assert self.side in ("right", "left", "body"), f"side is {self.side!r}, not 'right', 'left' or 'body'"
        assert self.template.shape == (vertices, 3) and self.faces.shape[1:] == (3,)
        assert self.shape_directions.shape[:2] == (vertices, 3) and self.shape_directions.ndim == 3
        assert self.pose_directions.shape == (vertices, 3, 9 * (bones - 1)), self.pose_directions.shape
        assert self.skinning_weights.shape == (vertices, bones) and self.joint_regressor.shape == (bones, vertices)
        assert self.parents[0] == -1 and np.all(self.parents[1:] < np.arange(1, bones)) and self.parents[1:].min() >= 0
        assert len(self.joint_names) == bones and self.pose_mean.shape == (3 * (bones - 1),)
        assert self.pose_components.shape[1:] == self.pose_mean.shape and self.tips.shape in ((5,), (10,))

    @property
    def num_bones(self) -> int:
        return len(self.parents)

    @property
    def num_shape(self) -> int:
        return self.shape_directions.shape[2]

    @property
    def num_parameters(self) -> int:
        """P, shape included."""
        return 3 + 3 * self.num_bones + self.num_shape

    @cached_property
    def arrays(self) -> BlendArrays:
        """The model as the kernels read it."""
        return stack_blend(
            self.template,
            self.shape_directions,
            self.pose_directions,
            self.skinning_weights,
            self.joint_regressor,
            self.parents,
        )

    def shaped(self, shape: Array) -> Array:
        """(V, 3) the unposed template of a person, without pose blend shapes, m."""
        return self.template + self.shape_directions @ shape

    def joints_of(self, shaped: Array) -> Array:
        """(B, 3) joints of an unposed template (V, 3), m. Never of a posed one: joints are regressed before posing."""
        return self.joint_regressor @ shaped

    def pose_at(
        self,
        pose: Array | None = None,
        shape: Array | None = None,
        translation: Array | None = None,
        rest: Array | None = None,
    ) -> PosedBlend:
        """The hand in a pose.

        The root turns about its joint and not about the origin: v = R (x - j_0) + j_0 + translation, as in `smplx`.

        Args:
            pose: (B, 3) rotation vectors, the root's first, rad; zero when left out.
            shape: (S,) or fewer, the others zero; ignored when `rest` is given.
            translation: (3,) m.
            rest: (V, 3) a personal template in place of template and shape; joints are regressed from it, m.
        """
        pose = np.zeros((self.num_bones, 3)) if pose is None else np.ascontiguousarray(pose, dtype=np.float64)
        assert pose.shape == (self.num_bones, 3), pose.shape
        translation = np.zeros(3) if translation is None else np.ascontiguousarray(translation, dtype=np.float64)
        assert translation.shape == (3,)
        full = np.zeros(self.num_shape)
        if shape is not None:
            full[: len(shape)] = shape
        posed = PosedArrays.empty(len(self.template), self.num_bones)
        if rest is None:
            shape_into(posed.shaped, self.arrays, full)
        else:
            assert rest.shape == self.template.shape
            posed.shaped[:] = rest
        pose_into(posed, self.arrays, pose, translation)
        return PosedBlend(self, pose, full, translation, rest is not None, posed)

    def retract(self, pose: Array, shape: Array, translation: Array, step: Array) -> tuple[Array, Array, Array]:
        """Pose (B, 3), shape (S,) and translation (3,) after a step (P,), or (6 + 3K,) when the shape is held."""
        turns = np.concatenate([step[:3], step[6 : 3 + 3 * self.num_bones]]).reshape(-1, 3)
        turned = np.empty((self.num_bones, 3))
        turn_into(turned, np.ascontiguousarray(pose, dtype=np.float64), turns)
        change = step[3 + 3 * self.num_bones :]
        return turned, shape + change if len(change) else shape, translation + step[3:6]

    def pose_of(self, coefficients: Array, flat_mean: bool = False) -> Array:
        """(K, 3) rotation vectors of the bones behind the root, from coefficients of the pose space.

        Args:
            coefficients: (C,) or fewer.
            flat_mean: Coefficients count from the zero pose (`flat_hand_mean=True`), not from the mean pose.
        """
        pose = coefficients @ self.pose_components[: len(coefficients)]
        return (pose if flat_mean else pose + self.pose_mean).reshape(-1, 3)


@dataclass(frozen=True, eq=False)
class PosedBlend:
    """A blend model in one pose.

    Attributes:
        model: The model.
        pose: (B, 3) rad.
        shape: (S,).
        translation: (3,) m.
        is_personal: A personal template stood in for template and shape.
        arrays: All that was worked out.
    """

    model: BlendModel
    pose: Array
    shape: Array
    translation: Array
    is_personal: bool
    arrays: PosedArrays

    @property
    def vertices(self) -> Array:
        """(V, 3) posed, m."""
        return self.arrays.vertices

    @property
    def joints(self) -> Array:
        """(B, 3) posed, m."""
        return self.arrays.joints

    @property
    def joints_rest(self) -> Array:
        """(B, 3) before posing, m."""
        return self.arrays.joints_rest

    @property
    def rest(self) -> Array:
        """(V, 3) the surface that is skinned, T_P of [R17] Eq. 2, m."""
        return self.arrays.rest

    @property
    def Ts(self) -> Array:
        """(B, 3, 4) motion of each bone from rest to posed, m."""
        return self.arrays.Ts

    def vertex_jacobian(
        self, vertex_ids: Ints | None = None, with_shape: bool = True, with_blend: bool = True
    ) -> Array:
        """Derivative of the posed vertices by the parameters, (N, 3, P), exact, m.

        Args:
            vertex_ids: (N,) which vertices; all when left out.
            with_shape: With the S columns of the shape. They are left out of a personal template, too.
            with_blend: With what the pose does through the pose blend shapes. Without it the result is not exact.
        """
        ids = np.arange(len(self.vertices)) if vertex_ids is None else np.asarray(vertex_ids)
        with_shape = with_shape and not self.is_personal
        columns = 3 + 3 * self.model.num_bones + (self.model.num_shape if with_shape else 0)
        jacobian = np.empty((len(ids), 3, columns))
        blend_jacobian_into(jacobian, ids, self.arrays, self.model.arrays, with_blend, with_shape)
        return jacobian


def stack_blend(
    template: Array,
    shape_directions: Array,
    pose_directions: Array,
    skinning_weights: Array,
    joint_regressor: sparse.csr_array,
    parents: Ints,
) -> BlendArrays:
    """A model as the kernels read it; `BlendModel` has the shapes, without pose blend shapes K is 0."""
    most = max(1, int(np.count_nonzero(skinning_weights, axis=1).max(initial=1)))
    order = np.argsort(-np.abs(skinning_weights), axis=1, kind="stable")[:, :most]
    regressor = sparse.csr_array(joint_regressor)
    flat = np.ascontiguousarray(shape_directions, dtype=np.float64).reshape(len(template), -1)
    return BlendArrays(
        template=np.ascontiguousarray(template, dtype=np.float64),
        shape_directions=flat.reshape(shape_directions.shape),
        joint_directions=(regressor @ flat).reshape(len(parents), *shape_directions.shape[1:]),
        weight_bones=np.ascontiguousarray(order, dtype=np.int32),
        weights=np.ascontiguousarray(np.take_along_axis(skinning_weights, order, axis=1), dtype=np.float64),
        parents=parents.astype(np.int32),
        dof_starts=np.array([0, *range(6, 4 + 3 * len(parents), 3)], dtype=np.int32),
        dofs=np.arange(3 + 3 * len(parents), dtype=np.int32),
        regressor_starts=regressor.indptr.astype(np.int32),
        regressor_vertices=regressor.indices.astype(np.int32),
        regressor_values=np.ascontiguousarray(regressor.data, dtype=np.float64),
        blend=stack_pose_blend(pose_directions, np.arange(1, 1 + pose_directions.shape[2] // 9)),
    )
