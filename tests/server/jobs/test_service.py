"""Jobs change state once, whoever asks and however often."""

from __future__ import annotations

import uuid
from concurrent.futures import ThreadPoolExecutor

import pytest

from server.database import Database
from server.jobs import service
from server.jobs.models import JobRow

WORKER, OTHER = uuid.uuid4(), uuid.uuid4()


def queue_job(database: Database, sequence_id: uuid.UUID) -> uuid.UUID:
    with database.writing() as session:
        return service.create_job(session, "track", sequence_id, {"iterations": 5}).id


def claim(database: Database, job_id: uuid.UUID, attempt: int, worker: uuid.UUID) -> bool:
    with database.writing() as session:
        return service.claim_job(session, job_id, attempt, worker) is not None


def act(database: Database, function, job_id: uuid.UUID, *arguments: str) -> JobRow:
    with database.writing() as session:
        return function(session, job_id, *arguments)


def publish(database: Database, job_id: uuid.UUID, attempt: int, worker: uuid.UUID) -> bool:
    with database.writing() as session:
        return service.update_running(session, job_id, attempt, worker, frames_done=7)


def test_a_running_job_is_only_changed_by_the_worker_that_holds_it(database, sequence_id) -> None:
    job_id = queue_job(database, sequence_id)
    assert not publish(database, job_id, 1, WORKER), "it does not run yet"
    assert claim(database, job_id, 1, WORKER)
    assert publish(database, job_id, 1, WORKER)
    assert not publish(database, job_id, 1, OTHER)
    assert claim(database, job_id, 1, OTHER), "DBOS gave it to another worker"
    assert not publish(database, job_id, 1, WORKER)
    assert publish(database, job_id, 1, OTHER)


def test_a_cancelled_job_lets_nobody_publish_or_claim_it(database, sequence_id) -> None:
    job_id = queue_job(database, sequence_id)
    claim(database, job_id, 1, WORKER)
    assert act(database, service.cancel_job, job_id).state == "cancelled"
    assert not publish(database, job_id, 1, WORKER)
    assert not claim(database, job_id, 1, WORKER)
    assert act(database, service.cancel_job, job_id).state == "cancelled", "twice does no harm"


def test_resuming_begins_a_new_attempt_that_the_old_one_cannot_disturb(database, sequence_id) -> None:
    job_id = queue_job(database, sequence_id)
    claim(database, job_id, 1, WORKER)
    act(database, service.cancel_job, job_id)
    job = act(database, service.resume_job, job_id)
    assert (job.state, job.attempt, job.ended_at) == ("queued", 2, None)
    assert not claim(database, job_id, 1, WORKER)
    assert claim(database, job_id, 2, WORKER)
    assert not publish(database, job_id, 1, WORKER)


def test_only_what_makes_sense_can_be_done_in_a_state(database, sequence_id) -> None:
    job_id = queue_job(database, sequence_id)
    for refused in (service.resume_job, service.retry_job):
        with pytest.raises(service.JobStateError):
            act(database, refused, job_id)
    act(database, service.cancel_job, job_id)
    again = act(database, service.retry_job, job_id)
    assert (again.state, again.retry_of, again.params) == ("queued", job_id, {"iterations": 5})


def test_of_many_who_resume_at_once_one_succeeds(database, sequence_id) -> None:
    job_id = queue_job(database, sequence_id)
    act(database, service.cancel_job, job_id)

    def resume(_: int) -> bool:
        try:
            act(database, service.resume_job, job_id)
        except service.JobStateError:
            return False
        return True

    with ThreadPoolExecutor(6) as pool:
        assert sum(pool.map(resume, range(6))) == 1
    with database.reading() as session:
        assert service.get_job(session, job_id).attempt == 2


def test_workers_who_log_about_one_job_at_once_number_its_lines_without_a_gap(database, sequence_id) -> None:
    job_id = queue_job(database, sequence_id)
    with ThreadPoolExecutor(6) as pool:
        list(pool.map(lambda line: act(database, service.append_log, job_id, "info", f"line {line}"), range(60)))
    with database.reading() as session:
        lines = service.read_log(session, job_id, 0)
    assert [line.number for line in lines] == list(range(1, 62))
    assert {line.text for line in lines} == {"queued"} | {f"line {line}" for line in range(60)}


def test_crashes_count_until_a_chunk_is_done(database, sequence_id) -> None:
    job_id = queue_job(database, sequence_id)
    for expected in (0, 1, 2):
        claim(database, job_id, 1, uuid.uuid4())
        with database.reading() as session:
            assert service.get_job(session, job_id).crashes == expected


def test_every_change_raises_the_version_and_the_log_is_numbered_without_gaps(database, sequence_id) -> None:
    job_id = queue_job(database, sequence_id)
    with database.reading() as session:
        before = service.get_job(session, job_id).version
    claim(database, job_id, 1, WORKER)
    claim(database, job_id, 1, OTHER)
    act(database, service.cancel_job, job_id)
    with database.reading() as session:
        assert service.get_job(session, job_id).version == before + 3
        lines = service.read_log(session, job_id, 0)
        assert [line.number for line in lines] == list(range(1, len(lines) + 1))
        assert [line.number for line in service.read_log(session, job_id, 1)] == [line.number for line in lines][1:]
        assert lines[-1].text == "cancelled"


def test_jobs_are_listed_in_pages_newest_first_and_none_twice(database, sequence_id) -> None:
    ids = [queue_job(database, sequence_id) for _ in range(7)]
    seen, cursor = [], None
    with database.reading() as session:
        while True:
            rows, cursor = service.list_jobs(session, service.JobFilter(sequence_id, ["queued"]), cursor, 3)
            seen += [row.id for row in rows]
            if cursor is None:
                break
        assert service.list_jobs(session, service.JobFilter(states=["failed"]), None, 3) == ([], None)
    assert seen == ids[::-1]
