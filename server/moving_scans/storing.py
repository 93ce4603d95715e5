"""Files of registered frames: written by the job, read by the browser and by what comes after."""

from __future__ import annotations

import os
import shutil
import uuid
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import KDTree
from sqlalchemy.exc import IntegrityError

from server.database import Database
from server.moving_scans.frame_files import choose_view_points
from server.moving_scans.models import FrameRegistrationRow
from server.scans.geometry import pack_arrays
from server.storage import Storage
from server.storage.digest import compute_digest

if TYPE_CHECKING:
    from tracker import BlendModel, Scan
    from tracker.bodies import BodyRegistration

AREA = "frame_registrations"
TEMPLATES = "moving_registrations"
BODY, VIEW, TEMPLATE = "body.npz", "body.view", "template.npz"

NAMESPACE = uuid.UUID("5a5c0d52-4a4e-4c0a-9d9a-6d9a3a1b7f10")


def name_frame(registration_id: uuid.UUID, frame: int) -> uuid.UUID:
    """The id of a frame's registration: a step done twice finds it."""
    return uuid.uuid5(NAMESPACE, f"{registration_id}/{frame}")


def write_frame(folder: Path, found: BodyRegistration, model: BlendModel, scan: tuple[Scan, str]) -> None:
    """Write the files of a registered frame.

    Args:
        folder: Where to.
        found: What was found.
        model: Of the body.
        scan: What it was laid onto, and the SHA-256 of that file.
    """
    from tracker.bodies import save_body_registration

    save_body_registration(found, model.faces, folder)
    (folder / VIEW).write_bytes(pack_frame(found, model, *scan))


def store_frame(database: Database, storage: Storage, place: tuple[uuid.UUID, int], source: Path) -> None:
    """Keep a registered frame for good: the files first, then its row. One that is kept stays as it is.

    Args:
        place: The registration and the frame.
        source: The folder with its files.
    """
    from tracker.bodies import load_body_registration

    id_ = name_frame(*place)
    with database.reading() as session:
        if session.get(FrameRegistrationRow, id_) is not None:
            return
    folder = storage.folder(AREA, id_)
    shutil.rmtree(folder, ignore_errors=True)  # left by a crash
    shutil.copytree(source, folder, copy_function=os.link)
    storage.publish(AREA, id_)
    found = load_body_registration(folder)
    told = found.summary()["scan_to_mesh_mm"]
    row = FrameRegistrationRow(
        id=id_,
        registration_id=place[0],
        frame=place[1],
        digest=compute_digest(folder / BODY),
        verdict=found.verdict,
        reasons=list(found.reasons),
        scan_to_mesh_mm={name: value if np.isfinite(value) else None for name, value in told.items()},
        has_left=found.are_shown[0],
        has_right=found.are_shown[1],
        seconds=float(sum(found.seconds.values())),
    )
    with suppress(IntegrityError), database.writing() as session:  # another process kept it at this very moment
        session.add(row)


def pack_frame(found: BodyRegistration, model: BlendModel, scan: Scan, digest: str) -> bytes:
    """A registered frame for the browser, whose points are those of the frame's own geometry."""
    from tracker.bodies import body_hand

    distances = 1e3 * found.scan_to_mesh
    nearest = KDTree(found.vertices).query(scan.points)[1]
    counts = np.bincount(nearest, minlength=len(found.vertices))
    sums = np.bincount(nearest, distances, minlength=len(found.vertices))
    guessed = np.zeros(len(found.vertices), dtype=np.uint8)
    for side, is_shown in zip(("left", "right"), found.are_shown, strict=True):
        if not is_shown:
            guessed[body_hand(model, side).vertices] = 1
    error = np.where((counts > 0) & (guessed == 0), sums / np.maximum(counts, 1), np.nan)
    normals = compute_normals(found.vertices, model.faces)
    return pack_arrays(
        {
            "vertices": found.vertices.astype(np.float32),
            "normals": np.round(127.0 * normals).astype(np.int8),
            "vertex_error_mm": error.astype(np.float32),
            "point_error_mm": distances[choose_view_points(scan, digest)].astype(np.float32),
            "guessed": guessed,
        },
        {},
    )


def compute_normals(vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """(V, 3) unit normals of a surface (V, 3) with faces (F, 3), each the mean of its faces' by their areas."""
    corners = vertices[faces]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals = np.zeros_like(vertices)
    for corner in range(3):
        np.add.at(normals, faces[:, corner], across)
    return normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)


def find_view(storage: Storage, frame_registration_id: uuid.UUID) -> Path:
    """The file of a frame for the browser."""
    return storage.folder(AREA, frame_registration_id) / VIEW
