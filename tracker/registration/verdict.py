"""What a registration is worth, judged without truth."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.capture.scan import Scan
from tracker.model.blend_model import BlendModel
from tracker.registration.free_fit import FreeSurface
from tracker.registration.model_fit import Evaluation, FitSettings, ModelFit
from tracker.registration.registration import Registration, digest_scan, summarize_distances
from tracker.registration.scan_points import ScanPoints

Array = npt.NDArray[np.float64]

JUDGE = FitSettings(4.0, 0, to_scan=1.0, pose_weight=0.3, shape_weight=0.3)
JUDGE_POINTS = 4000

GOOD, BAD = 0.35, 0.7
"""Scores below the one are good, above the other bad."""


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
    points = scan.first(JUDGE_POINTS)
    judged = fit.evaluate(evaluation.state, points, JUDGE)
    covered = float(np.isfinite(distances).sum()) / max(count, 1)
    measures = {
        "model_cost": judged.cost / len(fit.model.template),
        "covered": covered,
        "moved_mm": float(np.linalg.norm(surface.vertices - surface.model_vertices, axis=1).mean() * 1e3),
        "scan_to_mesh_mm": summarize_distances(distances)["mean"],
    }
    score = float(np.clip(measures["model_cost"] / 10.0, 0.0, 1.0))
    reasons = []
    if score >= GOOD:
        reasons.append(f"model and scan do not explain one another ({measures['model_cost']:.1f} mm² a vertex)")
    if covered < 0.4:
        score = max(score, BAD)
        reasons.append(f"only {100 * covered:.0f} % of the points lie beside the hand")
    name = "good" if score < GOOD else "doubtful" if score < BAD else "bad"
    return Verdict(name, score, tuple(reasons), measures)


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
