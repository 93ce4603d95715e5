"""The people whom the body's shape space is made from: MakeHuman's adults, measured and sized as people are."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from body_bones import BodyRig
from body_surface import R_BODY_HAND, BodySurface
from makehuman_wheel import MACRO_AXES, MacroTargets

from tracker.model.blend_model import BlendModel
from tracker.model.mano_files import BODY_JOINTS

Array = npt.NDArray[np.float64]

DENSITY = 985.0
"""Of a body, kg/m^3."""
WEIGHT_STEPS = (-1.0, 0.0, 1.0, 1.6, 2.2)
"""Of MakeHuman's weight; its heaviest adult weighs less than a mean soldier, so the axis is followed beyond it."""


@dataclass(frozen=True)
class Measurements:
    """What ANSUR II (US Army, 2012; public domain) measured of one sex, in this order: stature (m), weight (kg), hand
    length (m, wrist to the tip of the middle finger), hand breadth (m, across the knuckles of the four fingers).

    Attributes:
        mean: (4,).
        deviation: (4,).
        correlation: (4, 4).
    """

    mean: Array
    deviation: Array
    correlation: Array

    def draw(self, rng: np.random.Generator, count: int) -> Array:
        """(count, 4) people of a Gaussian with these moments, none farther out than 3 deviations in a measurement."""
        factor = np.linalg.cholesky(self.correlation)
        drawn = rng.standard_normal((3 * count, 4)) @ factor.T
        drawn = drawn[np.abs(drawn).max(axis=1) < 3.0][:count]
        return self.mean + self.deviation * drawn


ANSUR = {
    "male": Measurements(  # 4,082 men
        np.array([1.75621, 85.52396, 0.19328, 0.08826]),
        np.array([0.06855, 14.22070, 0.00995, 0.00439]),
        np.array(
            [
                [1.0, 0.4689, 0.6732, 0.4663],
                [0.4689, 1.0, 0.4235, 0.5371],
                [0.6732, 0.4235, 1.0, 0.5817],
                [0.4663, 0.5371, 0.5817, 1.0],
            ]
        ),
    ),
    "female": Measurements(  # 1,986 women
        np.array([1.62847, 67.75821, 0.18108, 0.07815]),
        np.array([0.06420, 10.98465, 0.01006, 0.00384]),
        np.array(
            [
                [1.0, 0.5335, 0.6462, 0.4725],
                [0.5335, 1.0, 0.4859, 0.4924],
                [0.6462, 0.4859, 1.0, 0.5697],
                [0.4725, 0.4924, 0.5697, 1.0],
            ]
        ),
    ),
}


@dataclass(frozen=True)
class HandSize:
    """Length and breadth of the trained hand, m, measured as ANSUR II measures a flat hand."""

    length: float
    breadth: float

    @classmethod
    def measure(cls, hand: BlendModel) -> HandSize:
        joints = hand.joints_of(hand.template)
        knuckles = [hand.joint_names.index(f"{finger}1") for finger in ("index", "little")]
        palm = hand.skinning_weights[:, [0, *knuckles]].sum(axis=1) > 0.5
        near = np.abs(hand.template[:, 0] - joints[knuckles, 0].mean()) < 0.012
        across = hand.template[palm & near, 1]
        return cls(hand_length(joints, hand.template[hand.tips[2]], hand.joint_names), float(np.ptp(across)))

    def matrix(self, length: float, breadth: float) -> Array:
        """(3, 3) diagonal in the frame of the hand: as long and as broad as that, as thick as it is broad."""
        return np.diag([length / self.length, breadth / self.breadth, breadth / self.breadth])


def hand_length(joints: Array, tip: Array, names: tuple[str, ...], prefix: str = "") -> float:
    """From the wrist to the tip (3,) of the middle finger along the bones, as if the finger were straight, m."""
    wanted = ("wrist", "middle1", "middle2", "middle3")
    chain = np.stack([*(joints[names.index(prefix + name)] for name in wanted), tip])
    return float(np.linalg.norm(np.diff(chain, axis=0), axis=1).sum())


