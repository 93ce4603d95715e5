"""A job on a moving scan cut into chunks: what each takes, what is noted once, and what is told at its end."""

from __future__ import annotations

import uuid
from typing import Any

import pytest
from sqlalchemy import func, select

from server.database import Database
from server.jobs import service
from server.jobs.moving_run import MovingRun, name_template_step
from server.jobs.run import WorkerContext
from server.moving_scans.models import FrameRegistrationRow, MovingRegistrationRow
from server.moving_scans.storing import name_frame
from tests.server.jobs.moving_bench import open_run
from tests.server.jobs.test_progress import stored


@pytest.fixture
def database_kind() -> str:
    """One will do: what is asked here are plain queries."""
    return "sqlite"


def read(run: MovingRun) -> MovingRegistrationRow:
    with run.context.database.reading() as session:
        return session.get_one(MovingRegistrationRow, run.registration_id)


def log(database: Database, job_id: uuid.UUID) -> list[tuple[str, str]]:
    with database.reading() as session:
        return [(line.level, line.text) for line in service.read_log(session, job_id, 0)]


def store(run: MovingRun, verdicts: dict[int, str]) -> None:
    more: dict[str, Any] = {"reasons": [], "scan_to_mesh_mm": {}, "has_left": True, "has_right": True, "seconds": 1.0}
    with run.context.database.writing() as session:
        for frame, verdict in verdicts.items():
            id_ = name_frame(run.registration_id, frame)
            about = {"registration_id": run.registration_id, "frame": frame, "digest": "0" * 64, "verdict": verdict}
            session.add(FrameRegistrationRow(id=id_, **about, **more))


@pytest.mark.parametrize("chunk_frames", [0, 1, 3, 8, 50])
def test_every_usable_frame_is_in_one_chunk_and_they_follow_each_other(context: WorkerContext, chunk_frames) -> None:
    run = open_run(context, damaged=(0, 4), chunk_frames=chunk_frames)
    assert [frame for chunk in run.chunks for frame in chunk] == [1, 2, 3, 5, 6, 7]
    assert run.total == 6 and run.asked_count == 8 and all(run.chunks)


def test_a_chunk_of_which_no_frame_can_be_used_is_none(context: WorkerContext) -> None:
    run = open_run(context, damaged=(3, 4, 5), chunk_frames=3)
    assert [list(chunk) for chunk in run.chunks] == [[0, 1, 2], [6, 7]]


def test_the_persons_model_is_made_of_usable_frames_that_were_asked_for(context: WorkerContext) -> None:
    run = open_run(context, damaged=(2,), first_frame=1, template_frames=3)
    assert 0 < len(run.template) <= 3 and set(run.template) <= {1, 3, 4, 5, 6, 7}
    assert len({name_template_step(frame) for frame in run.template}) == len(run.template)


def test_who_goes_on_from_another_makes_no_model_of_the_person(context: WorkerContext) -> None:
    run = open_run(context, goes_on=True)
    assert run.template == [] and run.load_template_frame(0) is None
    run.plan()
    row = read(run)
    assert row.parent_id == run.asked.parent_id == row.template_id


def test_a_registration_is_noted_once_under_an_id_that_follows_from_its_job(context: WorkerContext) -> None:
    run = open_run(context, first_frame=2, prior="none", holds_hands=False, population="male")
    for _ in range(2):
        run.plan()
    again = MovingRun(context, run.job_id)
    row = read(again)
    assert (row.job_id, row.template_id, row.first_frame, row.last_frame) == (run.job_id, row.id, 2, 7)
    assert (row.prior, row.holds_hands, row.has_velocity, row.population) == ("none", False, True, "male")
    with context.database.reading() as session:
        of_job = select(func.count()).where(MovingRegistrationRow.job_id == run.job_id)
        assert session.scalar(of_job) == 1


def test_a_job_ends_with_how_its_frames_came_out_and_which_were_left_out(context: WorkerContext) -> None:
    run = open_run(context, damaged=(0,))
    run.plan()
    store(run, {1: "good", 2: "good", 3: "doubtful", 5: "bad", 6: "good"})
    run.finish(1)
    row = stored(context.database, run.job_id)
    assert (row.state, row.progress, row.frames_done, row.frames_total) == ("succeeded", 1.0, 7, 7)
    told = [("info", "7 frames: 3 good, 1 doubtful, 1 bad, 2 not registered")]
    told += [("warning", "1 frame left out, whose file cannot be used")]
    assert log(context.database, run.job_id)[-3:] == [*told, ("info", "done")]


def test_what_did_not_happen_is_not_told(context: WorkerContext) -> None:
    run = open_run(context, first_frame=6)
    run.plan()
    store(run, {6: "good", 7: "good"})
    run.finish(1)
    assert log(context.database, run.job_id)[-2:] == [("info", "2 frames: 2 good"), ("info", "done")]
