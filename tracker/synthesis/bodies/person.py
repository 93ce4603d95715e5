"""Generated people: a body of the population's statistics, with a surface of their own that no shape space holds."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
import numpy.typing as npt
from scipy import sparse

from tracker.geometry.vertex_normals import find_unit_normals
from tracker.model.blend_model import BlendModel
from tracker.model.body_hands import body_hand
from tracker.model.body_model import SEXES, body_model
from tracker.synthesis.scans.bones import dual_quaternions, skin

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

OWN_SURFACE = ((60, 2.0e-3), (8, 0.5e-3))
"""How often a person's own deviation is smoothed over the neighbours, and its standard deviation on the body, m."""
ON_HANDS = 0.25
"""Share of it on the hands."""


@dataclass(frozen=True, eq=False)
class Person:
    """A generated person.

    Attributes:
        number: Of the person; draws all that is chance.
        sex: "male" or "female".
        model: Whose joints, weights and pose blend shapes the person has.
        rest: (V, 3) unposed, without pose blend shapes, m.
    """

    number: int
    sex: str
    model: BlendModel
    rest: Array

    def posed(self, pose: Array, translation: Array) -> tuple[Array, Array]:
        """Vertices (V, 3) and joints (52, 3), m.

        Skin of the body follows its bones by dual quaternions, which no blend model does: elbows and hips keep their
        volume. That of the hands follows as in the trained hand, whose pose blend shapes belong to that.

        Args:
            pose: (52, 3) rotation vectors, the root's first, rad.
            translation: (3,) m.
        """
        posed = self.model.pose_at(pose, translation=translation, rest=self.rest)
        arrays = self.model.arrays
        rounded = np.empty_like(posed.vertices)
        motions = dual_quaternions(posed.Ts)
        skin(rounded, posed.rest, motions, arrays.weight_bones.astype(np.int64), arrays.weights)
        share = _share_of_hands(self.model)[:, None]
        return share * posed.vertices + (1.0 - share) * rounded, posed.joints


@cache
def make_person(number: int) -> Person:
    """The person of that number, always the same."""
    rng = np.random.default_rng([number, 17])
    sex = SEXES[int(rng.integers(2))]
    model = body_model(sex)
    shaped = model.shaped(rng.standard_normal(model.num_shape))
    means = _neighbour_means(model)
    scale = 1.0 - (1.0 - ON_HANDS) * _share_of_hands(model)
    own = np.zeros(len(shaped))
    for rounds, deviation in OWN_SURFACE:
        field = rng.standard_normal(len(shaped))
        for _ in range(rounds):
            field = means @ field
        own += deviation * field / field.std()
    return Person(number, sex, model, shaped + (scale * own)[:, None] * find_unit_normals(shaped, model.faces))


def hand_vertices(model: BlendModel) -> dict[str, Ints]:
    """Vertices of the "left" and the "right" hand, the wrist band left out."""
    return {side: body_hand(model, side).vertices for side in ("left", "right")}


@cache
def _share_of_hands(model: BlendModel) -> Array:
    """(V,) how much each vertex follows wrists and fingers."""
    sides = [body_hand(model, side) for side in ("left", "right")]
    bones = np.concatenate([[hand.wrist, *hand.fingers] for hand in sides])
    return model.skinning_weights[:, bones].sum(axis=1)


@cache
def _neighbour_means(model: BlendModel) -> sparse.csr_array:
    """(V, V) the mean of a vertex and its neighbours."""
    ends = model.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    size = len(model.template)
    graph = sparse.coo_array((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), (size, size)) + sparse.eye_array(size)
    return sparse.csr_array(sparse.diags_array(1.0 / graph.sum(axis=1)) @ graph)
