"""Accepted frames become the model of their person, which the next registration begins with."""

from __future__ import annotations

import uuid

import numpy as np
import pytest
from sqlalchemy import select

from server.access.models import AuditRow
from server.moving_scans import person_models
from server.moving_scans.models import FrameRegistrationRow
from server.moving_scans.storing import AREA, name_frame, store_frame
from tests.server.moving_scans.curated import Curated, curated
from tests.server.moving_scans.moving import API, MovingPerson, moving_person
from tests.server.moving_scans.people import keep, lay, person
from tests.server.teams.conftest import join
from tracker import load_mano
from tracker.bodies import body_model

__all__ = ["curated", "join", "moving_person"]


@pytest.mark.slow
def test_the_model_is_the_person_at_rest_is_made_once_and_loads_elsewhere(
    curated: Curated, moving_person: MovingPerson, tmp_path
) -> None:
    ada, other = person(0.5), person(-0.5)
    first, second = (lay(curated, moving_person, model, range(3)) for model in (ada, other))
    curated.decide(curated.rob, first, "accept", 0, 2)
    one = keep(curated, "Ada's frames")
    curated.decide(curated.rob, second, "accept", 1, 2)
    two = keep(curated, "two people's")
    assert curated.ann.send("POST", f"/body-sets/{one['id']}/model").status_code == 403
    made = curated.rob.send("POST", f"/body-sets/{one['id']}/model")
    again = curated.rob.send("POST", f"/body-sets/{one['id']}/model")
    assert (made.status_code, again.status_code) == (201, 200) and made.json() == again.json()
    told = made.json()
    assert (told["name"], told["frame_count"], told["population"]) == ("Ada's frames", 3, "female")
    for kind in ("npz", "pkl"):
        path = tmp_path / f"SMPLH.{kind}"
        path.write_bytes(curated.studio.client.get(f"{API}/person-models/{told['id']}/smplh.{kind}").content)
        loaded = load_mano(path)
        np.testing.assert_allclose(loaded.template, ada.template, atol=1e-9)
        np.testing.assert_allclose(loaded.shape_directions, body_model("female").shape_directions, atol=1e-9)
    mixed = curated.rob.send("POST", f"/body-sets/{two['id']}/model").json()
    path.write_bytes(curated.studio.client.get(f"{API}/person-models/{mixed['id']}/smplh.pkl").content)
    np.testing.assert_allclose(load_mano(path).template, other.template, atol=1e-9)
    missing = curated.rob.send("POST", f"/body-sets/{first}/model")
    assert missing.status_code == 404 and "no set of accepted frames" in missing.text
    assert curated.studio.client.get(f"{API}/person-models/{first}/smplh.npz").status_code == 404
    with curated.studio.database.reading() as session:
        assert len(list(session.scalars(select(AuditRow.act).where(AuditRow.act == "person_model.make")))) == 2


@pytest.mark.slow
def test_of_many_frames_some_that_are_spread_over_all_make_the_model_and_a_damaged_one_makes_none(
    curated: Curated, moving_person: MovingPerson, monkeypatch
) -> None:
    registration = lay(curated, moving_person, person(0.5), range(3))
    curated.decide(curated.rob, registration, "accept", 0, 2)
    kept = keep(curated, "frames")
    monkeypatch.setattr(person_models, "MOST_FRAMES", 2)
    damaged = curated.studio.settings.data_dir / AREA / str(name_frame(uuid.UUID(registration), 2)) / "body.npz"
    whole = damaged.read_bytes()
    damaged.write_bytes(b"other")
    refused = curated.rob.send("POST", f"/body-sets/{kept['id']}/model")
    assert refused.status_code == 409 and "Frame 2 of “frames” was changed" in refused.text
    damaged.write_bytes(whole)
    assert curated.rob.send("POST", f"/body-sets/{kept['id']}/model").json()["frame_count"] == 2


def test_a_frame_is_stored_once_and_stays_as_it_was(curated: Curated, moving_person: MovingPerson) -> None:
    registration = uuid.UUID(lay(curated, moving_person, person(0.5), range(2)))
    storage = curated.studio.app.state.storage
    with curated.studio.database.reading() as session:
        before = session.get_one(FrameRegistrationRow, name_frame(registration, 0))
    store_frame(curated.studio.database, storage, (registration, 0), storage.root / "made-1")
    with curated.studio.database.reading() as session:
        after = session.get_one(FrameRegistrationRow, name_frame(registration, 0))
    assert (after.digest, after.created_at) == (before.digest, before.created_at)
