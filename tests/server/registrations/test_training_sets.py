"""Training sets below the API: which registration of a scan is chosen, the canonical list, paging and damage."""

from __future__ import annotations

import io
import json
import uuid
import zipfile
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import pytest

from server.database.database import Database
from server.errors import InvalidError, NotFoundError
from server.registrations import training_sets as service
from server.registrations.models import RegistrationRow
from server.registrations.training_set_schemas import TrainingRule
from server.scans.models import ScanRow
from server.storage import Storage
from tests.server.curation import Curation, curation, join

__all__ = ["curation", "join"]


def database(curation: Curation) -> Database:
    return curation.studio.app.state.database


def storage(curation: Curation) -> Storage:
    return curation.studio.app.state.storage


def accept(curation: Curation, *names: str, **columns: Any) -> list[uuid.UUID]:
    ids = [curation.register(name, **columns) for name in names]
    for id_ in ids:
        curation.decide(curation.rob, id_)
    return ids


def make(curation: Curation, name: str = "set", **rule: Any) -> uuid.UUID:
    with database(curation).writing() as session:
        row, _ = service.create_training_set(session, storage(curation), name, TrainingRule(**rule), None)
        return row.id


def test_registrations_are_chosen_in_the_order_of_their_scans_names(curation: Curation) -> None:
    accept(curation, "c", "a", "b")
    with database(curation).reading() as session:
        chosen = service.choose_registrations(session, TrainingRule())
        assert [one.scan.name for one in chosen] == ["a", "b", "c"]
        assert all(one.decision_id is not None for one in chosen)


def test_the_list_has_the_same_bytes_whatever_the_order_of_what_was_accepted(curation: Curation) -> None:
    accept(curation, "b", "a")
    with database(curation).reading() as session:
        chosen = service.choose_registrations(session, TrainingRule())
        digests = {one.registration.model_id: "m" * 64 for one in chosen}
        data = service.write_canonical(chosen, digests)
        assert data == service.write_canonical(chosen, dict(reversed(digests.items())))
        listed = json.loads(data)
    assert listed["version"] == 1 and [item["model_sha256"] for item in listed["registrations"]] == ["m" * 64] * 2
    assert data.endswith(b"\n") and b", " not in data


def test_members_come_by_page_each_once(curation: Curation) -> None:
    names = ["e", "d", "c", "b", "a"]
    accept(curation, *names)
    set_id = make(curation)
    with database(curation).reading() as session:
        seen, cursor = [], None
        for _ in range(5):
            items, cursor = service.list_members(session, set_id, cursor, 2)
            seen += [item.scan_name for item in items]
            if cursor is None:
                break
        assert seen == sorted(names) and cursor is None
        assert len(service.choose_members(session, set_id)) == 5


def test_sets_come_newest_first_by_page(curation: Curation) -> None:
    made = []
    for name in "abc":
        accept(curation, name)
        made.append(make(curation, name))
    with database(curation).reading() as session:
        first, cursor = service.list_training_sets(session, None, 2)
        assert [row.id for row in first] == made[:0:-1] and cursor is not None
        rest, end = service.list_training_sets(session, cursor, 2)
        assert [row.id for row in rest] == made[:1] and end is None
        described = service.describe_training_sets(session, [*first, *rest])
        assert [one.registration_count for one in described] == [3, 2, 1]
        assert {one.model_count for one in described} == {0}


def test_a_rule_that_chooses_nothing_makes_no_set_and_says_so(curation: Curation) -> None:
    with pytest.raises(InvalidError, match="Accept some on the page Curate first"):
        make(curation)
    with database(curation).reading() as session:
        assert service.list_training_sets(session, None, 10) == ([], None)
        with pytest.raises(NotFoundError, match="no training set"):
            service.get_training_set(session, uuid.uuid4())


@pytest.mark.parametrize("damage", ["changed", "gone"])
def test_a_set_whose_own_list_is_damaged_is_not_used(curation: Curation, damage: str) -> None:
    accept(curation, "a")
    set_id = make(curation)
    path: Path = storage(curation).document(service.AREA, set_id)
    if damage == "gone":
        path.unlink()
    else:
        path.write_bytes(path.read_bytes().replace(b'"version":1', b'"version":2'))
    with database(curation).reading() as session:
        row = service.get_training_set(session, set_id)
        with pytest.raises(service.DamagedSetError, match="list of the training set 'set' is damaged"):
            service.read_list(storage(curation), row)
        assert service.verify_training_set(storage(curation), row).is_intact is False
        with pytest.raises(service.DamagedSetError):
            service.list_files(storage(curation), row)


def test_a_registration_that_is_gone_is_named(curation: Curation) -> None:
    (id_, other) = accept(curation, "a", "b")
    set_id = make(curation)
    (storage(curation).folder("registrations", id_) / "registration.npz").unlink()
    with database(curation).reading() as session:
        row = service.get_training_set(session, set_id)
        assert service.verify_training_set(storage(curation), row).damaged == [id_]
        with pytest.raises(service.DamagedSetError, match=str(id_)):
            service.list_files(storage(curation), row)
    assert other != id_


def test_two_people_must_agree_where_the_rule_says_so(curation: Curation) -> None:
    (one,) = accept(curation, "a")
    (contested,) = accept(curation, "b")
    curation.decide(curation.eve, one)
    curation.decide(curation.eve, contested, "reject")
    with database(curation).reading() as session:
        chosen = service.choose_registrations(session, TrainingRule(needs_two=True))
        assert [entry.registration.id for entry in chosen] == [one]


def test_deleted_scans_and_registrations_of_an_older_crop_are_not_chosen(curation: Curation) -> None:
    kept, deleted, outdated = accept(curation, "a", "b", "c")
    with database(curation).writing() as session:
        row = session.get_one(RegistrationRow, deleted)
        session.get_one(ScanRow, row.scan_id).deleted_at = datetime.now(UTC)
        session.get_one(RegistrationRow, outdated).is_outdated = True
    with database(curation).reading() as session:
        chosen = service.choose_registrations(session, TrainingRule())
        assert [one.registration.id for one in chosen] == [kept]
        assert service.choose_registrations(session, TrainingRule(by="verdict"))[0].registration.id == kept


def test_the_preview_counts_people_left_hands_and_what_nobody_has_decided_on(curation: Curation) -> None:
    accept(curation, "a", subject="Ada")
    accept(curation, "b", subject="Ada", side="left")
    accept(curation, "c", subject="Bob", collection="other")
    curation.register("d")
    with database(curation).reading() as session:
        seen = service.preview(session, TrainingRule())
        assert (seen.registrations, seen.subjects, seen.mirrored, seen.undecided) == (3, 2, 1, 1)
        elsewhere = service.preview(session, TrainingRule(collections=["other"]))
        assert (elsewhere.registrations, elsewhere.undecided) == (1, 0)


def test_the_archive_is_not_written_when_a_file_was_changed(curation: Curation) -> None:
    (id_,) = accept(curation, "a")
    set_id = make(curation)
    with database(curation).reading() as session:
        row = service.get_training_set(session, set_id)
        whole = io.BytesIO()
        service.write_archive(storage(curation), row, whole)
        with zipfile.ZipFile(whole) as archive:
            assert set(archive.namelist()) == {"training_set.json", f"{id_}/registration.npz", "accepted.json"}
            assert archive.testzip() is None
        path = storage(curation).folder("registrations", id_) / "registration.npz"
        path.write_bytes(path.read_bytes() + b"\0")
        with pytest.raises(service.DamagedSetError, match="nothing was trained"):
            service.write_archive(storage(curation), row, io.BytesIO())
