"""What the verdict on a registration rests on."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.spatial import KDTree

from tracker.geometry.vertex_normals import find_unit_normals
from tracker.registration.free_fit import FreeSurface
from tracker.registration.hand_state import HandState
from tracker.registration.model_fit import MM, Evaluation, FitSettings, ModelFit
from tracker.registration.scan_points import ScanPoints
from tracker.registration.surface_search import Matches

Array = npt.NDArray[np.float64]

JUDGE = FitSettings(4.0, 0, to_scan=1.0, pose_weight=0.3, shape_weight=3.0)
JUDGE_POINTS = 4000
"""How a fit is judged, and on how many points. Chosen, not measured."""

SQUARE = 16.0
"""Of the scale of the Geman-McClure function, mm²."""

REACH = 0.016
"""No point and no vertex looks farther, m."""

HIDING, FACING = 0.025, 0.5
"""A hand hides its skin from a scanner where another part of it is this near, m, and so straight before it (cosine)."""


def measure(
    fit: ModelFit, scan: ScanPoints, evaluation: Evaluation, surface: FreeSurface, distances: Array, count: int
) -> dict[str, float]:
    """What tells right from wrong, see docs/scans.md.

    A person unlike the model is so all over the hand, most of all at the palm; a wrong pose shows at one finger. So
    fingers are measured one by one, and the worst counts.

    Returns:
        tip_stretch: Root mean square difference of edges between free surface and model, of the worst last phalanx, mm.
        scan_to_finger: Mean Geman-McClure cost (4 mm) of scan points beside the model, of the worst finger, mm².
        scan_to_palm: The same of the palm.
        finger_to_scan: The same of vertices that look for the scan and that the hand itself does not hide, of the worst
            finger.
        scan_to_surface: Of all scan points beside the free surface.
        stretch: As the first, of all edges.
        covered: Share of the points that lie beside the free surface and not behind its rim.
        shape: Root mean square of the shape coefficients.
    """
    points = scan.first(JUDGE_POINTS)
    judged = fit.evaluate(evaluation.state, points, JUDGE)
    vertices, faces = judged.posed.vertices, fit.search.faces
    bones = fit.model.skinning_weights.argmax(axis=1)
    parts = (bones + 2) // 3
    nearest = fit.search.match(vertices, points.points, np.zeros_like(points.normals), 1.0)
    counted = ~nearest.on_rim & ~judged.matches.on_rim
    to_parts = _mean_by(_robust(judged.matches)[counted], parts[faces[nearest.faces, 0]][counted], 6)
    is_open = ~_find_hidden(fit, vertices)
    free_matches = fit.search.match(surface.vertices, points.points, points.normals, REACH)
    corners = surface.vertices[faces[:, :2]] - surface.model_vertices[faces[:, :2]]
    stretches = ((corners[:, 0] - corners[:, 1]) ** 2).sum(axis=1) * MM**2
    return {
        "tip_stretch": float(np.sqrt(_mean_by(stretches, bones[faces[:, 0]], 16)[3::3].max())),
        "scan_to_finger": float(to_parts[1:].max()),
        "scan_to_palm": float(to_parts[0]),
        "finger_to_scan": float(
            _mean_by(_look_back(fit, scan, vertices)[is_open], parts[fit.inner][is_open], 6)[1:].max()
        ),
        "scan_to_surface": _mean(_robust(free_matches), ~nearest.on_rim & ~free_matches.on_rim),
        "stretch": float(np.sqrt(stretches.mean())),
        "covered": float(np.isfinite(distances).sum()) / max(count, 1),
        "shape": float(np.sqrt((evaluation.state.shape**2).mean())) if fit.model.num_shape else 0.0,
    }


def _robust(matches: Matches) -> Array:
    """Geman-McClure cost (N,) of matched points, mm²."""
    r2 = np.where(matches.faces >= 0, matches.offsets * MM, 1e3) ** 2
    return SQUARE * r2 / (r2 + SQUARE)


def _mean(costs: Array, counted: npt.NDArray[np.bool_]) -> float:
    return float(costs[counted].mean()) if counted.any() else SQUARE


def _mean_by(values: Array, groups: npt.NDArray[np.int64], count: int) -> Array:
    """(count,) means of values (N,) by group; 0 for a group without any."""
    return np.bincount(groups, values, count) / np.maximum(np.bincount(groups, minlength=count), 1)


def _look_back(fit: ModelFit, scan: ScanPoints, vertices: Array) -> Array:
    """Robust cost of each vertex off the rim that looks for the scan, mm²."""
    back = fit.look_back(vertices, scan, REACH)
    r2 = np.where(back.is_used, (MM * back.along) ** 2, 1e6)
    return SQUARE * r2 / (SQUARE + r2)


def _find_hidden(fit: ModelFit, vertices: Array) -> npt.NDArray[np.bool_]:
    """Which vertices off the rim no scanner sees, because another part of the hand that faces them lies before them."""
    normals = find_unit_normals(vertices, fit.search.faces)
    a, b = np.concatenate([pairs := KDTree(vertices).query_pairs(HIDING, output_type="ndarray"), pairs[:, ::-1]]).T
    towards = vertices[b] - vertices[a]
    ahead = np.einsum("nd,nd->n", towards, normals[a]) > FACING * np.linalg.norm(towards, axis=1)
    faces_it = np.einsum("nd,nd->n", normals[a], normals[b]) < -FACING
    hidden = np.zeros(len(vertices), dtype=bool)
    hidden[a[ahead & faces_it]] = True
    return hidden[fit.inner]


def measure_cost(fit: ModelFit, scan: ScanPoints, state: HandState) -> float:
    """Of points beside the model and vertices beside the scan, mm²."""
    points = scan.first(JUDGE_POINTS)
    judged = fit.evaluate(state, points, JUDGE)
    vertices = judged.posed.vertices
    beside = ~fit.search.match(vertices, points.points, np.zeros_like(points.normals), 1.0).on_rim
    return _mean(_robust(judged.matches), beside & ~judged.matches.on_rim) + float(
        _look_back(fit, scan, vertices).mean()
    )
