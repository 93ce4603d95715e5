"""Registrations on the disk: `registration.npz` with every bit, and a PLY to look at."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

from tracker.capture.atomic_file import write_atomically
from tracker.capture.scan_ply import write_ply
from tracker.errors import RegistrationError, reading, reads
from tracker.model.npz_arrays import NpzFields, read_foreign_npz
from tracker.model.npz_files import pack_npz
from tracker.registration.curved_triangles import refine
from tracker.registration.registration import VERDICTS, Registration, summarize_distances

REGISTRATION_FILE = "registration.npz"
PLY_FILE = "registration.ply"
SURFACE_FILE = "registration_surface.ply"

NEEDED = "a registration.npz that `handloom register` wrote"

MAX_VERTICES = 100_000
MAX_COORDINATE = 100.0
MAX_SECONDS = 1e5
"""Bounds of ours (vertices, m, s), far above any registration: a hostile file costs no memory."""

TEXTS = ("side", "verdict", "scan", "scan_digest", "model_digest", "subject", "pose_name")


def save_registration(registration: Registration, folder: Path) -> None:
    """Write `registration.npz` and `registration.ply` into a folder; each appears whole or not at all, the npz last."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    write_atomically(folder / PLY_FILE, write_ply(registration.vertices, registration.faces))
    write_atomically(folder / REGISTRATION_FILE, pack_registration(registration))


def save_surface(registration: Registration, folder: Path) -> None:
    """Write `registration_surface.ply`: the hand with its triangles bulging, the vertices of the mesh coming first."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    write_atomically(folder / SURFACE_FILE, write_ply(*refine(registration.vertices, registration.faces)))


def pack_registration(registration: Registration) -> bytes:
    """The bytes of `registration.npz`; equal registrations give equal bytes."""
    summary = registration.scan_to_mesh_mm
    arrays: dict[str, Any] = {
        "vertices": registration.vertices,
        "model_vertices": registration.model_vertices,
        "faces": registration.faces.astype(np.int32),
        "pose": registration.pose,
        "shape": registration.shape,
        "translation": registration.translation,
        "score": np.array(registration.score),
        "scan_to_mesh": registration.scan_to_mesh.astype(np.float32),
        "scan_to_mesh_mm": np.array([summary["mean"], summary["median"], summary["p95"]]),
        "seconds": np.array(registration.seconds),
        "details": np.array(
            json.dumps(
                {
                    "reasons": list(registration.reasons),
                    "timings": registration.timings,
                    "measures": registration.measures,
                }
            )
        ),
    }
    arrays |= {name: np.array(getattr(registration, name)) for name in TEXTS}
    return pack_npz(arrays)


@reads(RegistrationError, NEEDED)
def load_registration(path: Path) -> Registration:
    """Read a `registration.npz`, or that of a folder, checking every array.

    Raises:
        RegistrationError: With what was found and what is needed.
    """
    path = Path(path)
    if path.is_dir():
        path = path / REGISTRATION_FILE
    fields = NpzFields(path, read_foreign_npz(path, RegistrationError), RegistrationError)
    vertices = fields.numbers("vertices", (-1, 3), MAX_COORDINATE)
    num_vertices = len(vertices)
    if not 3 <= num_vertices <= MAX_VERTICES:
        raise RegistrationError(path, f"{num_vertices} vertices", f"3 to {MAX_VERTICES}")
    texts = {name: fields.text(name) for name in TEXTS}
    if texts["verdict"] not in VERDICTS or texts["side"] not in ("right", "left"):
        raise RegistrationError(path, f"verdict {texts['verdict']!r}, side {texts['side']!r}", NEEDED)
    faces = fields.numbers("faces", (-1, 3), num_vertices - 1).astype(np.int64)
    if not 1 <= len(faces) <= 3 * num_vertices or faces.min() < 0:
        raise RegistrationError(path, f"{len(faces)} faces from vertex {faces.min(initial=0)}", NEEDED)
    distances = fields.take("scan_to_mesh", None, (-1,))
    if np.isinf(distances).any():
        raise RegistrationError(path, "scan_to_mesh that is not finite", NEEDED)
    details = _details(fields)
    return Registration(
        vertices=vertices,
        model_vertices=fields.numbers("model_vertices", (num_vertices, 3), MAX_COORDINATE),
        faces=faces,
        pose=fields.numbers("pose", (-1, 3), MAX_COORDINATE),
        shape=fields.numbers("shape", (-1,), MAX_COORDINATE),
        translation=fields.numbers("translation", (3,), MAX_COORDINATE),
        score=float(fields.numbers("score", (), 1.0)),
        reasons=tuple(str(reason) for reason in details["reasons"]),
        scan_to_mesh=distances.astype(np.float64),
        seconds=float(fields.numbers("seconds", (), MAX_SECONDS)),
        timings={str(name): float(value) for name, value in details["timings"].items()},
        measures={str(name): float(value) for name, value in details["measures"].items()},
        **texts,
    )


def summarize_registration(registration: Registration) -> dict[str, Any]:
    """What `handloom register --json` prints of a scan."""
    distances = {
        name: (round(value, 4) if np.isfinite(value) else None)
        for name, value in summarize_distances(registration.scan_to_mesh).items()
    }
    return {
        "scan": registration.scan,
        "seconds": round(registration.seconds, 3),
        "verdict": registration.verdict,
        "scan_to_mesh_mm": distances,
        "side": registration.side,
        "score": round(registration.score, 4),
        "reasons": list(registration.reasons),
    }


def _details(fields: NpzFields) -> dict[str, Any]:
    with reading(RegistrationError, fields.path, "details in JSON"):
        found = json.loads(fields.text("details", 1_000_000))
    kinds = {"reasons": list, "timings": dict, "measures": dict}
    if not isinstance(found, dict) or not all(isinstance(found.get(name), kind) for name, kind in kinds.items()):
        raise RegistrationError(fields.path, "details without reasons, timings and measures", NEEDED)
    values = [*found["timings"].values(), *found["measures"].values()]
    if not all(isinstance(value, int | float) for value in values):
        raise RegistrationError(fields.path, "timings or measures that are no numbers", NEEDED)
    return found
