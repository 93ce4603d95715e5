"""Real worker processes, killed and restarted; what they leave must not depend on it."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import time
import uuid
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from fastapi.testclient import TestClient

from server.access.models import LOCAL_ACCOUNT_ID
from server.app.app import create_app
from server.database import Database, utc_now
from server.imports.service import ImportContext, import_recording
from server.jobs import service, workers
from server.jobs.models import JobRow
from server.jobs.restarting import list_kept
from server.settings import Settings
from server.storage import Storage
from server.tracks.models import TrackRow
from tests.server.conftest import BASE_URL

ROOT = Path(__file__).resolve().parents[3]
PARAMS = {"calibrate": False, "first_iterations": 20}
TIMING = {"seconds", "stages", "stage_names"}
"""Arrays that tell how long it took; all others must be equal to the last bit."""


class Bench:
    """A studio's data with a recording in it, and workers to be started."""

    def __init__(self, settings: Settings, database: Database, recording: Path) -> None:
        self.settings, self.database = settings, database
        self.storage = Storage(settings.data_dir)
        desk = ImportContext(database, self.storage, settings)
        self.sequence_id = import_recording(desk, recording, {}, LOCAL_ACCOUNT_ID)
        self.processes: list[subprocess.Popen[bytes]] = []

    def start_worker(self) -> subprocess.Popen[bytes]:
        environment = {
            **os.environ,
            "HANDLOOM_DATA_DIR": str(self.settings.data_dir),
            "HANDLOOM_DATABASE_URL": str(self.settings.database_url),
        }
        command = [sys.executable, "-m", "server.cli", "worker"]
        process = subprocess.Popen(command, cwd=ROOT, env=environment, start_new_session=True)
        self.processes.append(process)
        return process

    def wait_for_workers(self, count: int) -> None:
        """Wait until so many are there to share the work."""
        ends = time.monotonic() + 60.0
        while time.monotonic() < ends:
            with self.database.reading() as session:
                if sum(workers.is_alive(row, utc_now()) for row in workers.list_workers(session)) == count:
                    return
            time.sleep(0.05)
        raise AssertionError("the workers do not start")

    def kill(self, process: subprocess.Popen[bytes], number: int = signal.SIGKILL) -> None:
        process.send_signal(number)
        process.wait(20)

    def queue(self, **params: object) -> uuid.UUID:
        with self.database.writing() as session:
            options = service.check_track_params(session, self.sequence_id, {**PARAMS, **params})
            return service.create_job(session, "track", self.sequence_id, options).id

    def job(self, job_id: uuid.UUID) -> JobRow:
        with self.database.reading() as session:
            return service.get_job(session, job_id)

    def log(self, job_id: uuid.UUID) -> list[str]:
        with self.database.reading() as session:
            return [line.text for line in service.read_log(session, job_id, 0)]

    def wait(self, job_id: uuid.UUID, until: Callable[[JobRow], bool], seconds: float = 120.0) -> JobRow:
        ends = time.monotonic() + seconds
        while time.monotonic() < ends:
            job = self.job(job_id)
            if until(job):
                return job
            assert job.state != "failed", (job.error, self.log(job_id))
            time.sleep(0.02)
        raise AssertionError(f"not reached: {self.job(job_id).__dict__}, {self.log(job_id)}")

    def wait_for_end(self, job_id: uuid.UUID) -> JobRow:
        return self.wait(job_id, lambda job: job.state == "succeeded")

    def arrays(self, job_id: uuid.UUID) -> dict[str, np.ndarray]:
        """Everything in the track of a job but its timing."""
        track_id = self.job(job_id).track_id
        assert track_id is not None
        found: dict[str, np.ndarray] = {}
        for file in ("track.npz", "frames.npz"):
            with np.load(self.storage.folder("tracks", track_id) / file) as arrays:
                found |= {f"{file}:{name}": arrays[name] for name in arrays.files if name not in TIMING}
        return found


@contextmanager
def open_bench(settings: Settings, database: Database, recording: Path) -> Iterator[Bench]:
    bench = Bench(settings, database, recording)
    try:
        yield bench
    finally:
        for process in bench.processes:
            if process.poll() is None:
                bench.kill(process)


@pytest.fixture
def bench_on_both(settings: Settings, database: Database, rendered: Path) -> Iterator[Bench]:
    """Once on SQLite, once on PostgreSQL."""
    with open_bench(settings, database, rendered) as opened:
        yield opened


@pytest.fixture
def bench(sqlite_settings: Settings, rendered: Path) -> Iterator[Bench]:
    with (
        closing(Database(sqlite_settings.sqlalchemy_url)) as database,
        open_bench(sqlite_settings, database, rendered) as opened,
    ):
        yield opened


