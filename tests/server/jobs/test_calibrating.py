"""Jobs that calibrate cameras: refused while their films, their board or another job stand in the way."""

from __future__ import annotations

import uuid
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from sqlalchemy.orm import Session

from server.access.models import LOCAL_ACCOUNT_ID
from server.calibrations.films import AREA
from server.calibrations.models import CalibrationRow
from server.calibrations.schemas import CalibrationOptions
from server.calibrations.service import GONE
from server.database import Database, utc_now
from server.jobs import service
from server.jobs.calibrating import (
    find_calibrate_obstacles,
    follow_job,
    make_calibrate_job,
    read_calibrate_options,
    read_calibration_id,
)
from server.jobs.service import CannotStartError
from server.storage import Storage


@pytest.fixture
def database_kind() -> str:
    """One will do: what is asked here are plain queries."""
    return "sqlite"


@dataclass
class Desk:
    """Where cameras are calibrated."""

    storage: Storage
    session: Session

    def film(self, **columns: Any) -> CalibrationRow:
        """A calibration whose films are there and can be used."""
        options = CalibrationOptions(max_offset_s=3.0, left_out=0.1).model_dump()
        more = {"name": "lab", "state": "checked", "options": options, "report": {"problems": []}, "result": None}
        row = CalibrationRow(films_id=uuid.uuid4(), file_count=2, byte_count=9, **(more | columns))
        self.session.add(row)
        self.session.flush()
        self.storage.folder(AREA, row.films_id).mkdir()
        return row

    def find(self, row: CalibrationRow, again: bool = False) -> list[str]:
        return find_calibrate_obstacles(self.session, self.storage, row.id, again=again)


@pytest.fixture
def desk(database: Database, tmp_path: Path) -> Iterator[Desk]:
    with database.writing() as session:
        yield Desk(Storage(tmp_path / "studio"), session)


def test_a_job_takes_the_options_that_were_checked_and_the_calibration_names_it(desk: Desk) -> None:
    row = desk.film()
    before = row.updated_at
    assert desk.find(row) == []
    job = make_calibrate_job(desk.session, desk.storage, row.id, LOCAL_ACCOUNT_ID)
    assert (job.kind, job.title, job.created_by, row.job_id) == ("calibrate", "lab", LOCAL_ACCOUNT_ID, job.id)
    assert read_calibration_id(job) == row.id and row.updated_at > before
    assert read_calibrate_options(job) == CalibrationOptions(max_offset_s=3.0, left_out=0.1)


def test_what_was_calibrated_is_not_calibrated_again(desk: Desk) -> None:
    row = desk.film(result={})
    assert desk.find(row) == desk.find(row, again=True) != []
    with pytest.raises(CannotStartError, match=r"These cameras are calibrated already\. Check them with other options"):
        make_calibrate_job(desk.session, desk.storage, row.id, LOCAL_ACCOUNT_ID)
    assert row.job_id is None


@pytest.mark.parametrize(
    ("state", "is_at_work"),
    [("queued", True), ("running", True), ("failed", False), ("cancelled", False), ("succeeded", False)],
)
def test_cameras_wait_while_a_job_is_at_work_on_them(desk: Desk, state: str, is_at_work: bool) -> None:
    row = desk.film()
    make_calibrate_job(desk.session, desk.storage, row.id, LOCAL_ACCOUNT_ID).state = state
    found = desk.find(row)
    assert ("Wait for the end of that job, or cancel it." in " ".join(found)) == is_at_work == bool(found)


def test_films_that_were_removed_are_asked_for_again(desk: Desk) -> None:
    row = desk.film()
    desk.storage.folder(AREA, row.films_id).rmdir()
    assert desk.find(row) == desk.find(row, again=True) == [GONE]


def test_what_was_wrong_with_the_films_is_told_but_keeps_no_job_from_going_on_that_was_checked(desk: Desk) -> None:
    problems = ["cam1 has no frames.", "Two cameras are needed."]
    row = desk.film(report={"problems": problems})
    assert desk.find(row) == problems and desk.find(row, again=True) == []
    with pytest.raises(CannotStartError, match=r"cam1 has no frames\. Two cameras are needed\."):
        make_calibrate_job(desk.session, desk.storage, row.id, LOCAL_ACCOUNT_ID)


def test_a_calibration_that_is_not_there_says_so(desk: Desk) -> None:
    row, unknown = desk.film(deleted_at=utc_now()), uuid.uuid4()
    assert desk.find(row) == ["This camera calibration was deleted."]
    assert find_calibrate_obstacles(desk.session, desk.storage, unknown) == [
        f"There is no camera calibration {unknown}."
    ]


def test_a_retry_is_followed_in_place_of_the_job_before(desk: Desk) -> None:
    row = desk.film()
    first = make_calibrate_job(desk.session, desk.storage, row.id, LOCAL_ACCOUNT_ID)
    second = service.create_job(desk.session, "calibrate", None, first.params)
    follow_job(desk.session, second)
    assert row.job_id == second.id
