"""The verdict on a registration, reached without the truth."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.capture.scan import Scan
from tracker.model.blend_model import BlendModel
from tracker.registration.free_fit import FreeSurface
from tracker.registration.hand_state import HandState
from tracker.registration.model_fit import MM, Evaluation, FitSettings, ModelFit
from tracker.registration.registration import Registration, digest_scan
from tracker.registration.scan_points import ScanPoints
from tracker.registration.surface_search import Matches

Array = npt.NDArray[np.float64]

JUDGE = FitSettings(4.0, 0, to_scan=1.0, pose_weight=0.3, shape_weight=3.0)
JUDGE_POINTS = 4000

LIMITS = {
    "stretch": 1.05,
    "scan_to_surface": 0.07,
    "scan_to_model": 1.4,
    "model_to_scan": 4.2,
    "moved": 2.8,
    "shape": 1.8,
}
"""A registration is good when every measure is below its limit, see docs/scans.md."""

BAD = 1.6
"""A registration is bad when a measure is this many times its limit."""

LEAST_COVERED = 0.35

NEARLY = 0.99
"""Score of a hand that is good but for its person: queues have it first among the good ones."""

STRANGE = ("stretch", "scan_to_model")
"""Beyond their limits when the pose is wrong, and when the person is unlike all whom the model knows."""
STRANGE_MOST = 1.35
"""So many times its limit either may then be..."""
OTHERS_MOST = 0.9
"""...while every other measure stays below this share of its own,"""
HIDDEN_MOST = 0.05
"""...no more of the surface than this has no scan beside it, so that no finger can be elsewhere,"""
TURNED_MOST = 0.7
"""...and the model lies at this share of the cost, at most, at which a hand of the other side does."""
OVER = (FitSettings(10.0, 8, to_scan=0.3), FitSettings(5.0, 8, to_scan=0.1))
OVER_POINTS = 3000

TOLD = {
    "stretch": "the surface is stretched against the model (edges differ by {:.2f} mm)",
    "scan_to_surface": "parts of the scan lie away from the surface ({:.2f} mm, root mean square)",
    "scan_to_model": "parts of the scan lie away from the model ({:.1f} mm, root mean square)",
    "model_to_scan": "parts of the model have no scan beside them ({:.0%} of its vertices)",
    "moved": "the surface left the model ({:.1f} mm)",
    "shape": "the shape is unlike a hand's ({:.1f} standard deviations)",
    "covered": "only {:.0%} of the points lie beside the hand",
    "person": "a hand unlike the people whom this model knows, else nothing speaks against it",
}


@dataclass(frozen=True)
class Verdict:
    """A judgement: name, score (0 to 1), reasons, and the measures it rests on."""

    name: str
    score: float
    reasons: tuple[str, ...]
    measures: dict[str, float]


def judge(
    fit: ModelFit, scan: ScanPoints, evaluation: Evaluation, surface: FreeSurface, distances: Array, count: int
) -> Verdict:
    """Judge a registration by how well the model, not only the free surface, explains the scan, and the scan the model.

    Free vertices come close to any scan, so distances to them prove nothing.

    Args:
        fit: The model.
        scan: The points, right hand.
        evaluation: The model's fit before the surface was freed.
        surface: The free surface.
        distances: (N,) of the scan to it, m; NaN where not counted.
        count: Points that may be a hand's.
    """
    measures = measure(fit, scan, evaluation, surface, distances, count)
    shares = {name: measures[name] / limit for name, limit in LIMITS.items()}
    if measures["covered"] < LEAST_COVERED:
        shares["covered"] = 2.0 * LEAST_COVERED / max(measures["covered"], 1e-3)
    worst = max(shares.values())
    if worst >= 1.0 and _is_sure_else(shares, measures) and _turned_over(fit, scan, evaluation) < TURNED_MOST:
        worst = NEARLY
        return Verdict("good", worst / (1.0 + worst), (TOLD["person"],), measures)
    score = float(worst / (1.0 + worst))
    name = "good" if worst < 1.0 else "doubtful" if worst < BAD else "bad"
    faults = sorted((name for name in shares if shares[name] >= 1.0), key=lambda name: -shares[name])
    return Verdict(name, score, tuple(tell(fault, measures) for fault in faults), measures)


def tell(fault: str, measures: dict[str, float]) -> str:
    """A reason with its figure as people read it: squares as lengths, what is not seen as a share."""
    value = measures["hidden"] if fault == "model_to_scan" else measures[fault]
    return TOLD[fault].format(np.sqrt(value) if fault.startswith("scan_to") else value)


def _is_sure_else(shares: dict[str, float], measures: dict[str, float]) -> bool:
    """Whether only the person may be strange."""
    strange = [share for name, share in shares.items() if name in STRANGE]
    others = [share for name, share in shares.items() if name not in STRANGE]
    return max(strange) <= STRANGE_MOST and max(others) <= OTHERS_MOST and measures["hidden_free"] <= HIDDEN_MOST


def _turned_over(fit: ModelFit, scan: ScanPoints, evaluation: Evaluation) -> float:
    """Cost of the model against that of a hand of the other side, its palm where the back of this one is.

    A flat hand is much like a hand of the other side turned over: thumb and fingers lie where they should, and only
    palm and back are unlike. Registered so it has the measures of a strange person, but the right side fits far better.
    """
    state, other = evaluation.state, turn_over(fit.model, evaluation.state)
    mirrored = scan.mirrored()
    for settings in OVER:
        other = fit.fit(other, mirrored.first(OVER_POINTS), settings).state
    return _cost(fit, scan, state) / max(_cost(fit, mirrored, other), 1e-9)


def turn_over(model: BlendModel, state: HandState) -> HandState:
    """A hand of the other side where this one is, palm where the back was; in the mirror x = 0, as left hands are."""
    posed = state.posed(model)
    joints = posed.joints
    palm = np.cross(joints[4] - joints[0], joints[1] - joints[7])  # knuckles of middle, index and little finger
    palm /= np.linalg.norm(palm)
    mirror = np.diag([-1.0, 1.0, 1.0])
    turn = mirror @ (np.eye(3) - 2.0 * np.outer(palm, palm))
    center = posed.vertices.mean(axis=0)
    return state.moved(model, turn, (mirror - turn) @ center)


def _cost(fit: ModelFit, scan: ScanPoints, state: HandState) -> float:
    """Of points beside the model and vertices beside the scan, mm²."""
    points = scan.first(JUDGE_POINTS)
    judged = fit.evaluate(state, points, JUDGE)
    vertices = judged.posed.vertices
    beside = ~fit.search.match(vertices, points.points, np.zeros_like(points.normals), 1.0).on_rim
    return _robust_mean(judged.matches, beside) + _look_back(fit, scan, vertices)[1]


def measure(
    fit: ModelFit, scan: ScanPoints, evaluation: Evaluation, surface: FreeSurface, distances: Array, count: int
) -> dict[str, float]:
    """What tells right from wrong, see docs/scans.md.

    Returns:
        scan_to_model: Mean Geman-McClure cost (4 mm) of a scan point beside the model, mm².
        model_to_scan: The same of a vertex of the model that looks for the scan.
        hidden: Share of the vertices without scan within 4 mm that looks the same way.
        hidden_free: The same of the free surface.
        scan_to_surface: As the first, for the free surface.
        covered: Share of the points that lie beside the free surface and not behind its rim.
        moved: Mean distance between model and free surface after the best rigid motion, mm.
        stretch: Root mean square difference of edges, mm.
        pose: Cost of the pose prior a joint angle.
        shape: Root mean square of the shape coefficients.
    """
    points = scan.first(JUDGE_POINTS)
    judged = fit.evaluate(evaluation.state, points, JUDGE)
    free_matches = fit.search.match(surface.vertices, points.points, points.normals, 0.016)
    beside = ~fit.search.match(surface.vertices, points.points, np.zeros_like(points.normals), 1.0).on_rim
    hidden, back = _look_back(fit, scan, judged.posed.vertices)
    hidden_free, _ = _look_back(fit, scan, surface.vertices)
    edges = fit.search.faces[:, [0, 1]]
    own = surface.vertices[edges[:, 0]] - surface.vertices[edges[:, 1]]
    model = surface.model_vertices[edges[:, 0]] - surface.model_vertices[edges[:, 1]]
    apart = surface.vertices - judged.posed.vertices
    return {
        "scan_to_model": _robust_mean(judged.matches, beside),
        "model_to_scan": back,
        "hidden": hidden,
        "hidden_free": hidden_free,
        "scan_to_surface": _robust_mean(free_matches, beside),
        "covered": float(np.isfinite(distances).sum()) / max(count, 1),
        "moved": float(np.linalg.norm(apart - apart.mean(axis=0), axis=1).mean() * MM),
        "stretch": float(np.sqrt(((own - model) ** 2).sum(axis=1).mean()) * MM),
        "pose": fit.prior.cost(evaluation.state.pose[1:]) / max(len(fit.prior.mean), 1),
        "shape": float(np.sqrt((evaluation.state.shape**2).mean())) if fit.model.num_shape else 0.0,
    }


def _robust_mean(matches: Matches, beside: npt.NDArray[np.bool_]) -> float:
    square = 16.0
    r2 = np.where(matches.faces >= 0, matches.offsets * MM, 1e3) ** 2
    counted = beside & ~matches.on_rim
    return float((r2 * square / (r2 + square))[counted].mean()) if counted.any() else square


def _look_back(fit: ModelFit, scan: ScanPoints, vertices: Array) -> tuple[float, float]:
    """Share of vertices that see no scan, and their mean robust cost, mm²."""
    back = fit.look_back(vertices, scan, 0.016)
    r2 = np.where(back.is_used, (MM * back.along) ** 2, 1e6)
    is_seen = back.is_used & (back.distances < 4e-3)
    return float(1.0 - is_seen.mean()), float((16.0 * r2 / (16.0 + r2)).mean())


def refuse(scan: Scan, model: BlendModel, model_digest: str, reasons: tuple[str, ...], seconds: float) -> Registration:
    """The registration of a scan without a hand: the model at rest in the middle of the points, verdict "bad"."""
    finite = scan.points[np.isfinite(scan.points).all(axis=1)]
    middle = np.median(finite, axis=0) if len(finite) else np.zeros(3)
    middle = np.where(np.abs(middle) < 50.0, middle, 0.0)
    vertices = model.template + middle - model.template.mean(axis=0)
    return Registration(
        vertices=vertices,
        model_vertices=vertices.copy(),
        faces=np.asarray(model.faces, dtype=np.int64),
        pose=np.zeros((len(model.parents), 3)),
        shape=np.zeros(model.num_shape),
        translation=middle - model.template.mean(axis=0),
        side="right",
        verdict="bad",
        score=1.0,
        reasons=tuple(reason for reason in reasons if reason),
        scan_to_mesh=np.full(len(scan.points), np.nan),
        seconds=seconds,
        scan=scan.name,
        scan_digest=digest_scan(scan),
        model_digest=model_digest,
    )
