"""Calibrations are checked, checked again, put away and tidied up, and a result never changes."""

from __future__ import annotations

import os
import uuid
from dataclasses import dataclass
from datetime import timedelta
from pathlib import Path

import pytest
from sqlalchemy import select
from sqlalchemy.exc import IntegrityError

from server.access.models import LOCAL_ACCOUNT_ID, AuditRow
from server.calibrations import films, service, storing
from server.calibrations.models import CalibrationRow
from server.calibrations.schemas import CalibrationCheck, CalibrationOptions
from server.database import Database, utc_now
from server.errors import ConflictError, NotFoundError
from server.storage import Storage
from server.storage.upload import Upload
from tests.server.calibrations.films import write_images
from tests.server.rows import keep

LONG_AGO = timedelta(hours=50)


@pytest.fixture
def database_kind() -> str:
    return "sqlite"


@dataclass
class Desk:
    """Where films are kept."""

    database: Database
    storage: Storage

    def films(self, cameras: str = "ab") -> uuid.UUID:
        id_ = uuid.uuid4()
        self.storage.folder(films.AREA, id_).mkdir()
        for name in cameras:
            write_images(self.storage.folder(films.AREA, id_) / name, 2)
        return id_

    def add(self, films_id: uuid.UUID, account_id: uuid.UUID = LOCAL_ACCOUNT_ID) -> CalibrationRow:
        upload = Upload(Path(), 9, 999, names=["a/0.png", "b/0.png"], byte_count=77)
        options = CalibrationOptions(fps=30.0)
        return service.add_calibration(self.database, self.storage, films_id, "Rig", options, upload, account_id)

    def again(self, id_: uuid.UUID, name: str | None = None) -> CalibrationRow:
        asked = CalibrationCheck(name=name, options=CalibrationOptions(fps=15.0))
        return service.check_again(self.database, self.storage, id_, asked, LOCAL_ACCOUNT_ID)

    def change(self, id_: uuid.UUID, **columns: object) -> None:
        with self.database.writing() as session:
            row = session.get_one(CalibrationRow, id_)
            for name, value in columns.items():
                setattr(row, name, value)

    def listed(self) -> list[uuid.UUID]:
        with self.database.reading() as session:
            return [row.id for row in service.list_calibrations(session, None, 100)[0]]

    def grow_old(self, films_id: uuid.UUID) -> None:
        moment = (utc_now() - LONG_AGO).timestamp()
        os.utime(self.storage.folder(films.AREA, films_id), (moment, moment))


@pytest.fixture
def desk(database: Database, tmp_path: Path) -> Desk:
    return Desk(database, Storage(tmp_path / "files"))


def test_films_that_are_well_are_checked_and_others_refused_with_why(desk: Desk) -> None:
    good, bad = desk.add(desk.films()), desk.add(desk.films("a"))
    assert (good.state, good.report["problems"], good.file_count, good.byte_count) == ("checked", [], 2, 77)
    assert bad.state == "refused" and "needed 2 to 16" in bad.report["problems"][0]
    assert desk.listed() == [bad.id, good.id]
    with desk.database.reading() as session:
        lines = session.scalars(select(AuditRow).where(AuditRow.act == "calibration.upload")).all()
    assert {line.subject_id for line in lines} == {good.id, bad.id}


def test_films_that_cannot_be_noted_are_not_kept(desk: Desk) -> None:
    films_id = desk.films()
    with pytest.raises(IntegrityError):
        desk.add(films_id, account_id=uuid.uuid4())
    assert films.find_films(desk.storage, films_id) is None and desk.listed() == []


def test_a_calibration_without_a_result_is_checked_again_in_its_place(desk: Desk) -> None:
    row = desk.add(desk.films())
    again = desk.again(row.id)
    assert (again.id, again.name, again.options["fps"]) == (row.id, "Rig", 15.0)
    assert again.report["cameras"][0]["fps"] == 15.0 and again.updated_at > row.updated_at
    assert desk.again(row.id, "Other rig").name == "Other rig" and desk.listed() == [row.id]


def test_a_calibration_with_a_result_stays_and_another_one_of_its_films_is_made(desk: Desk) -> None:
    row = desk.add(desk.films())
    desk.change(row.id, result={"files": []})
    again = desk.again(row.id, "Second")
    assert again.id != row.id and again.films_id == row.films_id and again.result is None
    assert (again.name, again.file_count, again.byte_count) == ("Second", 2, 77)
    with desk.database.reading() as session:
        kept = service.get_calibration(session, row.id)
    assert (kept.name, kept.options["fps"], kept.result) == ("Rig", 30.0, {"files": []})
    assert desk.listed() == [again.id, row.id]


def test_films_that_were_removed_are_asked_for_again(desk: Desk) -> None:
    row = desk.add(desk.films())
    desk.storage.remove(films.AREA, row.films_id)
    with pytest.raises(ConflictError, match=r"removed because nobody had used them for long\. Upload them again"):
        desk.again(row.id)


def test_a_deleted_calibration_is_told_from_one_that_never_was(desk: Desk) -> None:
    row, unknown = desk.add(desk.films()), uuid.uuid4()
    with desk.database.writing() as session:
        service.delete_calibration(session, session.get_one(CalibrationRow, row.id), LOCAL_ACCOUNT_ID)
        assert (
            session.scalars(select(AuditRow.act).where(AuditRow.subject_id == row.id)).all()[-1] == "calibration.delete"
        )
    with desk.database.reading() as session:
        with pytest.raises(NotFoundError, match="This camera calibration was deleted"):
            service.get_calibration(session, row.id)
        with pytest.raises(NotFoundError, match=f"There is no camera calibration {unknown}"):
            service.get_calibration(session, unknown)
    assert desk.listed() == []


def test_a_file_is_given_when_there_is_a_result_that_has_it(desk: Desk) -> None:
    row = desk.add(desk.films())
    with pytest.raises(NotFoundError, match="The cameras of “Rig” are not calibrated yet"):
        service.find_file(desk.storage, row, "cameras.toml")
    row.result = {}
    with pytest.raises(NotFoundError, match=r"“Rig” has no file colmap\.zip"):
        service.find_file(desk.storage, row, "colmap.zip")
    folder = desk.storage.folder(storing.AREA, row.id)
    folder.mkdir()
    (folder / "cameras.toml").write_text("x")
    assert service.find_file(desk.storage, row, "cameras.toml").read_text() == "x"


def test_what_nobody_touched_for_long_goes_but_a_result_and_films_in_use_stay(desk: Desk) -> None:
    stale, done, used, shared = (desk.add(desk.films()) for _ in range(4))
    twin = CalibrationRow(
        id=uuid.uuid4(), name="twin", state="checked", options={}, report={}, films_id=shared.films_id, file_count=1,
        byte_count=1,
    )  # fmt: skip
    keep(desk.database, twin)
    left = desk.films()  # of an upload that never became a calibration
    for row in (stale, done, shared):
        desk.change(row.id, updated_at=utc_now() - LONG_AGO)
    desk.change(done.id, result={})
    for films_id in (stale.films_id, done.films_id, used.films_id, shared.films_id, left):
        desk.grow_old(films_id)
    assert service.remove_abandoned(desk.database, desk.storage, 51.0) == 0
    assert service.remove_abandoned(desk.database, desk.storage, 24.0) == 3
    assert set(desk.listed()) == {done.id, used.id, twin.id}
    assert set(desk.storage.list_ids(films.AREA)) == {used.films_id, shared.films_id}
    assert service.remove_abandoned(desk.database, desk.storage, 24.0) == 0
