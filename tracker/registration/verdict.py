"""The verdict on a registration, reached without the truth."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.capture.scan import Scan
from tracker.model.blend_model import BlendModel
from tracker.registration.free_fit import FreeSurface
from tracker.registration.hand_state import HandState
from tracker.registration.measures import measure, measure_cost
from tracker.registration.model_fit import Evaluation, FitSettings, ModelFit
from tracker.registration.registration import Registration, digest_scan
from tracker.registration.scan_points import ScanPoints

Array = npt.NDArray[np.float64]

LIMITS = {
    "tip_stretch": 1.0,
    "scan_to_finger": 2.5,
    "finger_to_scan": 4.5,
    "scan_to_palm": 4.0,
    "shape": 1.8,
}
"""A registration is good when every measure is below its limit, see docs/scans.md."""

BAD = 1.6
"""A registration is bad when a measure is this many times its limit."""

LEAST_COVERED = 0.35
"""Share of the points that must lie beside the hand. Chosen, not measured."""

UNLIKE = 0.5
"""A palm at this share of its limit is unlike those that the model knows: its person is strange, or its side wrong."""
OVER = (FitSettings(10.0, 30, to_scan=0.3), FitSettings(5.0, 30, to_scan=0.1))
OVER_POINTS = 3000

TOLD = {
    "tip_stretch": "the surface is stretched against the model at a fingertip (edges differ by {:.2f} mm)",
    "scan_to_finger": "parts of the scan lie away from a finger of the model ({:.1f} mm, root mean square)",
    "finger_to_scan": "a finger of the model has no scan beside it ({:.1f} mm, root mean square)",
    "scan_to_palm": "parts of the scan lie away from the palm of the model ({:.1f} mm, root mean square)",
    "shape": "the shape is unlike a hand's ({:.1f} standard deviations)",
    "covered": "only {:.0%} of the points lie beside the hand",
    "side": "a hand of the other side, turned over, fits no worse",
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
    is_unlike = shares["scan_to_palm"] > UNLIKE
    if max(shares.values()) < 1.0 and is_unlike and _fits_turned_over(fit, scan, evaluation):
        shares["side"] = 1.0
    worst = max(shares.values())
    score = float(worst / (1.0 + worst))
    if worst < 1.0:
        return Verdict("good", score, (TOLD["person"],) if is_unlike else (), measures)
    faults = sorted((name for name in shares if shares[name] >= 1.0), key=lambda name: -shares[name])
    return Verdict("doubtful" if worst < BAD else "bad", score, tuple(tell(one, measures) for one in faults), measures)


def tell(fault: str, measures: dict[str, float]) -> str:
    """A reason with its figure as people read it: squares as lengths."""
    value = measures.get(fault, 0.0)
    return TOLD[fault].format(np.sqrt(value) if "scan" in fault else value)


def _fits_turned_over(fit: ModelFit, scan: ScanPoints, evaluation: Evaluation) -> bool:
    """Whether a hand of the other side fits as well, its palm where the back of this one is.

    A flat hand is much like a hand of the other side turned over: thumb and fingers lie where they should, and only
    palm and back are unlike. Registered so it has the measures of a strange person, but the right side fits better.
    """
    state, other = evaluation.state, turn_over(fit.model, evaluation.state)
    mirrored = scan.mirrored()
    for settings in OVER:
        other = fit.fit(other, mirrored.first(OVER_POINTS), settings).state
    return measure_cost(fit, mirrored, other) <= measure_cost(fit, scan, state)


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
