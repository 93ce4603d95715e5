"""Jobs with the names their rows point to: of the recording, of who started them and of the worker that has them."""

from __future__ import annotations

import uuid

import pytest

from server.access.models import Account
from server.database import Database
from server.jobs.describe import describe_job, describe_jobs
from server.jobs.models import JobRow, WorkerRow
from server.jobs.service import KINDS, create_job


@pytest.fixture
def database_kind() -> str:
    """One will do: what is asked here are plain queries."""
    return "sqlite"


def test_a_job_about_a_recording_has_its_name_and_any_other_its_own_title(database: Database, sequence_id) -> None:
    with database.writing() as session:
        rows = [
            create_job(session, "track", sequence_id, {}, title="not told"),
            create_job(session, "register", None, {}, title="3 scans of Lab"),
        ]
        assert [job.title for job in describe_jobs(session, rows)] == ["wave", "3 scans of Lab"]
        assert describe_jobs(session, []) == []


@pytest.mark.parametrize("kind", KINDS)
def test_a_job_counts_what_its_kind_goes_through(database: Database, kind: str) -> None:
    units = {"track": "frames", "detect": "frames", "register_moving": "frames", "calibrate": "cameras"}
    with database.writing() as session:
        assert describe_job(session, create_job(session, kind, None, {})).unit == units.get(kind, "scans")


def test_who_started_a_job_and_which_worker_has_it_are_named(database: Database, sequence_id) -> None:
    with database.writing() as session:
        ann = Account(id=uuid.uuid4(), name="ann", role="annotator")
        worker = WorkerRow(slot="brave-otter", pid=7, host="lab-2")
        session.add_all([ann, worker])
        session.flush()
        held = create_job(session, "track", sequence_id, {}, created_by=ann.id)
        held.worker_id = worker.id
        gone, free = (create_job(session, "track", sequence_id, {}) for _ in range(2))
        gone.worker_id = uuid.uuid4()
        session.flush()
        first, second, third = describe_jobs(session, [held, gone, free])
    assert first.created_by_name == "ann" and first.worker is not None
    assert (first.worker.id, first.worker.name, first.worker.host) == (worker.id, "brave-otter", "lab-2")
    assert (second.worker, second.created_by_name, third.worker) == (None, None, None)


def test_jobs_come_in_the_order_they_were_given(database: Database, sequence_id) -> None:
    with database.writing() as session:
        rows: list[JobRow] = [create_job(session, "track", sequence_id, {}) for _ in range(4)]
        order = [rows[place] for place in (2, 0, 3, 1)]
        assert [job.id for job in describe_jobs(session, order)] == [row.id for row in order]
