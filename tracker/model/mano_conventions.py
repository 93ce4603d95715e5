"""In what way programs around MANO differ, each way to be chosen: references in docs/hand_models.md."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.model.blend_model import BlendModel, PosedBlend

Array = npt.NDArray[np.float64]

TIP_VERTICES: dict[str, dict[str, tuple[int, ...]]] = {
    "smplx": {"right": (744, 320, 443, 554, 671), "left": (744, 320, 443, 554, 671)},
    "manopth": {"right": (745, 317, 444, 556, 673), "left": (745, 317, 445, 556, 673)},
    "ho3d": {"right": (728, 353, 442, 576, 694), "left": (728, 353, 442, 576, 694)},
}
"""Vertices of MANO's 778 at the tips of thumb, index, middle, ring, little finger; "manopth" is manotorch's set too."""

SMPLH_TIP_VERTICES = {"right": (6191, 5782, 5905, 6016, 6133), "left": (2746, 2319, 2445, 2556, 2673)}
"""The same of SMPL-H's 6890."""

OPENPOSE_ORDER = (0, 13, 14, 15, 16, 1, 2, 3, 17, 4, 5, 6, 18, 10, 11, 12, 19, 7, 8, 9, 20)
"""Places of OpenPose's 21 joints, which are ours (`HAND_JOINTS`), among MANO's 16 joints with the five tips behind.

MANO has the little finger before the ring finger, and the thumb last."""


@dataclass(frozen=True)
class ManoConvention:
    """How one program or data set poses MANO and what it gives back.

    Attributes:
        flat_hand_mean: A pose counts from the flat hand, not from the file's mean pose.
        num_components: How many components of the pose space a pose has; 45 is none: rotation vectors themselves.
        tips: Which of TIP_VERTICES.
        with_tips: Joints are 21 in OpenPose's order, not MANO's 16.
        units_per_metre: Of vertices and joints that come out.
        center_joint: This joint, of the order that comes out, is subtracted; None for none.
        fix_left_shape: The left hand's shape directions, which the published file copied from the right hand without
            mirroring them, are mirrored: their x changes sign.
    """

    flat_hand_mean: bool = False
    num_components: int = 6
    tips: str = "smplx"
    with_tips: bool = False
    units_per_metre: float = 1.0
    center_joint: int | None = None
    fix_left_shape: bool = True


CONVENTIONS: dict[str, ManoConvention] = {
    "smplx": ManoConvention(fix_left_shape=False),
    "manopth": ManoConvention(True, 6, "manopth", True, 1000.0, 0, fix_left_shape=False),
    "manotorch": ManoConvention(True, 15, "manopth", True, 1.0, 0, fix_left_shape=False),
    "dexycb": ManoConvention(False, 45, "manopth", True, 1.0, fix_left_shape=False),
    "interhand2.6m": ManoConvention(False, 45, "smplx", fix_left_shape=True),
    "ho3d": ManoConvention(True, 45, "ho3d", True, 1.0, fix_left_shape=False),
}
"""By name. ARCTIC's annotations of left hands are mixed: try both signs and look."""


def pose_of_parameters(model: BlendModel, parameters: Array, global_orient: Array, convention: ManoConvention) -> Array:
    """(16, 3) pose of a hand, rad, from its parameters as a program has them.

    Args:
        model: A hand, its mean pose as in its file.
        parameters: (n,) coefficients of the pose space for n up to `num_components`, or (45,) rotation vectors where
            that is 45: as many components as there are switch the pose space off, as in `smplx`.
        global_orient: (3,) rad, about joint 0 of the shaped hand and not about the origin.
        convention: Whose parameters they are.
    """
    if convention.num_components == 3 * (model.num_bones - 1):
        pose = parameters if convention.flat_hand_mean else parameters + model.pose_mean
        hand = pose.reshape(-1, 3)
    else:
        hand = model.pose_of(parameters, convention.flat_hand_mean)
    return np.concatenate([global_orient[None], hand])


def present(posed: PosedBlend, convention: ManoConvention) -> tuple[Array, Array]:
    """Vertices (V, 3) and joints (16 or 21, 3) of a posed hand as a program gives them, in its unit."""
    joints = posed.joints
    if convention.with_tips:
        joints = np.concatenate([joints, posed.vertices[posed.model.tips]])[list(OPENPOSE_ORDER)]
    center = 0.0 if convention.center_joint is None else joints[convention.center_joint]
    return (posed.vertices - center) * convention.units_per_metre, (joints - center) * convention.units_per_metre
