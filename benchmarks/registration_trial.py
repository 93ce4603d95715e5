"""Generated scans registered and measured against their truth, one file a scan, so that a study can be interrupted."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass, replace
from functools import cache
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.spatial import KDTree

from tracker.model.blend_files import load_blend_model
from tracker.model.blend_mirroring import mirror_blend
from tracker.model.blend_model import BlendModel
from tracker.model.untrained_hand import untrained_hand
from tracker.registration.curved_triangles import find_middles
from tracker.registration.register import Registrar
from tracker.registration.registration import Registration
from tracker.registration.registration_files import load_registration, save_registration
from tracker.synthesis.scans.generate import ScanOptions, generate_scan, scan_name
from tracker.synthesis.scans.generated_scan import GeneratedScan
from tracker.synthesis.scans.tissue import vertex_normals

Array = npt.NDArray[np.float64]

RIGHT_P95_MM = 10.0
"""A registration is right when 95 % of its vertices are nearer than this to the true ones."""


@dataclass(frozen=True)
class Trial:
    """One scan to register.

    Attributes:
        subject, pose, side, seed: See `generate_scan`.
        has_forearm, strength: See `ScanOptions`.
        folder: Where the result is kept.
        model: File of the model; None for the untrained hand.
        start: Folder of an earlier registration of the same scan to begin with.
    """

    subject: int
    pose: str
    side: str
    seed: int
    has_forearm: bool
    strength: float
    folder: Path
    model: Path | None = None
    start: Path | None = None

    @property
    def name(self) -> str:
        return scan_name(self.subject, self.pose, self.side, self.seed)

    def again(self, folder: Path, model: Path) -> Trial:
        """The same scan with another model, begun where this registration ended."""
        return replace(self, folder=folder, model=model, start=self.folder)

    def scan(self) -> GeneratedScan:
        options = ScanOptions(strength=self.strength, has_forearm=self.has_forearm)
        return generate_scan(self.subject, self.pose, self.side, self.seed, options)


def run_trials(trials: list[Trial], processes: int, progress: Callable[[float, str], None]) -> list[dict[str, Any]]:
    """What `measure` says of each trial, in their order; those that were done before are read."""
    rows: list[dict[str, Any]] = []
    if processes > 1:
        with ProcessPoolExecutor(processes, mp_context=get_context("spawn")) as pool:
            rows = list(_watch(pool.map(run_trial, trials), trials, progress))
    else:
        rows = list(_watch(map(run_trial, trials), trials, progress))
    return rows


def _watch(rows: Iterable[dict[str, Any]], trials: list[Trial], progress: Callable[[float, str], None]):
    for number, (row, trial) in enumerate(zip(rows, trials, strict=True)):
        progress((number + 1) / len(trials), trial.name)
        yield row


def run_trial(trial: Trial) -> dict[str, Any]:
    """Generate, register, measure and keep; kernels are compiled and tools made before the clock runs."""
    kept = trial.folder / trial.name / "measured.json"
    if kept.exists():
        return json.loads(kept.read_text())
    registrar = _load(trial.model)
    made = trial.scan()
    start = None if trial.start is None else load_registration(trial.start / trial.name).as_start()
    _warm_up(trial.model, start is not None)
    registration = registrar.register(made.scan, start=start)
    save_registration(registration, trial.folder / trial.name)
    row = {**{k: v for k, v in asdict(trial).items() if not isinstance(v, Path)}, "name": trial.name}
    row |= measure(registration, made, registrar.model)
    kept.write_text(json.dumps(row, indent=1))
    return row


@cache
def _load(path: Path | None) -> Registrar:
    return Registrar(untrained_hand("right") if path is None else load_blend_model(path))


@cache
def _warm_up(path: Path | None, is_warm: bool) -> None:
    made = generate_scan(1, "relaxed", options=ScanOptions())
    first = _load(path).register(made.scan)
    if is_warm:
        _load(path).register(made.scan, start=first.as_start())


def measure(registration: Registration, made: GeneratedScan, model: BlendModel) -> dict[str, Any]:
    """How good a registration is, mm; and what the program itself thinks of it."""
    error = 1e3 * np.linalg.norm(registration.vertices - made.true_vertices, axis=1)
    scan_to_mesh = 1e3 * registration.scan_to_mesh[made.is_hand]
    right = model if model.side == "right" else mirror_blend(model)
    flip = np.array([1.0 if registration.side == "right" else -1.0, 1.0, 1.0])
    posed = right.pose_at(registration.pose, registration.shape, registration.translation)
    joints = 1e3 * np.linalg.norm(posed.joints * flip - made.joints, axis=1)
    return {
        "seconds": registration.seconds,
        "processor_seconds": sum(registration.timings.values()),
        "found_side": registration.side,
        "verdict": registration.verdict,
        "score": registration.score,
        "measures": registration.measures,
        "reasons": list(registration.reasons),
        "scan_to_mesh_mm": float(np.nanmean(scan_to_mesh)) if np.isfinite(scan_to_mesh).any() else None,
        "surface_mm": float(1e3 * surface_distances(registration, made).mean()),
        "flat_surface_mm": float(1e3 * surface_distances(registration, made, is_curved=False).mean()),
        "vertices_mm": float(error.mean()),
        "vertices_p95_mm": float(np.percentile(error, 95)),
        "model_vertices_mm": float(
            1e3 * np.linalg.norm(registration.model_vertices - made.true_vertices, axis=1).mean()
        ),
        "joints_mm": float(joints.mean()),
    }


def surface_distances(registration: Registration, made: GeneratedScan, is_curved: bool = True) -> Array:
    """(V + F,) m from the registration's vertices and the middles of its faces to the true surface, seen or not.

    Args:
        is_curved: The faces bulge, as registration has them; else they are flat.
    """
    vertices, faces = registration.vertices, registration.faces
    middles = find_middles(vertices, faces) if is_curved else vertices[faces].mean(axis=1)
    points = np.concatenate([vertices, middles])
    vertices, faces = made.true_surface
    normals = vertex_normals(vertices, faces)
    away, nearest = KDTree(vertices).query(points)
    # Its edges are about 1 mm long: beside a vertex it is flat.
    height = np.abs(np.einsum("nx,nx->n", points - vertices[nearest], normals[nearest]))
    return np.where(away < 1.5e-3, height, np.asarray(away))


def is_right(row: dict[str, Any]) -> bool:
    return row["vertices_p95_mm"] < RIGHT_P95_MM
