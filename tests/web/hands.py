"""Scans of hands with registrations in a running studio: scans of the product's own making, meshes near their truth."""

from __future__ import annotations

import functools
import json
import uuid
import zipfile
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial import KDTree
from scipy.spatial.transform import Rotation

import server.app.app  # noqa: F401 (all tables, which name each other)
from server.database import Database
from server.hand_models.storing import resolve_model
from server.jobs.scan_run import measure_errors
from server.registrations import service as registrations
from server.registrations.models import RegistrationRow
from server.settings import Settings
from server.storage import Storage
from server.storage.digest import compute_digest
from tracker import Registration, save_registration, untrained_hand
from tracker.capture.scan import load_scan, save_scan
from tracker.synthesis.scans.generate import ScanOptions, generate_scan
from tracker.synthesis.scans.generated_scan import GeneratedScan
from tracker.synthesis.scans.scanner import Scanner

POINTS = 22_000
"""Of a scan: a little more than the browser draws."""

DIFFERENT = 4
"""Hands; the others are these again, lying otherwise."""


@dataclass(frozen=True)
class Hands:
    """What a studio was filled with."""

    scans: list[dict[str, Any]]
    registrations: list[str]
    """Ids, the likeliest failure first."""
    model_id: str


def write_scans(folder: Path, count: int) -> tuple[Path, list[GeneratedScan]]:
    """A .zip of scans with their `scans.json`, right and left by turns, and what they are scans of."""
    few = [_generate(n) for n in range(min(count, DIFFERENT))]
    made = [_turn(few[n % len(few)], n) for n in range(count)]
    listed = []
    for number, one in enumerate(made):
        name = f"{number:02d}_{one.pose_name}_{one.side}.ply"
        save_scan(one.scan, folder / name)
        listed.append({"file": name, "subject": f"S{one.subject:02d}", "pose": one.pose_name, "side": one.side})
    (folder / "scans.json").write_text(json.dumps({"scans": listed}))
    archive = folder / "scans.zip"
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_STORED) as file:
        for path in sorted(folder.iterdir()):
            if path != archive:
                file.write(path, path.name)
    return archive, made


@functools.cache
def _generate(number: int) -> GeneratedScan:
    """Seconds each, and the same for every test."""
    options = ScanOptions(scanner=Scanner(num_points=POINTS))
    return generate_scan(1 + number, 7 * number, ("right", "left")[number % 2], number, options)


def _turn(one: GeneratedScan, seed: int) -> GeneratedScan:
    """The same hand, scanned lying otherwise."""
    R = Rotation.from_rotvec(np.random.default_rng(seed).normal(size=3)).as_matrix()
    scan = replace(one.scan, points=one.scan.points @ R.T, normals=one.scan.normals @ R.T)
    surface = one.true_surface[0] @ R.T, one.true_surface[1]
    return replace(one, scan=scan, true_vertices=one.true_vertices @ R.T, true_surface=surface, joints=one.joints @ R.T)


def fill_studio(studio: Any, folder: Path, count: int, collection: str = "grasps") -> Hands:
    """Upload scans through the API and add a registration of each, as the job of a worker stores it."""
    archive, made = write_scans(folder, count)
    with archive.open("rb") as file:
        options = json.dumps({"collection": collection})
        answer = studio.send("POST", "/scans", files={"files": (archive.name, file)}, data={"options": options})
    assert answer.status_code == 201, answer.text
    assert not answer.json()["refused"], answer.json()["refused"]
    scans = sorted(answer.json()["added"] + answer.json()["known"], key=lambda scan: scan["name"])
    settings = Settings(data_dir=studio.data_dir)
    database, storage = Database(settings.sqlalchemy_url), Storage(studio.data_dir)
    with database.writing() as session:
        model_id = resolve_model(session, storage, None).id
    ids = [
        _register(database, storage, scan, one, model_id, number)
        for number, (scan, one) in enumerate(zip(scans, made, strict=True))
    ]
    return Hands(scans, ids[::-1], str(model_id))


def _register(
    database: Database, storage: Storage, scan: dict[str, Any], one: GeneratedScan, model_id: uuid.UUID, number: int
) -> str:
    kept = load_scan(storage.folder("scans", uuid.UUID(scan["id"])) / "scan.ply")
    is_hand = one.is_hand[KDTree(one.scan.points).query(kept.points)[1]]  # in the order of the studio's scan
    vertices = one.true_vertices + np.random.default_rng(number).normal(0, 0.0004, one.true_vertices.shape)
    distances = np.where(is_hand, KDTree(one.true_surface[0]).query(kept.points)[0], np.nan)
    model = untrained_hand("right")
    faces = model.faces if one.side == "right" else model.faces[:, ::-1]
    found = Registration(
        vertices=vertices,
        model_vertices=vertices,
        faces=faces,
        pose=np.zeros((16, 3)),
        shape=np.zeros(model.num_shape),
        translation=np.zeros(3),
        side=one.side,
        verdict=("good", "doubtful", "bad")[number % 3],
        score=0.1 + 0.01 * number,
        reasons=() if number % 3 else ("The thumb lies 4.1 mm off the scan.",),
        scan_to_mesh=distances,
        seconds=1.0,
    )
    id_ = uuid.uuid4()
    folder = storage.folder(registrations.AREA, id_)
    save_registration(found, folder)
    vertex_error, point_error = measure_errors(found, kept, np.ones(len(kept.points), bool))
    np.savez_compressed(folder / registrations.ERRORS, vertex_error_mm=vertex_error, point_error_mm=point_error)
    with database.writing() as session:
        row = RegistrationRow(
            id=id_,
            scan_id=uuid.UUID(scan["id"]),
            model_id=model_id,
            round=1,
            crop_revision=1,
            digest=compute_digest(folder / registrations.FILE),
            side=one.side,
            verdict=found.verdict,
            score=found.score,
            reasons=list(found.reasons),
            scan_to_mesh_mm=found.scan_to_mesh_mm,
            seconds=1.0,
            decision=None,
        )
        registrations.add_registration(session, row)
    return str(id_)
