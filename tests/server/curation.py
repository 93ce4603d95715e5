"""Scans and registrations to be curated: one hand that was registered for real, laid into the studio many times."""

from __future__ import annotations

import json
import shutil
import uuid
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fastapi import FastAPI
from scipy.spatial import KDTree
from sqlalchemy.orm import Session

from server.hand_models.storing import UNTRAINED_ID, resolve_model
from server.jobs.scan_run import measure_errors
from server.registrations import service as registrations
from server.registrations.decision_schemas import DecisionMake
from server.registrations.decisions import decide
from server.registrations.models import RegistrationRow
from server.registrations.training_set_schemas import TrainingRule
from server.registrations.training_sets import create_training_set
from server.scans.models import ScanRow
from server.scans.service import write_geometry_key
from server.storage import Storage
from server.storage.digest import compute_digest
from tests.server.conftest import GeneratedHand, Studio
from tests.server.teams.conftest import Person, join
from tracker import Registration, Scan, save_registration, untrained_hand
from tracker.capture.scan import load_scan, save_scan
from tracker.evaluation.scan_fit import fit_pose_to_vertices
from tracker.synthesis.scans.generate import ScanOptions, generate_scan
from tracker.synthesis.scans.scanner import Scanner

__all__ = ["Curation", "curation", "join", "make_ball", "send_scans"]

API = "/api/v1"


