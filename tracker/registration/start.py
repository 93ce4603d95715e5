"""Where a hand may be in a scan, without a manual start."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import permutations, product

import numpy as np
import numpy.typing as npt
from scipy.spatial.transform import Rotation

from tracker.geometry.vertex_normals import find_unit_normals
from tracker.model.blend_limits import BlendLimits
from tracker.registration.hand_state import HandState
from tracker.registration.measures import JUDGE
from tracker.registration.model_fit import Evaluation, FitSettings, ModelFit
from tracker.registration.nearest_grid import NearestGrid, build_nearest_grid
from tracker.registration.rigid_search import Placing, StiffHand, place_stiffly
from tracker.registration.scan_points import ScanPoints
from tracker.registration.start_poses import CURLS, START_POSES, THUMBS, curl_finger, make_start_pose, turn_thumb

Array = npt.NDArray[np.float64]

FEW, SOME, MORE, MANY = 200, 500, 1000, 2500
"""Points that are fitted stiffly, coarsely, finely and at last."""

ROUNDS, RIVALS = 2, 3
"""How often single fingers are folded otherwise, and how many other starts are fitted beside the best. Both chosen, not
measured."""

ARRANGEMENTS, APART = 4, 0.015
"""So many are looked at thoroughly; in two of them some vertices lie farther apart than this, m."""

KEPT_STIFF, KEPT_COARSE = 10, 3
"""Candidates that go on."""

COARSE = (FitSettings(20.0, 6, 0.7, tolerance=5e-3, back=250), FitSettings(8.0, 6, 0.7, tolerance=5e-3, back=250))
FINE = (FitSettings(10.0, 6, 0.7, tolerance=3e-3, back=250), FitSettings(4.0, 8, 0.7, tolerance=2e-3, back=250))
LAST = (FitSettings(6.0, 8, 0.5, tolerance=1e-3, back=400),)


@dataclass(frozen=True)
class Start:
    """A state that may be right: its cost a vertex, mm², the side, and all of its evaluation."""

    cost: float
    side: str
    evaluation: Evaluation


class StartSearch:
    """Looks for a hand; what depends on the model alone is computed once.

    Args:
        fit: The right-handed model.
        limits: Its joints.
    """

    def __init__(self, fit: ModelFit, limits: BlendLimits) -> None:
        self.fit, self.limits = fit, limits
        self.poses = [make_start_pose(limits, number) for number in range(len(START_POSES))]
        self.stiff: list[StiffHand] = []
        self.roots: list[Array] = []
        for pose in self.poses:
            posed = fit.model.pose_at(pose)
            grid = build_nearest_grid(posed.vertices.copy(), find_unit_normals(posed.vertices, fit.search.faces))
            self.stiff.append(StiffHand(grid, fit.search.is_rim_vertex, fit.inner[:FEW]))
            self.roots.append(posed.joints[0].copy())
        template = fit.model.template
        growth = (template - self.roots[0]).ravel()
        directions = fit.model.shape_directions.reshape(-1, fit.model.num_shape)
        self.growth = np.linalg.solve(
            directions.T @ directions + 1e-4 * len(template) * np.eye(fit.model.num_shape) * 1e-2, directions.T @ growth
        )
        """(S,) shape by which the hand grows by its own size."""

    def find(
        self,
        scans: dict[str, ScanPoints],
        tell: Callable[[float], None] = lambda share: None,
        is_thorough: bool = False,
    ) -> list[Start]:
        """States of the hand, best first.

        Args:
            scans: The points for each side to try, mirrored for "left".
            tell: Is told the share that is done.
            is_thorough: Fingers are started anew in every arrangement that may be right, not in the best alone: the
                right one may come late, with a finger astray. Takes three times as long.
        """
        fitted: list[Start] = []
        grid: NearestGrid | None = None
        for number, (side, scan) in enumerate(scans.items()):
            if grid is None:
                grid = build_nearest_grid(scan.surface.points, scan.surface.normals)
            else:
                grid = grid.mirrored()
            for state in self._place(scan, grid):
                fitted.append(self._fit(state, scan.first(SOME), side, COARSE))
            tell(0.5 * (number + 1) / len(scans))
        found = []
        for side, scan in scans.items():
            best = sorted((start for start in fitted if start.side == side), key=lambda start: start.cost)
            for start in best[:KEPT_COARSE]:
                found.append(self._fit(start.evaluation.state, scan.first(MORE), side, FINE))
        tell(0.7)
        found.sort(key=lambda start: start.cost)
        tried = find_apart(found)[:ARRANGEMENTS] if is_thorough else found[:1]
        best = [self._try_fingers(scans[one.side].first(MORE), one) for one in tried]
        # the first looks were short and at few points: the best of them are looked at again, longer
        last = [self._fit(s.evaluation.state, scans[s.side].first(MANY), s.side, LAST) for s in best + found[:RIVALS]]
        last.sort(key=lambda start: start.cost)
        tell(1.0)
        return last

    def _place(self, scan: ScanPoints, grid: NearestGrid) -> list[HandState]:
        """The best stiff hands, no two nearly alike."""
        few = scan.first(FEW)
        middle = scan.points.mean(axis=0)
        axes = _find_axes(scan.points)
        placed: list[tuple[Placing, int]] = []
        for number, stiff in enumerate(self.stiff):
            vertices = stiff.grid.points
            own_middle, own_axes = vertices.mean(axis=0), _find_axes(vertices)
            Rs = np.stack([axes @ turn @ own_axes.T for turn in ROTATIONS])
            ts = middle - Rs @ own_middle
            # with a forearm, the hand's middle lies from the points' middle towards the fingers
            forward = Rs @ np.array([1.0, 0.0, 0.0])
            Rs, ts = np.concatenate([Rs, Rs]), np.concatenate([ts, ts + 0.025 * forward])
            placed += [(placing, number) for placing in place_stiffly(stiff, grid, few.points, few.normals, Rs, ts)]
        placed.sort(key=lambda item: item[0].cost)
        chosen: list[tuple[Placing, int]] = []
        for placing, number in placed:
            if all(_differ(placing, other) or number != of for other, of in chosen):
                chosen.append((placing, number))
                if len(chosen) == KEPT_STIFF:
                    break
        return [self._to_state(placing, number) for placing, number in chosen]

    def _to_state(self, placing: Placing, number: int) -> HandState:
        pose = self.poses[number].copy()
        pose[0] = Rotation.from_matrix(placing.R).as_rotvec()
        root = self.roots[number]
        shape: Array = np.clip((placing.size - 1.0) * self.growth, -2.0, 2.0).astype(np.float64)
        return HandState(pose, shape, placing.size * placing.R @ root + placing.t - root)

    def _fit(self, state: HandState, scan: ScanPoints, side: str, stages: tuple[FitSettings, ...]) -> Start:
        seeds = None
        for settings in stages:
            evaluation = self.fit.fit(state, scan, settings, seeds)
            state, seeds = evaluation.state, evaluation.matches.faces
        judged = self.fit.evaluate(state, scan, JUDGE, seeds)
        return Start(judged.cost / len(self.fit.model.template), side, judged)

    def _try_fingers(self, scan: ScanPoints, best: Start) -> Start:
        """The best state after each finger was restarted in several curls, and the thumb in several turns.

        As long as that helps, up to ROUNDS times: with one finger in its place, another may find its own.
        """
        for _ in range(ROUNDS):
            before = best
            for finger in ("little", "ring", "middle", "index", "thumb"):
                state = best.evaluation.state
                if finger == "thumb":
                    poses = [turn_thumb(self.limits, state.pose, turn) for turn in THUMBS]
                else:
                    poses = [curl_finger(self.limits, state.pose, finger, curl) for curl in CURLS]
                for pose in poses:
                    if np.abs(pose - state.pose).max() < 0.25:
                        continue
                    tried = self._fit(HandState(pose, state.shape, state.translation), scan, best.side, FINE)
                    if tried.cost < best.cost - 1e-3:
                        best = tried
            if best.cost > 0.97 * before.cost:
                break
        return best


def find_apart(starts: list[Start]) -> list[Start]:
    """Those that are another arrangement than all before them."""
    kept: list[Start] = []
    for start in starts:
        vertices = start.evaluation.posed.vertices
        rivals = [other.evaluation.posed.vertices for other in kept if other.side == start.side]
        if all(np.linalg.norm(vertices - other, axis=1).max() > APART for other in rivals):
            kept.append(start)
    return kept


def _differ(one: Placing, other: Placing) -> bool:
    cosine = 0.5 * (float(np.einsum("ij,ij->", one.R, other.R)) - 1.0)
    return cosine < np.cos(0.3) or float(np.linalg.norm(one.t - other.t)) > 0.02


def _find_axes(points: Array) -> Array:
    """(3, 3) principal axes in columns, right-handed, the longest first."""
    offsets = points - points.mean(axis=0)
    _, vectors = np.linalg.eigh(offsets.T @ offsets)
    vectors = vectors[:, ::-1].copy()
    if np.linalg.det(vectors) < 0.0:
        vectors[:, 2] *= -1.0
    return vectors


def _list_rotations() -> list[Array]:
    """The 24 rotations that take axes to axes, and those turned by 45 degrees about a diagonal."""
    found = []
    half = Rotation.from_rotvec(np.radians(45.0) / np.sqrt(3.0) * np.ones(3)).as_matrix()
    for order in permutations(range(3)):
        for signs in product((1.0, -1.0), repeat=3):
            R = np.zeros((3, 3))
            R[np.arange(3), order] = signs
            if np.linalg.det(R) > 0.0:
                found += [R, R @ half]
    return found


ROTATIONS = _list_rotations()
