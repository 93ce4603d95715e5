"""People of known shape in a curated moving scan, and sets of their accepted frames."""

from __future__ import annotations

import uuid
from dataclasses import replace
from typing import Any

import numpy as np

from server.access.models import LOCAL_ACCOUNT_ID
from server.moving_scans.models import MovingRegistrationRow
from server.moving_scans.storing import TEMPLATE, TEMPLATES, store_frame, write_frame
from tests.server.conftest import Studio
from tests.server.moving_scans.curated import Curated
from tests.server.moving_scans.moving import MovingPerson
from tracker import BlendModel, save_blend_model
from tracker.bodies import BodyRegistration, body_model
from tracker.bodies.body_state import hand_space, make_state
from tracker.capture.scan import read_scan


def person(size: float) -> BlendModel:
    """Somebody of known shape."""
    model = body_model()
    shaped = model.shaped(size * np.ones(model.num_shape))
    return replace(model, template=shaped, shape_directions=np.zeros((len(shaped), 3, 0)))


def lay(curated: Curated, moving: MovingPerson, model: BlendModel, frames: range) -> str:
    """A registration in which a person of known shape takes a pose of its own in every frame."""
    studio: Studio = curated.studio
    storage, id_ = studio.app.state.storage, uuid.uuid4()
    row = MovingRegistrationRow(
        id=id_,
        moving_scan_id=uuid.UUID(curated.scan_id),
        job_id=uuid.uuid4(),
        template_id=id_,
        prior="mixture",
        holds_hands=True,
        has_velocity=True,
        population="female",
        first_frame=frames[0],
        last_frame=frames[-1],
        created_by=LOCAL_ACCOUNT_ID,
    )
    with studio.database.writing() as session:
        session.add(row)
    storage.folder(TEMPLATES, id_).mkdir(parents=True)
    save_blend_model(model, storage.folder(TEMPLATES, id_) / TEMPLATE)
    rng = np.random.default_rng(4)
    for frame in frames:
        scan = read_scan(moving.folder / f"frame{frame}.ply")
        hands = 0.3 * rng.standard_normal((2, 6))
        state = make_state(model, hand_space(model, 6), 0.3 * rng.standard_normal((22, 3)), hands)
        state = replace(state, shape=np.zeros(0), translation=rng.standard_normal(3))
        vertices = state.posed(model).vertices
        found = BodyRegistration(vertices, vertices, state, (True, True), np.zeros(len(scan.points)), "good", ())
        made = storage.root / f"made-{frame}"
        write_frame(made, found, model, (scan, "0" * 64))
        store_frame(studio.database, storage, (id_, frame), made)
    return str(id_)


def keep(curated: Curated, name: str) -> dict[str, Any]:
    answer = curated.rob.send("POST", "/body-sets", {"moving_scan_id": curated.scan_id, "name": name})
    assert answer.status_code == 201, answer.text
    return answer.json()
