"""A stored model is described with what was made by it."""

from __future__ import annotations

import uuid

from server.database.database import Database
from server.hand_models import service, storing
from server.hand_models.models import HandModelRow
from server.storage import Storage
from tests.server.curation import Curation, curation, join
from tracker.model.trained_hand import trained_hand

__all__ = ["curation", "join"]


def database(curation: Curation) -> Database:
    return curation.studio.app.state.database


def storage(curation: Curation) -> Storage:
    return curation.studio.app.state.storage


def add(curation: Curation, name: str = "hand") -> uuid.UUID:
    with database(curation).writing() as session:
        return storing.add_uploaded(
            session, storage(curation), trained_hand("right"), name, uuid.UUID(curation.rob.id)
        ).id


def test_a_model_is_described_with_what_was_made_by_it_and_by_whom(curation: Curation) -> None:
    id_ = add(curation)
    registration = curation.register("a")
    with database(curation).reading() as session:
        row = service.get_hand_model(session, id_)
        (described,) = service.describe_hand_models(session, [row])
        assert (described.registration_count, described.kind, described.has_pose_shapes) == (0, "uploaded", True)
        assert described.shape_parameters[0] == "shape 1" and described.degrees_of_freedom == 51
        others = service.describe_hand_models(session, session.query(HandModelRow).all())
        assert sum(one.registration_count for one in others) == 1 and registration
