"""A moving scan with two registrations, and people who decide about them."""

from __future__ import annotations

import shutil
import uuid
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest
from scipy.spatial import KDTree

from server.access.models import LOCAL_ACCOUNT_ID
from server.moving_scans.models import MovingRegistrationRow
from server.moving_scans.storing import TEMPLATE, TEMPLATES, store_frame, write_frame
from tests.server.conftest import Studio
from tests.server.moving_scans.moving import MovingPerson, add, moving_person
from tests.server.teams.conftest import Join, Person, join
from tracker import save_blend_model
from tracker.bodies.body_registration import BodyRegistration
from tracker.bodies.body_state import hand_space, make_state
from tracker.capture.scan import read_scan
from tracker.model.body_model import body_model

__all__ = ["join", "moving_person"]


@dataclass
class Curated:
    """A moving scan in a studio, two registrations of it, and people."""

    studio: Studio
    scan_id: str
    first: str
    second: str
    rob: Person
    ann: Person

    def decide(self, who: Person, registration: str, decision: str, first: int, last: int, **more: Any) -> Any:
        body = {"decision": decision, "first_frame": first, "last_frame": last, "operation_id": str(uuid.uuid4())}
        return who.send("POST", f"/moving-registrations/{registration}/decisions", body | more)

    def undo(self, who: Person, decision: dict[str, Any]) -> Any:
        return who.send("POST", f"/stretch-decisions/{decision['id']}/undo", {"operation_id": str(uuid.uuid4())})

    def accepted(self) -> list[tuple[int, int, int, str]]:
        told = self.ann.get(f"/moving-scans/{self.scan_id}/accepted")
        return [
            (each["first_frame"], each["last_frame"], each["registration_number"], each["accepted_by_name"])
            for each in told["stretches"]
        ]

    def frames(self, registration: str) -> list[dict[str, Any]]:
        return self.ann.get(f"/moving-registrations/{registration}/frames")["frames"]


def lay(studio: Studio, scan_id: str, person: MovingPerson, prior: str, first: int, parent: str | None) -> str:
    """A registration whose surfaces are the true ones."""
    storage, model = studio.app.state.storage, body_model()
    row = MovingRegistrationRow(
        id=(id_ := uuid.uuid4()),
        moving_scan_id=uuid.UUID(scan_id),
        job_id=uuid.uuid4(),
        parent_id=None if parent is None else uuid.UUID(parent),
        template_id=id_ if parent is None else uuid.UUID(parent),
        prior=prior,
        holds_hands=True,
        has_velocity=True,
        population="neutral",
        first_frame=first,
        last_frame=2,
        created_by=LOCAL_ACCOUNT_ID,
    )
    with studio.database.writing() as session:
        session.add(row)
    if parent is None:
        storage.folder(TEMPLATES, id_).mkdir(parents=True)
        save_blend_model(model, storage.folder(TEMPLATES, id_) / TEMPLATE)
    space = hand_space(model)
    for frame in range(first, 3):
        body, scan = person.bodies[frame], read_scan(person.folder / f"frame{frame}.ply")
        state = make_state(model, space, body.pose)
        found = BodyRegistration(
            body.true_vertices,
            body.true_vertices,
            replace(state, shape=np.zeros(0), translation=np.array([0.0, 0.1 * frame, 0.0])),
            (body.shows_hand["left"], body.shows_hand["right"]),
            KDTree(body.true_vertices).query(scan.points)[0],
            "good" if frame else "doubtful",
            (),
        )
        with studio.database.reading() as session:
            from server.moving_scans.service import get_moving_scan

            digest = get_moving_scan(session, row.moving_scan_id).frames[frame]["digest"]
        made = storage.root / "frame-as-made"
        write_frame(made, found, model, (scan, digest))
        store_frame(studio.database, storage, (id_, frame), made)
        shutil.rmtree(made)
    return str(id_)


@pytest.fixture
def curated(studio: Studio, moving_person: MovingPerson, join: Join) -> Curated:
    scan_id = add(studio, moving_person.files, name="Ada waves", subject="Ada", fps=30)["id"]
    first = lay(studio, scan_id, moving_person, "mixture", 0, None)
    second = lay(studio, scan_id, moving_person, "none", 1, first)
    return Curated(studio, scan_id, first, second, join("rob", "reviewer"), join("ann"))