def assert_same(first: dict[str, np.ndarray], second: dict[str, np.ndarray]) -> None:
    assert first.keys() == second.keys()
    for name, array in first.items():
        assert array.dtype == second[name].dtype
        assert array.tobytes() == second[name].tobytes(), f"{name} differs"


@pytest.mark.slow
@pytest.mark.parametrize("database_kind", ["sqlite", "postgresql"])
def test_a_job_whose_worker_is_killed_again_and_again_ends_with_the_same_bits(bench_on_both: Bench) -> None:
    bench = bench_on_both
    worker = bench.start_worker()
    undisturbed = bench.queue()
    bench.wait_for_end(undisturbed)
    disturbed = bench.queue()
    for frames in (0, 7, 29):  # while it starts, in the first chunk, in the second
        bench.wait(disturbed, lambda job, frames=frames: job.state == "running" and job.frames_done >= frames)
        bench.kill(worker)
        assert bench.job(disturbed).state == "running"
        worker = bench.start_worker()
    job = bench.wait_for_end(disturbed)
    assert (job.progress, job.frames_done, job.frames_total) == (1.0, 45, 45)
    assert sum("going on after the last finished step" in line for line in bench.log(disturbed)) >= 3
    assert_same(bench.arrays(undisturbed), bench.arrays(disturbed))
    ends = time.monotonic() + 5.0
    while bench.storage.folder("jobs", disturbed).exists() and time.monotonic() < ends:
        time.sleep(0.05)
    assert not bench.storage.folder("jobs", disturbed).exists(), "its working files are gone"


@pytest.mark.slow
def test_a_cancelled_job_stops_at_once_and_resumes_where_it_was_with_the_same_bits(bench: Bench) -> None:
    bench.start_worker()
    undisturbed, cancelled = bench.queue(last_frame=29), bench.queue(last_frame=29)
    bench.wait_for_end(undisturbed)
    bench.wait(cancelled, lambda job: job.frames_done >= 22)
    with bench.database.writing() as session:
        service.cancel_job(session, cancelled)
    began = time.monotonic()
    third = bench.queue(last_frame=3)
    bench.wait(third, lambda job: job.state == "running")
    assert time.monotonic() - began < 5.0, "the worker was free again soon"
    assert bench.job(cancelled).state == "cancelled"
    with bench.database.writing() as session:
        service.resume_job(session, cancelled)
    bench.wait_for_end(cancelled)
    assert sum("frames 0 to 19 tracked" in line for line in bench.log(cancelled)) <= 2
    assert_same(bench.arrays(undisturbed), bench.arrays(cancelled))


@pytest.mark.slow
@pytest.mark.parametrize("database_kind", [pytest.param("sqlite", marks=pytest.mark.slow), "postgresql"])
def test_two_workers_share_the_jobs_and_do_none_twice(bench_on_both: Bench) -> None:
    bench = bench_on_both
    first, second = bench.start_worker(), bench.start_worker()
    bench.wait_for_workers(2)
    jobs = [bench.queue(last_frame=21) for _ in range(4)]
    for job_id in jobs:
        bench.wait_for_end(job_id)
    assert len({bench.job(job_id).worker_id for job_id in jobs}) == 2
    for job_id in jobs:
        assert sum("placing the right hand" in line for line in bench.log(job_id)) == 1
        assert_same(bench.arrays(jobs[0]), bench.arrays(job_id))
    assert first.poll() is second.poll() is None


@pytest.mark.slow
def test_a_worker_that_is_stopped_leaves_its_job_to_the_other(bench: Bench) -> None:
    worker = bench.start_worker()
    job_id = bench.queue()
    bench.wait(job_id, lambda job: job.frames_done >= 5)
    bench.kill(worker, signal.SIGTERM)
    assert worker.returncode == 0
    with bench.database.reading() as session:
        assert [row.state for row in workers.list_workers(session)] == ["stopped"]
    bench.start_worker()
    job = bench.wait_for_end(job_id)
    assert job.crashes == 0


def wait_for_failure(bench: Bench, job_id: uuid.UUID) -> JobRow:
    ends = time.monotonic() + 60
    while bench.job(job_id).state != "failed" and time.monotonic() < ends:
        time.sleep(0.05)
    job = bench.job(job_id)
    assert job.state == "failed" and job.error is not None and job.ended_at is not None
    return job


