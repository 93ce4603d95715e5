"""How good a trained hand model is on people it has not seen, [R17] section 5.1 and Fig. 12-14."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from tracker.evaluation.scan_fit import (
    fit_pose_to_vertices,
    fit_to_scan,
    fit_to_vertices,
    measure_scan,
    with_template,
)
from tracker.model.blend_model import BlendModel
from tracker.registration.surface_search import SurfaceSearch
from tracker.training.spaces import find_space

Array = npt.NDArray[np.float64]
Progress = Callable[[float], None]

FITTED_POINTS = 4000
"""Points of a scan that are fitted; all are measured."""


@dataclass(frozen=True)
class TestHand:
    """A right hand whose truth is known.

    Attributes:
        subject: Whose.
        pose_name: Which pose.
        points: (N, 3) of its scan that are on the hand, m; normals (N, 3).
        vertices: (V, 3) true vertices in the model's topology, m.
        joints: (B, 3) true joints, m.
    """

    __test__ = False

    subject: str
    pose_name: str
    points: Array
    normals: Array
    vertices: Array
    joints: Array


@dataclass(frozen=True)
class ModelErrors:
    """Of a model on N hands, each (N,) mm.

    Attributes:
        scan_to_mesh: Mean distance of the scan's points to the model fitted to the scan.
        vertices: Mean distance of the true vertices from those of the model fitted to them.
        joints: Mean distance of the true joints from those of the model fitted to the true vertices.
        scan_joints: From those of the model fitted to the scan.
    """

    scan_to_mesh: Array
    vertices: Array
    joints: Array
    scan_joints: Array

    def summarize(self) -> dict[str, float]:
        """Means, and the standard deviation of the distances to scans, mm."""
        return {
            "scan_to_mesh_mm": round(float(self.scan_to_mesh.mean()), 4),
            "scan_to_mesh_sd_mm": round(float(self.scan_to_mesh.std()), 4),
            "vertices_mm": round(float(self.vertices.mean()), 4),
            "joints_mm": round(float(self.joints.mean()), 4),
            "scan_joints_mm": round(float(self.scan_joints.mean()), 4),
        }


def find_template(model: BlendModel, vertices: Array, rounds: int = 4) -> Array:
    """(V, 3) a person's template from one registration (V, 3), m: the model's, moved by what the fit leaves.

    Its joints move with it, so that pose and template are found in turn.
    """
    fit = fit_to_vertices(model, vertices)
    template = model.shaped(fit.shape)
    for _ in range(rounds):
        motions = np.einsum("vb,bij->vij", model.skinning_weights, fit.posed.Ts)
        rest = np.linalg.solve(motions[:, :, :3], (vertices - motions[:, :, 3])[..., None])[..., 0]
        template = np.asarray(template + rest - fit.posed.rest, dtype=np.float64)
        fit = fit_pose_to_vertices(with_template(model, template), vertices)
    return template


def judge_model(
    model: BlendModel,
    hands: Sequence[TestHand],
    templates: dict[str, Array] | None = None,
    num_components: int | None = None,
    progress: Progress | None = None,
) -> ModelErrors:
    """Fit a model to hands it has not seen.

    Args:
        model: A right hand.
        hands: To fit.
        templates: A template by subject, then held while the pose is fitted; None: the shape is fitted, too.
        num_components: Poses are confined to so many components of the pose space.
        progress: Told the share done; may raise to cancel.
    """
    search = SurfaceSearch(model.template, model.faces)
    rows = []
    for number, hand in enumerate(hands):
        own = model if templates is None else with_template(model, templates[hand.subject])
        start = (fit_to_vertices if templates is None else fit_pose_to_vertices)(own, hand.vertices)
        chosen = slice(0, FITTED_POINTS)
        fit = fit_to_scan(start, search, hand.points[chosen], hand.normals[chosen], num_components=num_components)
        rows.append(
            (
                np.nanmean(measure_scan(fit, search, hand.points)),
                np.linalg.norm(start.posed.vertices - hand.vertices, axis=1).mean(),
                np.linalg.norm(start.posed.joints - hand.joints, axis=1).mean(),
                np.linalg.norm(fit.posed.joints - hand.joints, axis=1).mean(),
            )
        )
        if progress is not None:
            progress((number + 1) / len(hands))
    return ModelErrors(*(1e3 * np.array(rows).T))


def measure_floor(model: BlendModel, hands: Sequence[TestHand]) -> float:
    """Mean distance of scans to the mesh of the true vertices, mm: noise, and flat triangles for round skin."""
    search = SurfaceSearch(model.template, model.faces)
    distances = []
    for hand in hands:
        found = search.match(hand.vertices, hand.points, np.zeros_like(hand.points), 10.0)
        distances.append(np.abs(found.offsets[~found.on_rim]).mean())
    return 1e3 * float(np.mean(distances))


def generalize_poses(
    model: BlendModel,
    hands: Sequence[TestHand],
    templates: dict[str, Array],
    counts: Sequence[int],
    progress: Progress | None = None,
) -> list[dict[str, float]]:
    """Distance to unseen scans by the number of components of the pose space, [R17] Fig. 13."""
    rows = []
    for number, count in enumerate(counts):
        errors = judge_model(model, hands, templates, min(count, len(model.pose_components)))
        rows.append(
            {
                "components": count,
                "mean_mm": round(float(errors.scan_to_mesh.mean()), 4),
                "sd_mm": round(float(errors.scan_to_mesh.std()), 4),
            }
        )
        if progress is not None:
            progress((number + 1) / len(counts))
    return rows


def generalize_shapes(templates: Array, people: npt.NDArray, counts: Sequence[int]) -> list[dict[str, float]]:
    """Mean absolute error of templates of people left out, by the number of components, [R17] Fig. 14.

    Args:
        templates: (S, V, 3) m.
        people: (S,) whose: all hands of a person are left out together.
        counts: Numbers of components.
    """
    flat = templates.reshape(len(templates), -1)
    errors: dict[int, list[float]] = {count: [] for count in counts}
    for person in np.unique(people):
        space = find_space(flat[people != person])
        for own in flat[people == person] - space.mean:
            for count in counts:
                basis = space.components[:count]
                errors[count].append(float(np.abs(own - basis.T @ (basis @ own)).mean()))
    return [
        {
            "components": count,
            "mean_mm": round(1e3 * float(np.mean(found)), 4),
            "sd_mm": round(1e3 * float(np.std(found)), 4),
        }
        for count, found in errors.items()
    ]


def describe_compactness(report: dict[str, Any]) -> dict[str, list[float]]:
    """Share of the variance explained by the first components of pose and shape space, [R17] Fig. 12."""
    return {"pose": list(report["pose_space"]), "shape": list(report["shape_space"])}
