"""A job is taken, done and ended once; what goes wrong is told in words, and nobody ends a job of another."""

from __future__ import annotations

import uuid

import pytest

from server.database import Database
from server.errors import InvalidError
from server.jobs import service
from server.jobs.models import JobRow
from server.jobs.progress import JobStoppedError
from server.jobs.run import MAX_CRASHES, JobRun, WorkerContext
from tests.server.jobs.test_progress import stored
from tests.server.jobs.test_service import act, claim, queue_job


@pytest.fixture
def database_kind() -> str:
    """One will do: that two processes cannot both take a job is asked of the service."""
    return "sqlite"


@pytest.fixture
def job_id(database: Database, sequence_id: uuid.UUID) -> uuid.UUID:
    return queue_job(database, sequence_id)


def log(database: Database, job_id: uuid.UUID) -> list[tuple[str, str]]:
    with database.reading() as session:
        return [(line.level, line.text) for line in service.read_log(session, job_id, 0)]


def finish(run: JobRun) -> None:
    with run.context.database.writing() as session:
        assert run.end(session, 1, "succeeded", progress=1.0)


def change(database: Database, job_id: uuid.UUID, **columns: object) -> None:
    with database.writing() as session:
        row = session.get_one(JobRow, job_id)
        for name, value in columns.items():
            setattr(row, name, value)


def test_a_job_that_is_done_says_so_and_leaves_no_working_files(context: WorkerContext, job_id: uuid.UUID) -> None:
    run = JobRun(context, job_id)
    run.files.folder.mkdir(parents=True)
    assert run.attempt(1, lambda: finish(run)) == "succeeded"
    row = stored(context.database, job_id)
    assert (row.state, row.stage, row.progress, row.seconds_left) == ("succeeded", "succeeded", 1.0, None)
    assert row.ended_at is not None and log(context.database, job_id)[-1] == ("info", "done")
    assert not run.files.folder.exists()


def test_while_it_works_the_job_is_this_workers(context: WorkerContext, job_id: uuid.UUID) -> None:
    seen: list[tuple[str, uuid.UUID | None]] = []

    def work() -> None:
        row = stored(context.database, job_id)
        seen.append((row.state, row.worker_id))

    JobRun(context, job_id).attempt(1, work)
    assert seen == [("running", context.worker_id)]


@pytest.mark.parametrize("attempt", [0, 2])
def test_an_attempt_that_is_not_the_jobs_is_not_wanted(context: WorkerContext, job_id: uuid.UUID, attempt: int) -> None:
    assert JobRun(context, job_id).attempt(attempt, lambda: pytest.fail("it must not be done")) == "not wanted"
    assert stored(context.database, job_id).state == "queued"


def test_files_that_a_dead_worker_left_of_a_job_that_succeeded_are_removed(context, job_id: uuid.UUID) -> None:
    change(context.database, job_id, state="succeeded")
    run = JobRun(context, job_id)
    run.files.folder.mkdir(parents=True)
    assert run.attempt(1, lambda: pytest.fail("it must not be done")) == "not wanted"
    assert not run.files.folder.exists()


def test_files_of_a_job_that_can_go_on_are_kept(context: WorkerContext, job_id: uuid.UUID) -> None:
    act(context.database, service.cancel_job, job_id)
    run = JobRun(context, job_id)
    run.files.folder.mkdir(parents=True)
    assert run.attempt(1, lambda: pytest.fail("it must not be done")) == "not wanted"
    assert run.files.folder.exists()


def test_what_is_known_to_be_wrong_is_told_in_its_own_words_without_the_machines_folders(context, job_id) -> None:
    run = JobRun(context, job_id)

    def work() -> None:
        raise InvalidError(f"{context.storage.root}/jobs/a.npz holds nothing.")

    assert run.attempt(1, work) == "failed"
    row = stored(context.database, job_id)
    assert (row.state, row.error) == ("failed", "jobs/a.npz holds nothing.")
    assert log(context.database, job_id)[-1] == ("error", row.error)


def test_of_what_nobody_foresaw_only_a_number_is_told_that_the_workers_log_has_too(context, job_id, caplog) -> None:
    def work() -> None:
        raise ZeroDivisionError("secret of the machine")

    assert JobRun(context, job_id).attempt(1, work) == "failed"
    error = stored(context.database, job_id).error or ""
    [record] = [one for one in caplog.records if "failed, error" in one.getMessage()]
    number = record.getMessage().rpartition(" ")[2]
    assert f"(error {number})" in error and "secret" not in error
    assert record.exc_info and record.exc_info[0] is ZeroDivisionError


def test_a_job_that_somebody_stopped_is_left_as_it_is(context: WorkerContext, job_id: uuid.UUID) -> None:
    def work() -> None:
        act(context.database, service.cancel_job, job_id)
        raise JobStoppedError

    assert JobRun(context, job_id).attempt(1, work) == "stopped"
    assert (stored(context.database, job_id).state, stored(context.database, job_id).error) == ("cancelled", None)


def test_who_fails_after_the_job_was_cancelled_changes_nothing(context: WorkerContext, job_id: uuid.UUID) -> None:
    def work() -> None:
        act(context.database, service.cancel_job, job_id)
        raise InvalidError("too late")

    assert JobRun(context, job_id).attempt(1, work) == "failed"
    row = stored(context.database, job_id)
    assert (row.state, row.error) == ("cancelled", None)
    assert ("error", "too late") not in log(context.database, job_id)


@pytest.mark.parametrize(("crashes", "outcome"), [(MAX_CRASHES - 1, "succeeded"), (MAX_CRASHES, "failed")])
def test_a_job_that_costs_one_worker_too_many_is_not_tried_again(context, job_id, crashes: int, outcome: str) -> None:
    claim(context.database, job_id, 1, uuid.uuid4())  # by a worker that died of it
    change(context.database, job_id, crashes=crashes)
    assert JobRun(context, job_id).attempt(1, lambda: None) == outcome
    error = stored(context.database, job_id).error
    if outcome == "failed":
        assert error is not None
        assert f"The worker process ended {MAX_CRASHES + 1} times while it did the same step" in error
        assert "`resume` tries once again" in error
    else:
        assert error is None


def test_a_part_is_done_by_who_does_not_hold_the_job_and_ends_it_where_it_fails(context, job_id) -> None:
    holder, done = uuid.uuid4(), []
    claim(context.database, job_id, 1, holder)
    assert JobRun(context, job_id).part(1, lambda: done.append(1)) == "succeeded" and done == [1]
    row = stored(context.database, job_id)
    assert (row.state, row.worker_id) == ("running", holder), "it stays the other's"

    def work() -> None:
        raise InvalidError("frame 3 is damaged")

    assert JobRun(context, job_id).part(1, work) == "failed"
    assert (stored(context.database, job_id).state, stored(context.database, job_id).error) == (
        *("failed", "frame 3 is damaged"),
    )


@pytest.mark.parametrize(("state", "attempt"), [("queued", 1), ("running", 2), ("cancelled", 1)])
def test_a_part_of_a_job_that_does_not_run_so_is_not_wanted(context, job_id, state: str, attempt: int) -> None:
    change(context.database, job_id, state=state)
    assert JobRun(context, job_id).part(attempt, lambda: pytest.fail("it must not be done")) == "not wanted"