def test_a_job_that_fails_says_why_in_plain_words_and_its_traceback_is_in_the_log_of_the_worker_only(
    bench: Bench, capfd: pytest.CaptureFixture[str]
) -> None:
    job_id = bench.queue()
    bench.storage.folder("jobs", job_id).write_text("a file where the job needs a folder")
    bench.start_worker()
    job = wait_for_failure(bench, job_id)
    assert job.error in bench.log(job_id)
    with TestClient(create_app(bench.settings), base_url=BASE_URL) as client:
        shown = client.get(f"/api/v1/jobs/{job_id}").text + client.get(f"/api/v1/jobs/{job_id}/log").text
    assert "unexpected error" in shown
    for never in ("Traceback", 'File "', "site-packages", ".py", str(bench.settings.data_dir), "/tmp", "Errno"):
        assert never not in shown, shown
    number = re.findall(r"error ([0-9a-f]{8})", job.error or "")
    written = capfd.readouterr().err
    assert len(number) == 1 and f"error {number[0]}" in written and "Traceback" in written, "by its number it is found"


def test_what_is_known_to_be_wrong_is_named_without_the_folders_of_the_machine(bench: Bench) -> None:
    job_id = bench.queue()
    (bench.storage.folder("sequences", bench.sequence_id) / "sequence.json").write_text("{}")
    bench.start_worker()
    job = wait_for_failure(bench, job_id)
    assert job.error is not None and "sequence.json" in job.error and job.error in bench.log(job_id)
    assert str(bench.settings.data_dir) not in job.error and "unexpected error" not in job.error
    assert str(bench.sequence_id) not in job.error, "people know the recording by its name, and the job has that"


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_progress_never_goes_back_and_a_fitted_shape_is_not_lost_with_a_cancelled_job(bench: Bench) -> None:
    """One job is cancelled, resumed, killed; then one with the same parameters takes its start over."""
    worker = bench.start_worker()
    wanted = {"calibrate": True, "last_frame": 34}
    first = bench.queue(**wanted)
    seen: list[tuple[float, int]] = []

    def watch(job_id: uuid.UUID, until: Callable[[JobRow], bool]) -> JobRow:
        def is_so(job: JobRow) -> bool:
            seen.append((job.progress, job.frames_done))
            return until(job)

        return bench.wait(job_id, is_so, 300.0)

    watch(first, lambda job: job.frames_done >= 3)
    begun = bench.job(first).progress
    assert 0.5 < begun < 0.98, "the beginning takes longer than these few frames, and the bar knows it"
    with bench.database.writing() as session:
        service.cancel_job(session, first)
        assert list_kept(bench.storage, service.get_job(session, first)) == ["the fitted shape of the hands"]
    second = bench.queue(**wanted)
    bench.wait(second, lambda job: job.frames_done >= 3)
    log = bench.log(second)
    assert any("are reused from the job that was cancelled" in line for line in log), log
    assert not any("fitting the shape" in line for line in log)
    with bench.database.writing() as session:
        service.cancel_job(session, second)
        service.resume_job(session, first)
    watch(first, lambda job: job.frames_done >= 23)
    bench.kill(worker)
    bench.start_worker()
    watch(first, lambda job: job.state == "succeeded")
    assert sum("fitting the shape (1 of 2)" in line for line in bench.log(first)) == 1
    assert all(a <= b for a, b in pairwise(seen)), "neither the bar nor the count of frames goes back"
    with bench.database.writing() as session:
        service.resume_job(session, second)
    bench.wait_for_end(second)
    assert_same(bench.arrays(first), bench.arrays(second))
    other = bench.queue(**wanted | {"iterations": 3})
    bench.wait(other, lambda job: job.stage.startswith("following"))
    assert not any("are reused" in line for line in bench.log(other)), "its parameters are others"
    with bench.database.reading() as session:
        track = session.get_one(TrackRow, bench.job(first).track_id)
    assert track.error_px is not None and 0.0 < track.error_px < 10.0, "judged as soon as it is there"


@pytest.mark.slow
def test_a_damaged_working_file_fails_the_job_instead_of_its_result(bench: Bench) -> None:
    worker = bench.start_worker()
    job_id = bench.queue()
    bench.wait(job_id, lambda job: job.frames_done >= 22)
    bench.kill(worker)
    state = bench.storage.folder("jobs", job_id) / "state-0000.npz"
    state.write_bytes(state.read_bytes()[:-9])
    bench.start_worker()
    ends = time.monotonic() + 60
    while bench.job(job_id).state not in ("failed", "succeeded") and time.monotonic() < ends:
        time.sleep(0.05)
    assert "state-0000.npz is damaged" in (bench.job(job_id).error or "")
