"""Where a body is, how it is shaped, and how it holds its hands: in few numbers each."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.model.blend_limits import turn_jacobian
from tracker.model.blend_model import BlendModel
from tracker.model.body_hands import NUM_BODY_JOINTS, NUM_FINGER_JOINTS, body_hand
from tracker.registration.hand_state import HandState

Array = npt.NDArray[np.float64]

SIDES = ("left", "right")
"""In the order of SMPL-H's joints."""
NUM_TURNED = 3 + 3 * NUM_BODY_JOINTS
"""Parameters before the hands': a turn of the root, the translation, turns of the other joints of the body."""


@dataclass(frozen=True)
class BodyState(HandState):
    """Pose and shape of a body; the fingers' part of `pose` follows from `hands`.

    Attributes:
        hands: (2, C) coefficients of the pose space of left and right hand, from its mean pose, rad.
    """

    hands: Array

    @property
    def num_coefficients(self) -> int:
        return self.hands.shape[1]


@dataclass(frozen=True, eq=False)
class HandSpace:
    """The first components of both hands' pose spaces, [R17] §3.4: 6 for each hand, by default.

    Attributes:
        means: (2, 45) rad.
        components: (2, C, 45) in rows.
    """

    means: Array
    components: Array

    @property
    def size(self) -> int:
        return self.components.shape[1]

    def fingers_of(self, hands: Array) -> Array:
        """(30, 3) rotation vectors of left and right fingers from coefficients (2, C)."""
        return (self.means + np.einsum("hc,hcx->hx", hands, self.components)).reshape(-1, 3)

    def turns_of(self, fingers: Array) -> Array:
        """(2, 45, C) turns from the left of each finger joint per unit of each coefficient, at fingers (30, 3)."""
        turns = np.linalg.inv(turn_jacobian(fingers)).reshape(2, NUM_FINGER_JOINTS, 3, 3)
        own = self.components.reshape(2, self.size, NUM_FINGER_JOINTS, 3)
        return np.einsum("hjxy,hcjy->hjxc", turns, own).reshape(2, 3 * NUM_FINGER_JOINTS, self.size)


def hand_space(model: BlendModel, size: int = 6) -> HandSpace:
    """Of a body with SMPL-H's joints; `size` components for each hand."""
    hands = [body_hand(model, side) for side in SIDES]
    components = [hand.components_of(model) for hand in hands]
    assert all(1 <= size <= len(own) for own in components), f"{size} components of {len(components[0])}"
    means = np.array([model.pose_mean[hand.columns] for hand in hands])
    return HandSpace(means, np.array([own[:size] for own in components]))


def make_state(model: BlendModel, space: HandSpace, pose: Array | None = None, hands: Array | None = None) -> BodyState:
    """A state of the mean shape at the origin.

    Args:
        model: The body.
        space: Of its hands.
        pose: (52, 3) whose first 22 joints count, rad; zero when left out.
        hands: (2, C) or fewer columns; zero, the mean pose, when left out.
    """
    none = np.zeros((2, 0))
    state = BodyState(
        np.zeros((NUM_BODY_JOINTS, 3)) if pose is None else pose, np.zeros(model.num_shape), np.zeros(3), none
    )
    return with_hands(state, space, none if hands is None else hands)


def with_hands(state: BodyState, space: HandSpace, hands: Array) -> BodyState:
    """The state with other coefficients (2, C) of the hands, or as many columns as there are; the rest are zero."""
    full = np.zeros((2, space.size))
    count = min(space.size, hands.shape[1])
    full[:, :count] = hands[:, :count]
    pose = np.concatenate([state.pose[:NUM_BODY_JOINTS], space.fingers_of(full)])
    return BodyState(pose, state.shape, state.translation, full)


def move_body(model: BlendModel, space: HandSpace, state: BodyState, step: Array) -> BodyState:
    """The state after a step (69 + 2 C + S,): turns as in `BlendModel`, changes of coefficients and shape."""
    size = 2 * space.size
    turns = np.zeros(3 + 3 * model.num_bones)
    turns[:NUM_TURNED] = step[:NUM_TURNED]
    pose, shape, translation = model.retract(state.pose, state.shape, state.translation, turns)
    hands = state.hands + step[NUM_TURNED : NUM_TURNED + size].reshape(2, -1)
    pose = np.concatenate([pose[:NUM_BODY_JOINTS], space.fingers_of(hands)])
    return BodyState(pose, shape + step[NUM_TURNED + size :], translation, hands)


def reduce_jacobian(space: HandSpace, fingers: Array, jacobian: Array) -> Array:
    """(N, 3, 69 + 2 C + S) from (N, 3, 159 + S): the columns of the fingers by those of the hands' coefficients."""
    turns = space.turns_of(fingers)
    width = 3 * NUM_FINGER_JOINTS
    parts = [jacobian[:, :, :NUM_TURNED]]
    for k in range(2):
        parts.append(jacobian[:, :, NUM_TURNED + k * width : NUM_TURNED + (k + 1) * width] @ turns[k])
    return np.concatenate([*parts, jacobian[:, :, NUM_TURNED + 2 * width :]], axis=2)