def make_ball(seed: int = 0, count: int = 2000, radius: float = 0.08, colors: np.ndarray | None = None) -> Scan:
    """Points on a ball, of a size that a hand may have; each seed gives another file."""
    directions = np.random.default_rng(seed).normal(size=(count, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    return Scan(radius * directions, directions, None, colors, "ball")


def make_true_hand(folder: Path, subject: int, pose: int, side: str = "right", points: int = 2500) -> GeneratedHand:
    """A small scan with the true registration of it, written into a folder of its own."""
    options = ScanOptions(scanner=Scanner(num_points=points), has_forearm=False)
    made = generate_scan(subject, pose, side, 100 * subject + pose, options)
    folder.mkdir(parents=True)
    save_scan(made.scan, folder / "hand.ply")
    scan = load_scan(folder / "hand.ply")
    distances = KDTree(made.true_surface[0]).query(scan.points)[0]
    model = untrained_hand("right")
    flip = np.array([1.0 if side == "right" else -1.0, 1.0, 1.0])
    fit = fit_pose_to_vertices(model, made.true_vertices * flip)
    found = Registration(
        vertices=made.true_vertices,
        model_vertices=made.true_vertices,
        faces=model.faces if side == "right" else model.faces[:, ::-1],
        pose=fit.pose,
        shape=np.zeros(model.num_shape),
        translation=fit.translation,
        side=side,
        verdict="good",
        score=0.1,
        reasons=(),
        scan_to_mesh=distances,
        seconds=1.0,
        subject=f"S{subject}",
        pose_name=made.pose_name,
    )
    save_registration(found, folder)
    return GeneratedHand(scan, found, folder)


def send_scans(studio: Studio, files: dict[str, bytes], headers: dict[str, str] | None = None, **options: Any) -> Any:
    """Upload files as scans; the answer as it comes."""
    parts = [("files", (name, data)) for name, data in files.items()]
    return studio.client.post(f"{API}/scans", files=parts, data={"options": json.dumps(options)}, headers=headers)


def add_registered(
    app: FastAPI, hand: GeneratedHand, name: str, score: float = 0.1, verdict: str = "good", **columns: Any
) -> uuid.UUID:
    """Lay a registered hand into a studio under a name; gives the id of the registration."""
    storage, id_ = app.state.storage, uuid.uuid4()
    folder = storage.folder(registrations.AREA, id_)
    shutil.copytree(hand.folder, folder)
    kept = np.ones(len(hand.scan.points), bool)
    vertex_error, point_error = measure_errors(hand.found, hand.scan, kept)
    np.savez(folder / registrations.ERRORS, vertex_error_mm=vertex_error, point_error_mm=point_error)
    with app.state.database.writing() as session:
        model = resolve_model(session, storage, columns.pop("model_id", None))
        row = RegistrationRow(
            id=id_,
            scan_id=columns.pop("scan_id", None) or _add_scan(session, storage, hand, name, columns),
            model_id=model.id,
            round=model.round + 1,
            crop_revision=1,
            digest=compute_digest(folder / registrations.FILE),
            side=columns.get("side", "right"),
            verdict=verdict,
            score=score,
            reasons=[],
            scan_to_mesh_mm=hand.found.scan_to_mesh_mm,
            seconds=1.0,
            decision=None,
        )
        registrations.add_registration(session, row)
    return id_


def _add_scan(session: Session, storage: Storage, hand: GeneratedHand, name: str, columns: dict[str, Any]) -> uuid.UUID:
    path = hand.folder / "hand.ply"
    row = ScanRow(
        name=name,
        collection=columns.get("collection", "hands"),
        subject=columns.get("subject", "Ada"),
        pose=columns.get("pose", "flat"),
        side=None,
        file="scan.ply",
        digest=compute_digest(path),
        byte_count=path.stat().st_size,
        point_count=len(hand.scan.points),
        face_count=0,
        has_colors=False,
        extent_m=[0.1, 0.1, 0.1],
        notes=[],
    )
    session.add(row)
    session.flush()
    folder = storage.folder("scans", row.id)
    folder.mkdir()
    shutil.copyfile(path, folder / row.file)
    return row.id


def add_curation(app: FastAPI, hand: GeneratedHand, account_id: uuid.UUID) -> dict[str, Any]:
    """One of everything from scan to training set; their ids, as addresses name them."""
    registration_id = add_registered(app, hand, "fed")
    made = DecisionMake(decision="accept", operation_id=uuid.uuid4())
    with app.state.database.writing() as session:
        decision, row, _ = decide(session, registration_id, account_id, made)
        chosen, _ = create_training_set(session, app.state.storage, "fed", TrainingRule(), account_id)
        scan = session.get_one(ScanRow, row.scan_id)
    return {
        "scan_id": str(scan.id),
        "key": write_geometry_key(scan.digest, 1),
        "registration_id": str(registration_id),
        "decision_id": str(decision.id),
        "training_set_id": str(chosen.id),
        "model_id": str(row.model_id),
    }


@dataclass
class Curation:
    """A studio with registered scans, and people who decide about them."""

    studio: Studio
    hand: GeneratedHand
    rob: Person
    eve: Person
    lead: Person

    def register(self, name: str, score: float = 0.1, verdict: str = "good", **columns: Any) -> uuid.UUID:
        """Lay the registered hand into the studio under a name; gives the id of the registration."""
        return add_registered(self.studio.app, self.hand, name, score, verdict, **columns)

    def decide(self, person: Person, id_: uuid.UUID | str, decision: str = "accept", **more: Any) -> Any:
        """The answer as it comes."""
        body = {"decision": decision, "operation_id": str(uuid.uuid4())} | more
        return person.send("POST", f"/registrations/{id_}/decisions", body)

    def undo(self, person: Person, decision_id: str, operation_id: str | None = None) -> Any:
        body = {"operation_id": operation_id or str(uuid.uuid4())}
        return person.send("POST", f"/decisions/{decision_id}/undo", body)

    def queue(self, person: Person, **params: Any) -> list[str]:
        """Names of the scans of a queue."""
        return [item["scan"]["name"] for item in person.get("/registrations", **params)["items"]]

    def look(self, person: Person, id_: uuid.UUID | str) -> Any:
        return person.get(f"/registrations/{id_}")


@pytest.fixture
def curation(studio: Studio, join: Callable[..., Person], generated_hand: GeneratedHand) -> Curation:
    people = join("rob", "reviewer"), join("eve", "reviewer"), join("lea", "lead")
    assert UNTRAINED_ID
    return Curation(studio, generated_hand, *people)
