"""Jobs on scans: what they are to do is settled when they are made, with the scans in their order."""

from __future__ import annotations

import uuid
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from sqlalchemy.orm import Session

from server.access.models import LOCAL_ACCOUNT_ID
from server.database import Database
from server.hand_models.storing import UNTRAINED_ID, UNTRAINED_NAME
from server.jobs import service
from server.jobs.create_jobs import (
    copy_job_scans,
    list_job_scans,
    make_loop_job,
    make_register_job,
    make_train_job,
)
from server.jobs.loop_schemas import LoopCreate
from server.jobs.models import JobRow
from server.jobs.register_schemas import RegisterCreate
from server.jobs.service import CannotStartError
from server.jobs.train_schemas import TrainCreate
from server.registrations.training_set_schemas import TrainingRule
from server.storage import Storage
from tests.server.registrations.test_service import Bench


@pytest.fixture
def database_kind() -> str:
    """One will do: what is asked here are plain queries."""
    return "sqlite"


@dataclass
class Desk:
    """Where jobs on scans are made."""

    storage: Storage
    session: Session

    def register(self, **asked: Any) -> JobRow:
        return make_register_job(self.session, self.storage, RegisterCreate(**asked), LOCAL_ACCOUNT_ID)

    def count_jobs(self) -> int:
        return len(service.list_jobs(self.session, service.JobFilter(), None, 100)[0])


@pytest.fixture
def bench(database: Database) -> Bench:
    return Bench(database)


@pytest.fixture
def scans(bench: Bench) -> dict[str, uuid.UUID]:
    """Two of a lab and one of somebody's home, by name."""
    return {name: bench.scan(name, collection="Home" if name == "c" else "Lab") for name in "bca"}


@pytest.fixture
def desk(database: Database, tmp_path: Path) -> Iterator[Desk]:
    with database.writing() as session:
        yield Desk(Storage(tmp_path / "studio"), session)


def test_a_job_registers_the_scans_by_name_and_says_how_many_with_which_model(scans, desk: Desk) -> None:
    job = desk.register()
    assert (job.kind, job.state, job.title) == ("register", "queued", f"3 scans with {UNTRAINED_NAME}")
    assert job.params == {"model_id": str(UNTRAINED_ID), "model": UNTRAINED_NAME, "only": "new"}
    assert list_job_scans(desk.session, job.id) == [scans[name] for name in "abc"]
    assert job.created_by == LOCAL_ACCOUNT_ID
    home = desk.register(collection="Home", only="all")
    assert (home.title, home.params["only"]) == (f"1 scan of Home with {UNTRAINED_NAME}", "all")


def test_a_retry_has_the_scans_of_the_job_that_it_retries_in_their_order(scans, desk: Desk) -> None:
    first = desk.register(collection="Lab")
    again = service.create_job(desk.session, "register", None, first.params)
    assert list_job_scans(desk.session, again.id) == []
    copy_job_scans(desk.session, first.id, again.id)
    assert list_job_scans(desk.session, again.id) == [scans["a"], scans["b"]]
    assert list_job_scans(desk.session, first.id) == [scans["a"], scans["b"]]


def test_a_job_without_scans_is_copied_without_any(desk: Desk) -> None:
    first, again = (service.create_job(desk.session, "train", None, {}) for _ in range(2))
    copy_job_scans(desk.session, first.id, again.id)
    assert list_job_scans(desk.session, again.id) == []


def test_what_cannot_be_done_is_refused_and_makes_no_job(desk: Desk) -> None:
    with pytest.raises(CannotStartError, match="There is no scan of Nowhere to register"):
        desk.register(collection="Nowhere")
    rule = TrainingRule(by="verdict")
    with pytest.raises(CannotStartError, match="There are 0 registrations of 0 people; a model needs 20"):
        make_train_job(desk.session, desk.storage, TrainCreate(name="hand", rule=rule), LOCAL_ACCOUNT_ID)
    with pytest.raises(CannotStartError, match=r"There are no scans in Nowhere\. Add some"):
        make_loop_job(desk.session, desk.storage, LoopCreate(name="hand", collection="Nowhere"), LOCAL_ACCOUNT_ID)
    assert desk.count_jobs() == 0


def test_a_loop_goes_over_its_collection_and_says_how_often(bench: Bench, database: Database, tmp_path: Path) -> None:
    ids = [bench.scan(f"s{number:02d}", collection="Big", subject=f"S{number % 2}") for number in range(20)]
    bench.scan("elsewhere")
    with database.writing() as session:
        asked = LoopCreate(name="Our hand", collection="Big", rounds=2)
        job = make_loop_job(session, Storage(tmp_path / "studio"), asked, LOCAL_ACCOUNT_ID)
        assert (job.kind, job.title) == ("loop", "Our hand: 2 rounds over 20 scans")
        assert (job.params["model_id"], job.params["by"], job.params["rounds"]) == (str(UNTRAINED_ID), "verdict", 2)
        assert list_job_scans(session, job.id) == ids
