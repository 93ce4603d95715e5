"""Hand models are kept with the digest of their file, and are not used when the file is another."""

from __future__ import annotations

import uuid
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

from server.access.models import LOCAL_ACCOUNT_ID, AuditRow
from server.database import Database
from server.errors import InvalidError, NotFoundError
from server.hand_models.models import HandModelRow
from server.hand_models.service import (
    delete_hand_model,
    describe_hand_models,
    get_hand_model,
    list_hand_models,
    restore_hand_model,
)
from server.hand_models.storing import (
    UNTRAINED_ID,
    DamagedModelError,
    add_uploaded,
    describe_model,
    find_file,
    list_built_in,
    open_model,
    read_upload,
    resolve_model,
)
from server.storage import Storage
from tracker import save_blend_model, untrained_hand


@pytest.fixture
def storage(tmp_path: Path) -> Storage:
    return Storage(tmp_path / "data")


def upload(database: Database, storage: Storage, name: str = "Ours") -> uuid.UUID:
    with database.writing() as session:
        return add_uploaded(session, storage, untrained_hand("right"), name, LOCAL_ACCOUNT_ID).id


def test_an_uploaded_model_is_opened_as_it_was_and_the_act_is_kept(database: Database, storage: Storage) -> None:
    id_ = upload(database, storage)
    with database.reading() as session:
        row = get_hand_model(session, id_)
        acts = [line.detail["sha256"] for line in session.query(AuditRow).filter_by(act="hand_model.upload")]
        [described] = describe_hand_models(session, [row])
    opened, sent = open_model(storage, row), untrained_hand("right")
    assert np.array_equal(opened.template, sent.template) and np.array_equal(opened.faces, sent.faces)
    assert acts == [row.digest]
    assert (described.name, described.kind, described.side, described.registers) == ("Ours", "uploaded", "right", True)
    assert described.vertices == len(sent.template) and described.created_by_name == "local"
    assert described.degrees_of_freedom == 3 + 3 * sent.num_bones and described.registration_count == 0


@pytest.mark.parametrize("damage", ["changed", "gone"])
def test_a_model_whose_file_is_another_is_refused_with_where_it_belongs(database, storage, damage: str) -> None:
    id_ = upload(database, storage)
    with database.reading() as session:
        row = get_hand_model(session, id_)
    path = find_file(storage, row)
    if damage == "gone":
        path.unlink()
    else:
        path.write_bytes(path.read_bytes()[:-1] + b"x")
    with pytest.raises(DamagedModelError, match=rf"Restore models/{id_}/"):
        open_model(storage, row)


def test_the_untrained_model_is_stored_when_first_used_and_once_only(database: Database, storage: Storage) -> None:
    def use(_number: int) -> uuid.UUID:
        with database.writing() as session:
            return resolve_model(session, storage, None).id

    with database.reading() as session:
        before = {model.id for model in list_built_in(session)}
    with ThreadPoolExecutor(4) as pool:
        assert set(pool.map(use, range(4))) == {UNTRAINED_ID}
    with database.reading() as session:
        assert [row.id for row in list_hand_models(session, None, 10)[0]] == [UNTRAINED_ID]
        assert {model.id for model in list_built_in(session)} == before - {UNTRAINED_ID}
        assert resolve_model(session, storage, UNTRAINED_ID).kind == "untrained"


def test_a_deleted_model_is_not_used_until_it_is_restored(database: Database, storage: Storage) -> None:
    id_ = upload(database, storage)
    with database.writing() as session:
        delete_hand_model(session, get_hand_model(session, id_))
        with pytest.raises(NotFoundError, match="was deleted"):
            resolve_model(session, storage, id_)
        assert list_hand_models(session, None, 10) == ([], None)
        restore_hand_model(session, get_hand_model(session, id_, deleted_too=True))
        assert resolve_model(session, storage, id_).id == id_
    with database.reading() as session, pytest.raises(NotFoundError, match="There is no hand model"):
        resolve_model(session, storage, uuid.uuid4())


def test_a_file_that_is_no_model_is_refused_without_the_places_of_this_machine(tmp_path: Path) -> None:
    path = tmp_path / "hand.npz"
    path.write_bytes(b"no model")
    with pytest.raises(InvalidError, match=r"hand\.npz is not a hand model") as told:
        read_upload(path, None)
    assert str(tmp_path) not in told.value.detail


def test_our_own_file_is_read_whatever_side_is_said(tmp_path: Path) -> None:
    path = tmp_path / "hand.npz"
    save_blend_model(untrained_hand("left"), path)
    for side in (None, "right", "left"):
        assert read_upload(path, side).side == "left"


def test_what_lists_tell_is_what_the_model_holds() -> None:
    model = untrained_hand("right")
    told = describe_model(model)
    assert (told["vertices"], told["faces"]) == (len(model.template), len(model.faces))
    assert told["bones"] == list(model.joint_names) and len(told["shape_parameters"]) == model.num_shape
    assert told["has_pose_shapes"] is bool(np.any(model.pose_directions))


def test_models_are_listed_the_newest_first_by_page(database: Database, storage: Storage) -> None:
    made = [upload(database, storage, f"model {number}") for number in range(3)]
    with database.reading() as session:
        first, cursor = list_hand_models(session, None, 2)
        rest, end = list_hand_models(session, cursor, 2)
        assert [row.id for row in (*first, *rest)] == made[::-1] and end is None
        assert session.get(HandModelRow, UNTRAINED_ID) is None
