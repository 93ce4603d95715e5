"""Where a body is, roughly: rigid bodies in a few poses are placed on the scan from all sides, the best are fitted."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.spatial import KDTree
from scipy.spatial.transform import Rotation

from tracker.bodies.body_fit import BodyFit
from tracker.bodies.body_state import BodyState, make_state
from tracker.bodies.limb_search import LimbSearch
from tracker.geometry.se3 import find_rotations
from tracker.model.body_hands import NUM_BODY_JOINTS
from tracker.model.mano_files import BODY_JOINTS
from tracker.registration.hand_state import HandState
from tracker.registration.model_fit import Evaluation, FitSettings
from tracker.registration.scan_points import ScanPoints

Array = npt.NDArray[np.float64]

SCAN_POINTS, MODEL_POINTS = 400, 600
"""So many stand for scan and model while bodies are stiff."""
YAWS = 8
"""Directions to face, for each way up."""
ICP_ROUNDS = 6
"""Of each stiff body on the scan. Chosen, not measured."""
FAR = 0.25
"""Distances beyond this count as this, m."""
FOLLOWED, FINISHED, SEARCHED = 8, 3, 2
"""How many rigid bodies are fitted, how many of these more closely, and of how many arms and legs are restarted."""
NEAR, SETTLED = 0.025, 0.02
"""No limb is restarted where less than this share of every limb's points, and of the others, is this far from the body,
m, and of the body twice as far from the scan."""
LIMB_POINTS = 3000
"""Of the whole scan, when limbs are restarted."""
APART = np.radians(50.0)
"""Stiff bodies that are turned less against one another are followed only once."""

COARSE = FitSettings(120.0, 10, to_scan=0.5, pose_weight=60.0, shape_weight=150.0, tolerance=5e-3)
CLOSER = (
    FitSettings(60.0, 8, to_scan=0.5, pose_weight=20.0, shape_weight=60.0, tolerance=2e-3),
    FitSettings(30.0, 10, to_scan=0.3, pose_weight=6.0, shape_weight=30.0, tolerance=1e-3),
)
"""[R17] 4.3.1: priors are strong at first, then data."""
COARSE_POINTS, CLOSER_POINTS = 500, 1200
"""Of the scan, in these two stages. Chosen, not measured."""


@dataclass(frozen=True)
class Stiff:
    """A stiff body on the scan: which pose, and R, t from the body to the scan; cost is a mean squared distance, m²."""

    pose: int
    R: Array
    t: Array
    cost: float


def start_poses() -> list[Array]:
    """(22, 3) each, rad: how people stand when they are scanned, and arms and legs elsewhere."""
    arms = {  # lowered, forward, bent: degrees of the left side, and of the right
        "A": ((50, 0, 15), (50, 0, 15)),
        "T": ((0, 0, 0), (0, 0, 0)),
        "down": ((72, 0, 10), (72, 0, 10)),
        "ahead": ((15, 70, 20), (15, 70, 20)),
        "bent": ((45, 20, 95), (45, 20, 95)),
        "up": ((-45, 10, 20), (-45, 10, 20)),
        "left bent": ((45, 20, 95), (50, 0, 15)),
        "right bent": ((50, 0, 15), (45, 20, 95)),
        "left ahead": ((10, 65, 30), (50, 0, 15)),
        "right ahead": ((50, 0, 15), (10, 65, 30)),
    }
    poses = []
    for sides in arms.values():
        pose = np.zeros((NUM_BODY_JOINTS, 3))
        for name, sign, (lowered, forward, bent) in zip(("left", "right"), (-1.0, 1.0), sides, strict=True):
            turn = Rotation.from_euler("xyz", np.radians([0.0, sign * forward, sign * lowered]))
            pose[BODY_JOINTS.index(f"{name}_shoulder")] = turn.as_rotvec()
            pose[BODY_JOINTS.index(f"{name}_elbow")] = [0.0, sign * np.radians(bent), 0.0]
            pose[BODY_JOINTS.index(f"{name}_hip")] = [0.0, 0.0, -sign * np.radians(7.0)]
        poses.append(pose)
    return poses


class BodyStart:
    """Finds starts of one model; what does not depend on the scan is worked out once.

    Args:
        fit: Of the whole body.
    """

    def __init__(self, fit: BodyFit) -> None:
        self.fit = fit
        self.limbs = LimbSearch(fit.model, fit.prior, fit.mixture, fit.space.size)
        self.states = [make_state(fit.model, fit.space, pose) for pose in start_poses()]
        self.clouds = []
        for state in self.states:
            vertices = fit.pose(state).vertices[fit.inner[:MODEL_POINTS]]
            self.clouds.append(
                (vertices - vertices.mean(axis=0), vertices.mean(axis=0), KDTree(vertices - vertices.mean(axis=0)))
            )

    def find(self, scan: ScanPoints) -> list[Evaluation]:
        """States near the scan, the best first."""
        followed = self.follow(self.find_stiff(scan))
        coarse = [self.fit.fit(state, scan.first(COARSE_POINTS), COARSE) for state in followed]
        coarse.sort(key=lambda each: each.cost)
        found = [self._finish(each.state, scan) for each in coarse[:FINISHED]]
        found.sort(key=lambda each: each.cost)
        if self.is_settled(found[0], scan):
            return found
        again = []
        for each in found[:SEARCHED]:
            assert isinstance(each.state, BodyState)
            state, changed = self.limbs.improve(each.state, scan.first(LIMB_POINTS))
            again.append(self._finish(state, scan) if changed else each)
        return sorted(again + found[SEARCHED:], key=lambda each: each.cost)

    def is_settled(self, found: Evaluation, scan: ScanPoints) -> bool:
        """Whether body and scan lie on one another so well that no limb can be elsewhere.

        Each limb is asked by itself: a foot that is folded back leaves 1 % of all points alone, and 5 % of its leg's.
        """
        points = scan.points[:LIMB_POINTS]
        vertices = found.posed.vertices
        matches = self.fit.search.match(vertices, points, np.zeros_like(points), reach=1.0)
        limbs = self.limbs.numbers[self.fit.search.faces[matches.faces, 0]]
        far = np.bincount(limbs, np.abs(matches.offsets) > NEAR) / np.maximum(np.bincount(limbs), 1)
        alone = KDTree(points).query(vertices[self.fit.inner[:MODEL_POINTS]])[0]
        return bool(max(far.max(), np.mean(alone > 2.0 * NEAR)) < SETTLED)

    def _finish(self, state: HandState, scan: ScanPoints) -> Evaluation:
        """The state fitted more closely, in two stages."""
        evaluation: Evaluation | None = None
        for settings in CLOSER:
            evaluation = self.fit.fit(state, scan.first(CLOSER_POINTS), settings)
            state = evaluation.state
        assert evaluation is not None
        return evaluation

    def follow(self, stiff: list[Stiff]) -> list[BodyState]:
        """The best stiff bodies that differ in where they look or in their pose, as states."""
        chosen: list[Stiff] = []
        for each in stiff:
            is_new = all(
                each.pose != other.pose or Rotation.from_matrix(each.R @ other.R.T).magnitude() > APART
                for other in chosen
            )
            same_side = sum(Rotation.from_matrix(each.R @ other.R.T).magnitude() < APART for other in chosen)
            if is_new and same_side < 3:
                chosen.append(each)
            if len(chosen) == FOLLOWED:
                break
        return [self._place(each) for each in chosen]

    def _place(self, stiff: Stiff) -> BodyState:
        return self.states[stiff.pose].moved(self.fit.model, stiff.R, stiff.t - stiff.R @ self.clouds[stiff.pose][1])

    def find_stiff(self, scan: ScanPoints) -> list[Stiff]:
        """Stiff bodies on the scan, the best first."""
        points = scan.points[:SCAN_POINTS]
        middle = points.mean(axis=0)
        centred = points - middle
        tree = KDTree(scan.points[: 4 * SCAN_POINTS] - middle)
        found = []
        for number in range(len(self.states)):
            for R in _turns(centred):
                found.append(self._lay(number, R, np.zeros(3), centred, tree, 1))
        found.sort(key=lambda each: each.cost)
        closer = [self._lay(each.pose, each.R, each.t, centred, tree, ICP_ROUNDS) for each in found[: len(found) // 4]]
        closer.sort(key=lambda each: each.cost)
        return [Stiff(each.pose, each.R, each.t + middle, each.cost) for each in closer]

    def _lay(self, number: int, R: Array, t: Array, points: Array, tree: KDTree, rounds: int) -> Stiff:
        """A stiff body after some rounds of closest points, both ways."""
        cloud, _, own = self.clouds[number]
        cost = np.inf
        for round in range(rounds):
            local = (points - t) @ R
            distances, ids = own.query(local)
            moved = cloud[::2] @ R.T + t
            back, back_ids = tree.query(moved)
            cost = float(np.minimum(distances, FAR) @ np.minimum(distances, FAR)) / len(points)
            cost += float(np.minimum(back, FAR) @ np.minimum(back, FAR)) / len(moved)
            if round == rounds - 1:
                break
            source = np.concatenate([cloud[ids], cloud[::2]])
            target = np.concatenate([points, tree.data[back_ids]])
            weights = 1.0 / (1.0 + (np.concatenate([distances, back]) / 0.1) ** 2)
            R, t = _kabsch(source, target, weights)
        return Stiff(number, R, t, cost)


def _turns(centred: Array) -> list[Array]:
    """(3, 3) each: bodies upright along the scan's longest two axes, either way up, looking all around."""
    axes = np.linalg.eigh(centred.T @ centred)[1][:, ::-1].T
    turns = []
    for up in (axes[0], -axes[0], axes[1], -axes[1]):
        side = np.cross(up, axes[2])
        side /= np.linalg.norm(side)
        ahead = np.cross(side, up)
        for yaw in 2.0 * np.pi * np.arange(YAWS) / YAWS:
            x = np.cos(yaw) * side - np.sin(yaw) * ahead
            turns.append(np.stack([x, up, np.cross(x, up)], axis=1))
    return turns


def _kabsch(source: Array, target: Array, weights: Array) -> tuple[Array, Array]:
    """R, t that lay source (N, 3) onto target (N, 3)."""
    share = weights / weights.sum()
    mine, theirs = share @ source, share @ target
    R = find_rotations(((target - theirs) * share[:, None]).T @ (source - mine))
    return R, theirs - R @ mine
