"""Pose and shape of a body, or of a part of it, with hands of few numbers: [R17] Eq. 12, 20 and 23 for the model."""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.bodies.body_state import NUM_TURNED, BodyState, HandSpace, hand_space, move_body, reduce_jacobian
from tracker.bodies.hand_mixture import HandMixture
from tracker.model.blend_limits import turn_jacobian
from tracker.model.blend_model import BlendModel, PosedBlend
from tracker.model.body_hands import NUM_BODY_JOINTS
from tracker.registration.hand_state import HandState
from tracker.registration.model_fit import ModelFit, Posed, spread
from tracker.registration.pose_prior import PosePrior
from tracker.registration.surface_search import SurfaceSearch

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Anchor:
    """Poses that a fit is held to, [R17] Eq. 21: E_r = Σ |θ_k - θ'_k|².

    Attributes:
        state: θ', mostly of the frame before.
        body: Weight of the 21 joints behind the root, 1/rad².
        hands: (2,) weights of the coefficients of left and right hand, 1/rad².
    """

    state: BodyState
    body: float
    hands: Array


@dataclass(frozen=True, eq=False)
class PosedBody:
    """A posed body of which some vertices are fitted.

    Attributes:
        whole: All of it.
        vertices: (V', 3) those that are fitted, m.
        ids: (V',) which these are.
    """

    whole: PosedBlend
    vertices: Array
    ids: Ints

    def vertex_jacobian(self, vertex_ids: Ints | None = None) -> Array:
        """Derivative by all joints' turns, whatever is fitted."""
        return self.whole.vertex_jacobian(self.ids if vertex_ids is None else self.ids[vertex_ids])


