"""Frames among the working files of a job: behind a seam they are as it made them, and a damaged one is left out."""

from __future__ import annotations

import pytest

from server.jobs import service
from server.jobs.moving_frames import MovingFrames
from server.jobs.moving_run import MovingRun
from server.jobs.progress import JobStoppedError
from server.jobs.run import WorkerContext
from server.moving_scans.adding import AREA
from tests.server.jobs.moving_bench import open_run
from tests.server.jobs.test_moving_run import log
from tests.server.jobs.test_progress import stored
from tests.server.jobs.test_service import act
from tracker import TrackerError


@pytest.fixture
def database_kind() -> str:
    """One will do: what is asked here are plain queries."""
    return "sqlite"


@pytest.fixture
def run(context: WorkerContext) -> MovingRun:
    return open_run(context)


def seal(run: MovingRun, step: str) -> None:
    """As if a step had written a folder."""
    folder = run.files.folder / step
    folder.mkdir(parents=True)
    (folder / "body.npz").write_bytes(step.encode())
    run.files.write_manifest(step, [folder], {})


def test_a_frame_is_as_its_chunk_made_it_until_a_seam_changes_it(run: MovingRun) -> None:
    frames = MovingFrames(run, 1)
    assert frames.find(3) is None and frames.load(3) is None
    seal(run, "frame-000003")
    assert frames.find(3) == run.files.folder / "frame-000003" and frames.find(4) is None
    seal(run, "joined-000003")
    assert frames.find(3) == run.files.folder / "joined-000003"


def test_a_frame_whose_file_was_damaged_is_as_it_was_before(run: MovingRun) -> None:
    for step in ("frame-000003", "joined-000003"):
        seal(run, step)
    (run.files.folder / "joined-000003/body.npz").write_bytes(b"x")
    assert MovingFrames(run, 1).find(3) == run.files.folder / "frame-000003"


def test_a_frame_that_cannot_be_registered_is_told_without_the_machines_folders_and_counted(run: MovingRun) -> None:
    frames = MovingFrames(run, 1, 0.1)
    frames.leave_out(5, TrackerError(f"{run.context.storage.root}/{AREA}/x/000005.ply: no person is in it"))
    told = log(run.context.database, run.job_id)[-1]
    assert told == ("warning", f"frame 5: {AREA}/x/000005.ply: no person is in it")
    row = stored(run.context.database, run.job_id)
    assert (row.frames_done, row.frames_total) == (1, run.total) and 0.1 < row.progress < 1.0


def test_who_is_to_stop_learns_of_it_at_the_next_frame(run: MovingRun) -> None:
    frames = MovingFrames(run, 1)
    act(run.context.database, service.cancel_job, run.job_id)
    with pytest.raises(JobStoppedError):
        frames.leave_out(5, TrackerError("no person is in it"))


def test_a_frame_that_is_not_there_cannot_be_read(run: MovingRun) -> None:
    with pytest.raises((TrackerError, OSError)):
        MovingFrames(run, 1).read(2)


def test_what_another_job_made_is_not_found(run: MovingRun, context: WorkerContext) -> None:
    seal(run, "frame-000003")
    other = open_run(context)
    assert other.job_id != run.job_id and MovingFrames(other, 1).find(3) is None