class PeopleMaker:
    """Makes people of given measurements.

    Args:
        rig: MakeHuman's body.
        macros: Its targets, of all vertices.
        hand: The trained right hand.
    """

    def __init__(self, rig: BodyRig, macros: MacroTargets, hand: BlendModel) -> None:
        self.rig, self.macros, self.hand = rig, macros, hand
        self.size = HandSize.measure(hand)
        polygons = rig.wheel.mesh[1]["body"]
        self.triangles = np.array([(p[0], p[k], p[k + 1]) for p in polygons for k in range(1, len(p) - 1)])
        self.used = np.unique(self.triangles)

    def make(self, sex: str, measured: Array, rng: np.random.Generator) -> tuple[Array, Array, Array]:
        """Of somebody of this stature (m), weight (kg), hand length and breadth (m).

        Returns:
            body: (V, 3) MakeHuman's vertices in the T-pose, the pelvis at the origin, m.
            joints: (22, 3).
            hand: (782, 3) right hand in its place.
        """
        stature, weight, length, breadth = measured
        shares = self._chance(sex, rng)
        self._settle(shares, "height", (-1.0, 0.0, 1.0), stature, self._stature)
        scale = stature / self._stature(self._body(shares))
        self._settle(shares, "weight", WEIGHT_STEPS, weight / DENSITY / scale**3, self._volume)
        body = self._body(shares)
        body = body * (stature / self._stature(body))
        straight, joints = self.rig.straighten(body)
        wrist = joints[BODY_JOINTS.index("right_wrist")]
        placed = self.hand.template @ (R_BODY_HAND @ self.size.matrix(length, breadth)).T + wrist
        return straight, joints, placed

    def _chance(self, sex: str, rng: np.random.Generator) -> dict[str, dict[str, float]]:
        """Origin, age and muscles by chance, height and weight in the middle."""
        other = "female" if sex == "male" else "male"
        old = float(rng.uniform(0.0, 0.6))
        muscle = float(np.clip(rng.normal(0.0, 0.25), -0.6, 0.5))
        return {
            "race": dict(zip(MACRO_AXES["race"], rng.dirichlet([0.8, 0.8, 0.8]).tolist(), strict=True)),
            "gender": {sex: 1.0, other: 0.0},
            "age": {"young": 1.0 - old, "old": old},
            "muscle": _between("muscle", muscle),
            "weight": _between("weight", 0.0),
            "height": _between("height", 0.0),
        }

    def _settle(
        self,
        shares: dict[str, dict[str, float]],
        axis: str,
        amounts: tuple[float, ...],
        wanted: float,
        measure: Callable[[Array], float],
    ) -> None:
        """Set the share of one axis so that the body measures what is wanted, as far as the amounts reach."""
        seen = []
        for amount in amounts:
            shares[axis] = _between(axis, amount)
            seen.append(measure(self._body(shares)))
        shares[axis] = _between(axis, float(np.interp(wanted, seen, amounts)))

    def _body(self, shares: dict[str, dict[str, float]]) -> Array:
        return self.rig.wheel.vertices + self.macros.blend(shares)

    def _stature(self, body: Array) -> float:
        return float(np.ptp(body[self.used, 1]))

    def _volume(self, body: Array) -> float:
        a, b, c = (body[self.triangles[:, k]] for k in range(3))
        return float(np.einsum("fx,fx->", a, np.cross(b, c)) / 6.0)


def place_people(
    maker: PeopleMaker, surface: BodySurface, sex: str, count: int, rng: np.random.Generator
) -> tuple[Array, Array]:
    """Right sides (count, N, 3) and body joints (count, 22, 3) of people of one sex, m."""
    rights, joints = [], []
    for measured in ANSUR[sex].draw(rng, count):
        straight, placed, hand = maker.make(sex, measured, rng)
        rights.append(surface.right(straight, hand))
        joints.append(placed)
    return np.array(rights), np.array(joints)


def _between(axis: str, value: float) -> dict[str, float]:
    """Shares of an axis for -1 (least), 0 (average), 1 (most) and what lies between; beyond 1 on the same line."""
    low, mean, high = MACRO_AXES[axis]
    return {low: max(-value, 0.0), mean: 1.0 - abs(value), high: max(value, 0.0)}
