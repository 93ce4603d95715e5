"""Where a hand may be in a scan, without anybody's help."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import permutations, product

import numpy as np
import numpy.typing as npt
from scipy.spatial.transform import Rotation

from tracker.model.blend_model import BlendModel
from tracker.registration.hand_state import HandState
from tracker.registration.model_fit import Evaluation, FitSettings, ModelFit
from tracker.registration.scan_points import ScanPoints

Array = npt.NDArray[np.float64]

CURLS = ((8.0, 10.0, 5.0), (40.0, 45.0, 25.0), (78.0, 92.0, 50.0))
"""Degrees of flexion of the three joints of a finger: straight, half bent, a fist."""

RIGID = FitSettings(40.0, 3, to_scan=0.5, is_rigid=True, tolerance=1e-2)
RIGID_FINE = FitSettings(25.0, 3, to_scan=0.5, is_rigid=True, tolerance=1e-2)
COARSE = FitSettings(20.0, 8, to_scan=0.7, tolerance=3e-3)
MIDDLE = FitSettings(8.0, 6, to_scan=0.7, tolerance=3e-3)
FINE = FitSettings(10.0, 6, to_scan=0.7, tolerance=2e-3)
FINEST = FitSettings(4.0, 8, to_scan=0.7, tolerance=1e-3)
JUDGE = FitSettings(4.0, 0, to_scan=1.0, pose_weight=0.3, shape_weight=0.3)

RIGID_POINTS, COARSE_POINTS, FINE_POINTS = 250, 500, 1000
KEPT_RIGID, KEPT_COARSE = 10, 3


@dataclass(frozen=True)
class Start:
    """A state that may be right: its cost a vertex, mm², the side and all of its evaluation."""

    cost: float
    side: str
    evaluation: Evaluation


def find_starts(
    fit: ModelFit,
    scans: dict[str, ScanPoints],
    flexion_axes: Array,
    tell: Callable[[float], None] = lambda share: None,
) -> list[Start]:
    """States of the hand, best first.

    Args:
        fit: The right-handed model.
        scans: The points for each side to try, mirrored for "left".
        flexion_axes: (K, 3) of the joints behind the root.
        tell: Is told the share that is done.
    """
    found: list[Start] = []
    sides = tuple(scans)
    candidates = []
    for number, side in enumerate(sides):
        few = scans[side].first(RIGID_POINTS)
        for state in _list_candidates(fit.model, few, flexion_axes):
            first = fit.fit(state, few, RIGID)
            candidates.append((fit.fit(first.state, few, RIGID_FINE, first.matches.faces), side))
        tell(0.4 * (number + 1) / len(sides))
    candidates.sort(key=lambda candidate: candidate[0].data_cost)
    fitted = []
    for side in sides:
        few = scans[side].first(COARSE_POINTS)
        for candidate, of in [c for c in candidates if c[1] == side][:KEPT_RIGID]:
            first = fit.fit(candidate.state, few, COARSE)
            second = fit.fit(first.state, few, MIDDLE, first.matches.faces)
            fitted.append((second, of))
    tell(0.6)
    fitted.sort(key=lambda candidate: candidate[0].data_cost)
    for side in sides:
        some = scans[side].first(FINE_POINTS)
        for candidate, _ in [c for c in fitted if c[1] == side][:KEPT_COARSE]:
            found.append(refine(fit, some, candidate.state, side))
    tell(0.8)
    found.sort(key=lambda item: item.cost)
    best = found[0]
    found.append(bend_fingers(fit, scans[best.side].first(FINE_POINTS), best, flexion_axes))
    found.sort(key=lambda item: item.cost)
    tell(1.0)
    return found


def refine(fit: ModelFit, scan: ScanPoints, state: HandState, side: str) -> Start:
    """A state fitted closely, with its cost."""
    first = fit.fit(state, scan, FINE)
    second = fit.fit(first.state, scan, FINEST, first.matches.faces)
    judged = fit.evaluate(second.state, scan, JUDGE, second.matches.faces)
    return Start(judged.cost / len(fit.model.template), side, judged)


def bend_fingers(fit: ModelFit, scan: ScanPoints, best: Start, flexion_axes: Array) -> Start:
    """The best state after each finger was started anew, straight, half bent and folded."""
    chains = find_chains(fit.model)
    for chain in chains:
        for curl in CURLS:
            state = best.evaluation.state
            pose = state.pose.copy()
            for bone, degrees in zip(chain, curl, strict=False):
                pose[bone] = np.radians(degrees) * flexion_axes[bone - 1]
            if np.abs(pose - state.pose).max() < 0.2:
                continue
            tried = refine(fit, scan, HandState(pose, state.shape, state.translation), best.side)
            if tried.cost < best.cost - 1e-3:
                best = tried
    return best


def find_chains(model: BlendModel) -> list[list[int]]:
    """Bones of each finger, from the palm out."""
    chains = []
    for bone in np.flatnonzero(np.asarray(model.parents) == 0):
        chain = [int(bone)]
        while len(below := np.flatnonzero(np.asarray(model.parents) == chain[-1])):
            chain.append(int(below[0]))
        chains.append(chain)
    return chains


def _list_candidates(model: BlendModel, scan: ScanPoints, flexion_axes: Array) -> list[HandState]:
    """Three poses in all 24 ways to lay axes on axes, in the middle and pulled back from the forearm."""
    states = []
    middle = scan.points.mean(axis=0)
    axes = _find_axes(scan.points)
    rotations = _list_rotations()
    for curl in CURLS:
        pose = np.zeros((len(model.parents), 3))
        for chain in find_chains(model):
            for bone, degrees in zip(chain, curl, strict=False):
                share = 0.4 if chain[0] >= 13 else 1.0
                pose[bone] = np.radians(share * degrees) * flexion_axes[bone - 1]
        posed = model.pose_at(pose)
        own_axes = _find_axes(posed.vertices)
        own_middle = posed.vertices.mean(axis=0)
        root = posed.joints[0]
        for turn in rotations:
            R = axes @ turn @ own_axes.T
            turned = pose.copy()
            turned[0] = _log(R)
            placed = R @ (own_middle - root) + root
            states.append(HandState(turned, np.zeros(model.num_shape), middle - placed))
    return states


def _log(R: Array) -> Array:
    return Rotation.from_matrix(R).as_rotvec()


def _find_axes(points: Array) -> Array:
    """(3, 3) principal axes in columns, right-handed, the longest first."""
    offsets = points - points.mean(axis=0)
    _, vectors = np.linalg.eigh(offsets.T @ offsets)
    vectors = vectors[:, ::-1].copy()
    if np.linalg.det(vectors) < 0.0:
        vectors[:, 2] *= -1.0
    return vectors


def _list_rotations() -> list[Array]:
    """The 24 rotations that take axes to axes."""
    found = []
    for order in permutations(range(3)):
        for signs in product((1.0, -1.0), repeat=3):
            R = np.zeros((3, 3))
            R[np.arange(3), order] = signs
            if np.linalg.det(R) > 0.0:
                found.append(R)
    return found