class BodyFit(ModelFit):
    """Fits a body, or a part of it, to points.

    Its parameters are a turn of the root, the translation, turns of the other 21 joints of the body, C coefficients
    each of left and right hand, and the shape: 69 + 2 C + S. Where some are held, those that are fitted.

    Args:
        model: A body with SMPL-H's joints; of a person's own template it has no shape directions.
        prior: Of the 21 joints.
        mixture: Of the hands' coefficients, at least C of them; None for no prior.
        size: C, components for each hand.
        vertex_ids: (V',) vertices that are fitted; all when left out.
        columns: (P',) parameters that are fitted; all when left out.
    """

    def __init__(
        self,
        model: BlendModel,
        prior: PosePrior,
        mixture: HandMixture | None,
        size: int = 6,
        vertex_ids: Ints | None = None,
        columns: Ints | None = None,
    ) -> None:
        self.model = model
        self.prior = prior
        self.space: HandSpace = hand_space(model, size)
        self.mixture = None if mixture is None else mixture.first(size)
        self.anchor: Anchor | None = None
        self.ids = np.arange(len(model.template)) if vertex_ids is None else vertex_ids
        self.num_all = NUM_TURNED + 2 * size + model.num_shape
        self.columns = np.arange(self.num_all) if columns is None else columns
        template = np.ascontiguousarray(model.template[self.ids])
        self.search = SurfaceSearch(template, _faces_of(model.faces, self.ids, len(model.template)))
        self.inner = spread(template, ~self.search.is_rim_vertex)
        scales = np.full(self.num_all, 0.3)
        scales[3:6] = 0.02
        scales[NUM_TURNED + 2 * size :] = 1.0
        self.scales = scales[self.columns]

    def anchored(self, anchor: Anchor | None) -> BodyFit:
        """The same fit held to an earlier pose."""
        other = copy(self)
        other.anchor = anchor
        return other

    def without(self, vertex_ids: Ints) -> BodyFit:
        """The same fit, in which these vertices do not look for the scan: it does not show them."""
        other = copy(self)
        other.inner = self.inner[~np.isin(self.ids[self.inner], vertex_ids)]
        return other

    def pose(self, state: HandState) -> Posed:
        whole = state.posed(self.model)
        vertices = whole.vertices if len(self.ids) == len(whole.vertices) else whole.vertices[self.ids]
        return PosedBody(whole, vertices, self.ids)

    def jacobian(self, posed: Posed, vertex_ids: Ints | None = None) -> Array:
        assert isinstance(posed, PosedBody)
        fingers = posed.whole.pose[NUM_BODY_JOINTS:]
        jacobian = reduce_jacobian(self.space, fingers, posed.vertex_jacobian(vertex_ids))
        return jacobian if len(self.columns) == self.num_all else np.ascontiguousarray(jacobian[:, :, self.columns])

    def move(self, state: HandState, step: Array) -> HandState:
        assert isinstance(state, BodyState)
        full = np.zeros(self.num_all)
        full[self.columns] = step
        return move_body(self.model, self.space, state, full)

    def prior_cost(self, state: HandState, pose_weight: float, shape_weight: float) -> float:
        assert isinstance(state, BodyState)
        cost = self.prior.cost(state.pose[1:NUM_BODY_JOINTS])
        if self.mixture is not None:
            cost += sum(self.mixture.linearize(hand)[0] for hand in state.hands)
        cost = pose_weight * cost + shape_weight * float(state.shape @ state.shape)
        if self.anchor is not None:
            apart = (state.pose - self.anchor.state.pose)[1:NUM_BODY_JOINTS]
            cost += self.anchor.body * float(np.sum(apart**2))
            cost += float(self.anchor.hands @ np.sum((state.hands - self.anchor.state.hands) ** 2, axis=1))
        return cost

    def prior_equations(self, state: HandState, pose_weight: float, shape_weight: float) -> tuple[Array, Array]:
        assert isinstance(state, BodyState)
        JtJ, Jtr = np.zeros((self.num_all, self.num_all)), np.zeros(self.num_all)
        body = slice(6, NUM_TURNED)
        theta = state.pose[1:NUM_BODY_JOINTS]
        _, prior_JtJ, prior_Jtr = self.prior.linearize(theta)
        JtJ[body, body], Jtr[body] = pose_weight * prior_JtJ, pose_weight * prior_Jtr
        size = self.space.size
        hands = [slice(NUM_TURNED + k * size, NUM_TURNED + (k + 1) * size) for k in range(2)]
        if self.mixture is not None:
            for own, coefficients in zip(hands, state.hands, strict=True):
                _, hand_JtJ, hand_Jtr = self.mixture.linearize(coefficients)
                JtJ[own, own], Jtr[own] = pose_weight * hand_JtJ, pose_weight * hand_Jtr
        if self.anchor is not None:
            turns = turn_jacobian(theta)
            apart = theta - self.anchor.state.pose[1:NUM_BODY_JOINTS]
            for k, turn in enumerate(turns):
                place = slice(6 + 3 * k, 9 + 3 * k)
                JtJ[place, place] += self.anchor.body * turn.T @ turn
                Jtr[place] += self.anchor.body * turn.T @ apart[k]
            for own, weight, change in zip(
                hands, self.anchor.hands, state.hands - self.anchor.state.hands, strict=True
            ):
                JtJ[own, own] += weight * np.eye(size)
                Jtr[own] += weight * change
        shapes = np.arange(NUM_TURNED + 2 * size, self.num_all)
        JtJ[shapes, shapes] = shape_weight
        Jtr[shapes] = shape_weight * state.shape
        if len(self.columns) == self.num_all:
            return JtJ, Jtr
        return JtJ[np.ix_(self.columns, self.columns)], Jtr[self.columns]


def joint_columns(joint: int) -> Ints:
    """(3,) parameters of a joint of the body; of the root its turn."""
    return np.arange(3) if joint == 0 else 3 + 3 * joint + np.arange(3)


def hand_columns(size: int, hand: int) -> Ints:
    """(C,) parameters of the left (0) or right (1) hand."""
    return NUM_TURNED + hand * size + np.arange(size)


def find_parts(model: BlendModel, bones: list[int] | Ints) -> tuple[Ints, Ints]:
    """Vertices (V',) that follow some bones most, and all others."""
    is_own = np.isin(model.skinning_weights.argmax(axis=1), bones)
    return np.flatnonzero(is_own), np.flatnonzero(~is_own)


def _faces_of(faces: Ints, ids: Ints, num_vertices: int) -> Ints:
    """(F', 3) the faces between vertices (V',), renumbered."""
    places = np.full(num_vertices, -1)
    places[ids] = np.arange(len(ids))
    own = places[faces]
    return own[(own >= 0).all(axis=1)]
