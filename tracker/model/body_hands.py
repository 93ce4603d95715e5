"""Where the two hands are in a body of SMPL-H's class, and how their poses are written."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.model.blend_model import Array, BlendModel
from tracker.model.mano_files import BODY_JOINTS, SMPLH_JOINTS

Ints = npt.NDArray[np.int64]

NUM_BODY_JOINTS = len(BODY_JOINTS)
NUM_FINGER_JOINTS = (len(SMPLH_JOINTS) - NUM_BODY_JOINTS) // 2
R_BODY_HAND = {
    "right": np.array([[-1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]]),
    "left": np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]]),
}
"""From the axes of Handloom's hands (x to the middle knuckle, z out of the back) to those of the body in the T-pose."""


@dataclass(frozen=True, eq=False)
class BodyHand:
    """One hand of a body.

    Attributes:
        side: "right" or "left".
        wrist: Its joint.
        elbow: Its joint.
        fingers: (15,) joints of the fingers in MANO's order.
        vertices: (782,) of the body with the hands that come with Handloom, in the hand model's order; else none.
        R_body_hand: (3, 3) from the axes of the hand model to the body's.
        outwards: (3,) factors that turn the body's x axis towards the fingers.
    """

    side: str
    wrist: int
    elbow: int
    fingers: Ints
    vertices: Ints
    R_body_hand: Array
    outwards: Array

    @property
    def columns(self) -> slice:
        """Where the fingers' 45 numbers stand in the pose space of the body, which has none for the root."""
        return slice(3 * (int(self.fingers[0]) - 1), 3 * int(self.fingers[-1]))

    def components_of(self, model: BlendModel) -> Array:
        """(C, 45) the components of the body's pose space that are this hand's."""
        own = model.pose_components[:, self.columns]
        return own[np.any(own != 0.0, axis=1)]


def body_hand(model: BlendModel, side: str) -> BodyHand:
    """A hand of a body with SMPL-H's 52 joints; the provenance of a body of our own says which vertices are its."""
    assert model.side == "body" and side in ("right", "left")
    first = NUM_BODY_JOINTS + (NUM_FINGER_JOINTS if side == "right" else 0)
    told = model.provenance.get(f"{side}_hand_vertices", "0:0").split(":")
    return BodyHand(
        side=side,
        wrist=BODY_JOINTS.index(f"{side}_wrist"),
        elbow=BODY_JOINTS.index(f"{side}_elbow"),
        fingers=np.arange(first, first + NUM_FINGER_JOINTS),
        vertices=np.arange(int(told[0]), int(told[1])),
        R_body_hand=R_BODY_HAND[side],
        outwards=np.array([-1.0 if side == "right" else 1.0, 1.0, 1.0]),
    )


def body_pose(
    model: BlendModel, root: Array, body: Array, hands: dict[str, Array], is_flat_mean: bool = False
) -> Array:
    """(52, 3) pose of a body, rad, its hands given by few numbers or by all, as in `smplx`.

    Args:
        model: The body.
        root: (3,) rotation vector of the pelvis, about its joint.
        body: (21, 3) rotation vectors of the joints behind it, wrists included.
        hands: For "left" and "right", either may be missing, the first n < 45 coefficients of its pose space, or 45
            rotation vectors' numbers.
        is_flat_mean: They count from the flat hand, not from the mean pose.
    """
    pose = np.concatenate([root[None], body, np.zeros((2 * NUM_FINGER_JOINTS, 3))])
    for side in ("left", "right"):
        hand = body_hand(model, side)
        numbers = hands.get(side, np.zeros(0))
        assert numbers.ndim == 1 and len(numbers) <= 3 * NUM_FINGER_JOINTS
        if len(numbers) < 3 * NUM_FINGER_JOINTS:
            numbers = numbers @ hand.components_of(model)[: len(numbers)]
        if not is_flat_mean:
            numbers = numbers + model.pose_mean[hand.columns]
        pose[hand.fingers] = numbers.reshape(-1, 3)
    return pose
