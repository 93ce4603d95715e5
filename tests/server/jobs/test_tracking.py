"""A tracking job goes on where it was: what a step has kept is not done again, and the track is written once."""

from __future__ import annotations

import json
import uuid
from pathlib import Path
from typing import Any

import pytest

from server.database import Database
from server.jobs import service
from server.jobs.files import JobFiles
from server.jobs.pace import Pace
from server.jobs.progress import TRACKING_ENDS, JobProgress
from server.jobs.service import DETECTOR, HAND_MODEL
from server.jobs.tracking import TrackingJob
from tests.server.jobs.test_progress import stored
from tests.server.jobs.test_service import WORKER, claim, queue_job
from tracker import TrackOptions


@pytest.fixture
def database_kind() -> str:
    """One will do: how a job is taken is asked of the service."""
    return "sqlite"


@pytest.fixture
def files(tmp_path: Path) -> JobFiles:
    return JobFiles(tmp_path / "job")


def make_job(files: JobFiles, params: dict[str, Any] | None = None, **more: Any) -> TrackingJob:
    """Of a recording that is not there: nothing may be read of it."""
    return TrackingJob(files.folder / "no recording", params or {}, files, "x", **more)


@pytest.fixture
def progress(database: Database, sequence_id: uuid.UUID) -> JobProgress:
    job_id = queue_job(database, sequence_id)
    claim(database, job_id, 1, WORKER)
    made = JobProgress(database, job_id, 1, WORKER, Pace())
    made.job_id = job_id  # type: ignore[attr-defined]
    return made


def log(database: Database, job_id: uuid.UUID) -> list[str]:
    with database.reading() as session:
        return [line.text for line in service.read_log(session, job_id, 0)]


BEGUN = {"first": 10, "frames": 45, "chunks": [[10, 30], [30, 50], [50, 55]], "begins": 0.2, "key": "k"}


def test_options_are_the_trackers_without_what_the_studio_adds(files: JobFiles) -> None:
    wanted = TrackOptions(iterations=7, calibrate=False)
    params = wanted.to_json() | {HAND_MODEL: str(uuid.uuid4()), DETECTOR: ""}
    assert make_job(files, params).options == wanted
    assert make_job(files).options == TrackOptions()


def test_without_a_chosen_hand_the_tracker_takes_its_own(files: JobFiles) -> None:
    assert make_job(files).load_hands() is None and make_job(files, {HAND_MODEL: ""}).load_hands() is None


def test_a_start_that_is_kept_is_given_again_and_nothing_is_looked_at(files: JobFiles, progress) -> None:
    files.write(files.state(0), lambda path: path.write_bytes(b"state"))
    kept = files.write_manifest("start", [files.state(0)], BEGUN)
    assert make_job(files).start(progress) == kept


def test_a_chunk_that_is_kept_is_counted_and_not_tracked_again(files, progress, database: Database) -> None:
    files.write(files.chunk(1), lambda path: path.write_bytes(b"chunk"))
    kept = files.write_manifest("chunk-0001", [files.chunk(1)], {})
    assert make_job(files).track_chunk(BEGUN, 1, progress) == kept
    row = stored(database, progress.job_id)
    assert (row.frames_done, row.frames_total) == (40, 45)
    assert row.progress == pytest.approx(0.2 + (TRACKING_ENDS - 0.2) * 40 / 45)
    assert log(database, progress.job_id)[-1] == "frames 30 to 49 tracked"


def test_the_bar_of_a_job_from_before_its_beginning_was_recorded_begins_at_a_tenth(files, progress, database) -> None:
    files.write(files.chunk(0), lambda path: path.write_bytes(b"chunk"))
    files.write_manifest("chunk-0000", [files.chunk(0)], {})
    old = {name: value for name, value in BEGUN.items() if name != "begins"}
    make_job(files).track_chunk(old, 0, progress)
    assert stored(database, progress.job_id).progress == pytest.approx(0.1 + (TRACKING_ENDS - 0.1) * 20 / 45)


def test_a_track_that_was_written_before_a_crash_stays_as_it_is(files, progress, tmp_path: Path, database) -> None:
    destination = tmp_path / "track"
    destination.mkdir()
    (destination / "summary.json").write_text(json.dumps({"frames": 45}))
    make_job(files).finish(BEGUN, destination, progress)
    assert [path.name for path in destination.iterdir()] == ["summary.json"]
    assert stored(database, progress.job_id).stage == "writing the track"
