"""Jobs that register moving scans: what keeps one from being started, and what it is settled to do."""

from __future__ import annotations

import uuid
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from server.access.models import LOCAL_ACCOUNT_ID
from server.database import Database, utc_now
from server.jobs import service
from server.jobs.moving import find_moving_obstacles, make_moving_job, read_moving
from server.jobs.moving_schemas import RegisterMovingCreate
from server.jobs.service import CannotStartError
from server.moving_scans.models import MovingRegistrationRow
from server.moving_scans.storing import TEMPLATE, TEMPLATES
from server.storage import Storage
from tests.server.moving_scans.bench import Bench


@pytest.fixture
def database_kind() -> str:
    """One will do: what is asked here are plain queries."""
    return "sqlite"


@pytest.fixture
def storage(tmp_path: Path) -> Storage:
    return Storage(tmp_path / "studio")


@pytest.fixture
def bench(database: Database) -> Iterator[Bench]:
    with database.writing() as session:
        yield Bench(session)


def ask(bench: Bench, **asked: Any) -> RegisterMovingCreate:
    return RegisterMovingCreate.model_validate({"moving_scan_id": bench.scan.id} | asked)


def find(bench: Bench, storage: Storage, **asked: Any) -> str:
    """The only obstacle, or nothing."""
    return "".join(find_moving_obstacles(bench.session, storage, ask(bench, **asked)))


def go_on_from(bench: Bench, storage: Storage) -> MovingRegistrationRow:
    """A registration with its model of the person."""
    row = bench.registrations[0]
    folder = storage.folder(TEMPLATES, row.template_id)
    folder.mkdir()
    (folder / TEMPLATE).write_bytes(b"x")
    return row


@pytest.mark.parametrize("asked", [{}, {"first_frame": 7}, {"first_frame": 2, "last_frame": 2}, {"last_frame": 7}])
def test_frames_that_are_there_can_be_registered(bench: Bench, storage: Storage, asked: dict[str, int]) -> None:
    assert find(bench, storage, **asked) == ""


@pytest.mark.parametrize(
    ("asked", "told"),
    [
        ({"last_frame": 8}, "“Ada waves” has no frame 8; it has 0 to 7."),
        ({"first_frame": 5, "last_frame": 4}, "The first frame, 5, is after the last one, 4."),
        ({"first_frame": 8}, "The first frame, 8, is after the last one, 7."),
    ],
)
def test_frames_that_are_not_there_are_told_with_those_that_are(bench: Bench, storage, asked, told: str) -> None:
    assert find(bench, storage, **asked) == told


def test_one_frame_that_can_be_used_is_enough(bench: Bench, storage: Storage) -> None:
    for frame in (2, 3):
        bench.damage(frame)
    told = "None of the frames 2 to 3 of “Ada waves” can be used. Choose others."
    assert find(bench, storage, first_frame=2, last_frame=3) == told
    assert find(bench, storage, first_frame=2, last_frame=4) == ""


def test_what_is_not_there_is_named(bench: Bench, storage: Storage) -> None:
    unknown = uuid.uuid4()
    assert f"{unknown} does not exist" in find(bench, storage, moving_scan_id=unknown)
    assert f"There is no registration {unknown}" in find(bench, storage, parent_id=unknown)
    assert str(unknown) in find(bench, storage, person_model_id=unknown)
    bench.scan.deleted_at = utc_now()
    assert "was deleted; it can be restored from the bin" in find(bench, storage)


def test_a_registration_can_be_gone_on_from_once_it_has_a_model_and_its_job_has_ended(bench: Bench, storage) -> None:
    parent = bench.registrations[0]
    assert "has no model of the person yet" in find(bench, storage, parent_id=parent.id)
    go_on_from(bench, storage)
    job = service.create_job(bench.session, "register_moving", None, {})
    parent.job_id = job.id
    for state, may in (("queued", False), ("running", False), ("failed", True), ("cancelled", True)):
        job.state = state
        assert ("is still being made" in find(bench, storage, parent_id=parent.id)) != may


def test_a_registration_of_another_moving_scan_is_not_gone_on_from(bench: Bench, storage: Storage) -> None:
    parent = go_on_from(Bench(bench.session), storage)
    told = f"The registration {parent.id} is of another moving scan than “Ada waves”."
    assert find(bench, storage, parent_id=parent.id) == told


def test_a_job_is_settled_when_it_is_made_and_says_what_it_does(bench: Bench, storage: Storage) -> None:
    job = make_moving_job(bench.session, storage, ask(bench, prior="none"), LOCAL_ACCOUNT_ID)
    assert (job.kind, job.title, job.moving_scan_id) == ("register_moving", "Ada waves, no prior", bench.scan.id)
    assert (read_moving(job).first_frame, read_moving(job).last_frame, read_moving(job).prior) == (0, 7, "none")
    part = make_moving_job(bench.session, storage, ask(bench, first_frame=2, prior="gaussian"), LOCAL_ACCOUNT_ID)
    assert part.title == "Ada waves, frames 2 to 7, Gaussian prior"


def test_what_goes_on_from_another_has_its_population_and_names_its_number(bench: Bench, storage: Storage) -> None:
    parent = go_on_from(bench, storage)
    parent.population = "female"
    job = make_moving_job(bench.session, storage, ask(bench, parent_id=parent.id, last_frame=3), LOCAL_ACCOUNT_ID)
    assert read_moving(job).population == "female"
    assert job.title.startswith("Ada waves, frames 0 to 3, on from registration ")
    assert job.title.endswith(", mixture prior")


def test_what_cannot_be_done_makes_no_job(bench: Bench, storage: Storage) -> None:
    with pytest.raises(CannotStartError, match="has no frame 8"):
        make_moving_job(bench.session, storage, ask(bench, last_frame=8), LOCAL_ACCOUNT_ID)
    assert service.list_jobs(bench.session, service.JobFilter(), None, 9) == ([], None)
