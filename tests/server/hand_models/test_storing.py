"""Stored models: written once, given out only as they were, hidden and brought back, listed newest first."""

from __future__ import annotations

import uuid
from pathlib import Path

import pytest

from server.database.database import Database
from server.errors import InvalidError, NotFoundError
from server.hand_models import service, storing
from server.hand_models.models import HandModelRow
from server.storage import Storage
from tests.server.curation import Curation, curation, join
from tracker import save_blend_model, untrained_hand
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


def test_the_untrained_hand_is_stored_once_when_it_is_first_used(curation: Curation) -> None:
    with database(curation).writing() as session:
        first = storing.resolve_model(session, storage(curation), None)
        again = storing.resolve_model(session, storage(curation), storing.UNTRAINED_ID)
        assert (first.id, first.kind, again) == (storing.UNTRAINED_ID, "untrained", first)
        listed = [model.id for model in storing.list_built_in(session)]
        assert storing.UNTRAINED_ID not in listed, "a row stands for it now"
    stored = storing.open_model(storage(curation), first)
    assert stored.template == pytest.approx(untrained_hand("right").template, abs=1e-12)


@pytest.mark.parametrize("damage", ["changed", "gone"])
def test_a_model_whose_file_is_not_what_it_was_is_not_given_out(curation: Curation, damage: str) -> None:
    id_ = add(curation, "mine")
    path = storage(curation).folder(service.AREA, id_) / service.FILE
    if damage == "gone":
        path.unlink()
    else:
        path.write_bytes(path.read_bytes() + b"\0")
    with database(curation).reading() as session:
        row = service.get_hand_model(session, id_)
        with pytest.raises(storing.DamagedModelError, match=f"'mine' is gone or not what it was.*{id_}"):
            storing.find_file(storage(curation), row)


def test_a_deleted_model_is_hidden_until_it_is_brought_back(curation: Curation) -> None:
    id_ = add(curation)
    with database(curation).writing() as session:
        service.delete_hand_model(session, service.get_hand_model(session, id_))
        with pytest.raises(NotFoundError, match="was deleted"):
            service.get_hand_model(session, id_)
        assert id_ not in [row.id for row in service.list_hand_models(session, None, 100)[0]]
        service.restore_hand_model(session, service.get_hand_model(session, id_, deleted_too=True))
        assert service.get_hand_model(session, id_).id == id_
        with pytest.raises(NotFoundError, match="There is no hand model"):
            service.get_hand_model(session, uuid.uuid4())


def test_models_come_newest_first_by_page_each_once(curation: Curation) -> None:
    made = [add(curation, name) for name in "abc"]
    with database(curation).reading() as session:
        seen: list[uuid.UUID] = []
        cursor: str | None = None
        for _ in range(20):
            rows, cursor = service.list_hand_models(session, cursor, 2)
            seen += [row.id for row in rows]
            if cursor is None:
                break
        assert [id_ for id_ in seen if id_ in made] == made[::-1] and len(seen) == len(set(seen))


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


def test_what_is_no_hand_is_refused_with_both_readings_and_no_path(tmp_path: Path) -> None:
    path = tmp_path / "hand.npz"
    path.write_bytes(b"nothing")
    both = "hand.npz is no hand model. Read as Handloom's own: .* Read as MANO's: "
    with pytest.raises(InvalidError, match=both) as refused:
        storing.read_upload(path, None)
    assert str(tmp_path) not in str(refused.value)
    save_blend_model(trained_hand("left"), path)
    assert storing.read_upload(path, None).side == "left"
