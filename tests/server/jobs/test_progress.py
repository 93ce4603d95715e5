"""A running job says how far it is and how long the rest takes, and stops when somebody has cancelled it."""

from __future__ import annotations

import uuid
from dataclasses import dataclass

import pytest

from server.database import Database
from server.jobs import service
from server.jobs.models import JobRow
from server.jobs.pace import Pace
from server.jobs.progress import JobProgress, JobStoppedError
from tests.server.jobs.test_service import WORKER, act, claim, queue_job

WHOLE_BAR = (0.0, 1.0)


@dataclass
class Clock:
    now: float = 100.0

    def __call__(self) -> float:
        return self.now


def stored(database: Database, job_id: uuid.UUID) -> JobRow:
    with database.reading() as session:
        row = session.get(JobRow, job_id)
        assert row is not None
        return row


def test_after_each_of_three_scans_the_page_is_told_the_time_that_those_left_will_take(database, sequence_id) -> None:
    job_id, clock = queue_job(database, sequence_id), Clock()
    claim(database, job_id, 1, WORKER)
    progress = JobProgress(database, job_id, 1, WORKER, Pace(clock))
    progress.scans(0, 3, WHOLE_BAR, "registering s0", 0.0)
    assert stored(database, job_id).seconds_left is None, "nothing is known yet"
    for done, seconds_left in ((1, 20.0), (2, 10.0), (3, 0.0)):
        clock.now += 10.0
        progress.scans_done(done, 3, WHOLE_BAR)
        row = stored(database, job_id)
        assert (row.frames_done, row.frames_total) == (done, 3)
        assert (row.progress, row.seconds_left) == (pytest.approx(done / 3), pytest.approx(seconds_left))


def test_a_job_that_was_cancelled_stops_at_its_next_word(database, sequence_id) -> None:
    job_id = queue_job(database, sequence_id)
    claim(database, job_id, 1, WORKER)
    progress = JobProgress(database, job_id, 1, WORKER, Pace(Clock()))
    act(database, service.cancel_job, job_id)
    with pytest.raises(JobStoppedError):
        progress.scans_done(1, 3, WHOLE_BAR)
    assert stored(database, job_id).frames_done == 0


def test_frames_that_several_workers_make_at_once_are_all_counted_and_a_cancelled_job_stops_each(
    database, sequence_id
) -> None:
    job_id = queue_job(database, sequence_id)
    claim(database, job_id, 1, WORKER)
    workers = [JobProgress(database, job_id, 1, None, Pace(Clock())) for _ in range(3)]
    for done in range(1, 9):
        workers[done % 3].frame_done(7, 0.1)
        row = stored(database, job_id)
        assert (row.frames_done, row.frames_total, row.worker_id) == (min(done, 7), 7, WORKER)
        assert row.progress == pytest.approx(0.1 + 0.88 * min(done, 7) / 7)
    act(database, service.cancel_job, job_id)
    for worker in workers:
        with pytest.raises(JobStoppedError):
            worker.check()
    act(database, service.resume_job, job_id)
    claim(database, job_id, 2, WORKER)
    with pytest.raises(JobStoppedError):
        workers[0].frame_done(7, 0.1)
