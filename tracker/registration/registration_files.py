"""Registrations on the disk: `registration.npz` with every bit, and a PLY to look at."""

from __future__ import annotations

import io
import json
import zipfile
from pathlib import Path
from typing import Any

import numpy as np

from tracker.capture.atomic_file import write_atomically
from tracker.capture.scan_ply import write_ply
from tracker.errors import RegistrationError, reading, reads
from tracker.registration.curved_triangles import refine
from tracker.registration.registration import VERDICTS, Registration, summarize_distances

REGISTRATION_FILE = "registration.npz"
PLY_FILE = "registration.ply"
SURFACE_FILE = "registration_surface.ply"

NEEDED = "a registration.npz that `handloom register` wrote"

MAX_BYTES = 64 * 2**20
MAX_UNPACKED_BYTES = 256 * 2**20
MAX_VERTICES = 100_000
MAX_COORDINATE = 100.0

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
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, array in arrays.items():
            entry = zipfile.ZipInfo(f"{name}.npy", date_time=(1980, 1, 1, 0, 0, 0))
            entry.compress_type = zipfile.ZIP_DEFLATED
            content = io.BytesIO()
            np.lib.format.write_array(content, np.asarray(array, order="C"), allow_pickle=False)
            archive.writestr(entry, content.getvalue(), compresslevel=1)
    return buffer.getvalue()


@reads(RegistrationError, NEEDED)
def load_registration(path: Path) -> Registration:
    """Read a `registration.npz`, or that of a folder, checking every array.

    Raises:
        RegistrationError: With what was found and what is needed.
    """
    path = Path(path)
    if path.is_dir():
        path = path / REGISTRATION_FILE
    fields = _read(path)
    vertices = _floats(path, fields, "vertices", (-1, 3))
    num_vertices = len(vertices)
    if not 3 <= num_vertices <= MAX_VERTICES:
        raise RegistrationError(path, f"{num_vertices} vertices", f"3 to {MAX_VERTICES}")
    texts = _texts(path, fields)
    details = _details(path, fields)
    return Registration(
        vertices=vertices,
        model_vertices=_floats(path, fields, "model_vertices", (num_vertices, 3)),
        faces=_faces(path, fields, num_vertices),
        pose=_floats(path, fields, "pose", (-1, 3)),
        shape=_floats(path, fields, "shape", (-1,)),
        translation=_floats(path, fields, "translation", (3,)),
        score=float(_floats(path, fields, "score", ())),
        reasons=tuple(str(reason) for reason in details["reasons"]),
        scan_to_mesh=_distances(path, fields),
        seconds=float(_floats(path, fields, "seconds", ())),
        timings={str(name): float(value) for name, value in details["timings"].items()},
        measures={str(name): float(value) for name, value in details["measures"].items()},
        **texts,
    )


def _faces(path: Path, fields: dict[str, np.ndarray], num_vertices: int) -> np.ndarray:
    faces = fields["faces"]
    if faces.ndim != 2 or faces.shape[1] != 3 or faces.dtype.kind not in "ui" or not len(faces):
        raise RegistrationError(path, f"faces of shape {faces.shape} and kind {faces.dtype}", NEEDED)
    if len(faces) > 3 * num_vertices or faces.min() < 0 or faces.max() >= num_vertices:
        raise RegistrationError(
            path, f"{len(faces)} faces up to vertex {faces.max()}", f"vertices below {num_vertices}"
        )
    return faces.astype(np.int64)


def _texts(path: Path, fields: dict[str, np.ndarray]) -> dict[str, str]:
    texts = {name: _text(path, fields, name) for name in TEXTS}
    if texts["verdict"] not in VERDICTS or texts["side"] not in ("right", "left"):
        raise RegistrationError(path, f"verdict {texts['verdict']!r}, side {texts['side']!r}", NEEDED)
    return texts


def _distances(path: Path, fields: dict[str, np.ndarray]) -> np.ndarray:
    distances = fields["scan_to_mesh"]
    if distances.ndim != 1 or distances.dtype.kind != "f" or np.isinf(distances).any():
        raise RegistrationError(path, f"scan_to_mesh of shape {distances.shape}", NEEDED)
    return distances.astype(np.float64)


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


def _read(path: Path) -> dict[str, np.ndarray]:
    names = ("vertices", "model_vertices", "faces", "pose", "shape", "translation", "score", "scan_to_mesh", "seconds")
    needed = (*names, "details", *TEXTS)
    with reading(RegistrationError, path, NEEDED):
        if path.stat().st_size > MAX_BYTES:
            raise RegistrationError(path, f"{path.stat().st_size} bytes", f"at most {MAX_BYTES}")
        with zipfile.ZipFile(path) as archive:
            unpacked = sum(entry.file_size for entry in archive.infolist())
        if unpacked > MAX_UNPACKED_BYTES:
            raise RegistrationError(path, f"{unpacked} bytes when unpacked", f"at most {MAX_UNPACKED_BYTES}")
        with np.load(path, allow_pickle=False) as arrays:
            missing = [name for name in needed if name not in arrays]
            if missing:
                raise RegistrationError(path, f"no {', '.join(missing)}", NEEDED)
            return {name: arrays[name] for name in needed}


def _floats(path: Path, fields: dict[str, np.ndarray], name: str, shape: tuple[int, ...]) -> np.ndarray:
    array = fields[name]
    fits = array.ndim == len(shape) and all(want in (-1, got) for want, got in zip(shape, array.shape, strict=True))
    if not fits or array.dtype.kind not in "fiu":
        raise RegistrationError(path, f"{name} of shape {array.shape} and kind {array.dtype}", f"numbers {shape}")
    array = array.astype(np.float64)
    if not np.isfinite(array).all() or np.abs(array).max(initial=0.0) > MAX_COORDINATE * (1e3 if not shape else 1.0):
        raise RegistrationError(path, f"{name} that is not finite or beyond {MAX_COORDINATE:g}", NEEDED)
    return array


def _text(path: Path, fields: dict[str, np.ndarray], name: str) -> str:
    array = fields[name]
    if array.ndim or array.dtype.kind != "U" or len(str(array)) > 500:
        raise RegistrationError(path, f"{name} of shape {array.shape} and kind {array.dtype}", "a short text")
    return str(array)


def _details(path: Path, fields: dict[str, np.ndarray]) -> dict[str, Any]:
    text = fields["details"]
    with reading(RegistrationError, path, "details in JSON"):
        found = json.loads(str(text)) if text.ndim == 0 and text.dtype.kind == "U" else None
    kinds = {"reasons": list, "timings": dict, "measures": dict}
    if not isinstance(found, dict) or not all(isinstance(found.get(name), kind) for name, kind in kinds.items()):
        raise RegistrationError(path, "details without reasons, timings and measures", NEEDED)
    values = [*found["timings"].values(), *found["measures"].values()]
    if not all(isinstance(value, int | float) for value in values):
        raise RegistrationError(path, "timings or measures that are no numbers", NEEDED)
    return found
