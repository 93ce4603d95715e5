"""Several machines: one PostgreSQL, one S3-compatible store, and a data folder and workers of its own on each."""

from __future__ import annotations

import os
import subprocess
import sys
import time
import uuid
from collections.abc import Iterator
from contextlib import closing, contextmanager
from datetime import timedelta
from pathlib import Path

import numpy as np
import pytest
from fastapi.testclient import TestClient
from sqlalchemy import select

from server.access.models import LOCAL_ACCOUNT_ID
from server.app import create_app
from server.compute import Compute
from server.database import Database
from server.imports.service import ImportContext, import_recording
from server.jobs import workers
from server.jobs.models import JobRow, WorkerRow
from server.jobs.moving import make_moving_job
from server.jobs.moving_schemas import RegisterMovingCreate
from server.moving_scans.adding import add_moving_scan
from server.moving_scans.models import FrameRegistrationRow
from server.moving_scans.schemas import MovingScanOptions
from server.moving_scans.storing import AREA, BODY
from server.settings import Settings
from server.storage import open_storage
from server.storage.digest import compute_digest
from tests.server.conftest import BASE_URL, S3, _make_postgres_database
from tests.server.jobs.test_worker import PARAMS, TIMING
from tests.server.moving_scans.moving import MovingPerson, moving_person

__all__ = ["moving_person"]

ROOT = Path(__file__).resolve().parents[3]
API = "/api/v1"


class Machine:
    """A data folder of its own, and what runs on it."""

    def __init__(self, name: str, folder: Path, database_url: str, s3: S3) -> None:
        self.name = name
        self.settings = Settings(
            data_dir=folder / name,
            database_url=database_url,
            store_url="s3://studio/files",
            store_endpoint=s3.endpoint,
            worker_host=name,
        )
        self.database = Database(self.settings.sqlalchemy_url)
        self.storage = open_storage(self.settings)
        self.environment = {
            **os.environ,
            "HANDLOOM_DATA_DIR": str(self.settings.data_dir),
            "HANDLOOM_DATABASE_URL": database_url,
            "HANDLOOM_STORE_URL": "s3://studio/files",
            "HANDLOOM_STORE_ENDPOINT": s3.endpoint,
            "HANDLOOM_WORKER_HOST": name,
        }

    @contextmanager
    def worker(self) -> Iterator[subprocess.Popen[bytes]]:
        command = [sys.executable, "-m", "server.cli", "worker"]
        process = subprocess.Popen(command, cwd=ROOT, env=self.environment, start_new_session=True)
        try:
            yield process
        finally:
            process.kill()
            process.wait(20)

    def wait(self, job_id: uuid.UUID, frames: int | None = None, seconds: float = 120.0) -> JobRow:
        """Until the job has ended, or so many frames are done."""
        ends = time.monotonic() + seconds
        while time.monotonic() < ends:
            with self.database.reading() as session:
                job = session.get_one(JobRow, job_id)
            assert job.state != "failed", job.error
            if job.state == "succeeded" or (frames is not None and job.frames_done >= frames):
                return job
            time.sleep(0.02)
        raise AssertionError(f"not reached: {job.state}, {job.stage}, {job.frames_done} frames")

    def arrays(self, track_id: uuid.UUID | None) -> dict[str, bytes]:
        """Everything in a track but its timing, as it is read on this machine."""
        assert track_id is not None
        found: dict[str, bytes] = {}
        for file in ("track.npz", "frames.npz"):
            with np.load(self.storage.folder("tracks", track_id) / file) as arrays:
                found |= {f"{file}:{name}": arrays[name].tobytes() for name in arrays.files if name not in TIMING}
        return found


@pytest.fixture
def machines(postgres_url: str, postgres_template: str, s3: S3, tmp_path: Path) -> Iterator[list[Machine]]:
    with _make_postgres_database(postgres_url, postgres_template) as url:
        made = [Machine(name, tmp_path, url, s3) for name in ("ada", "bert", "carl")]
        yield made
        for machine in made:
            machine.database.close()


@pytest.mark.slow
def test_a_worker_that_dies_for_good_is_noticed_and_another_machine_ends_its_job_with_the_same_bits(
    machines: list[Machine], rendered: Path
) -> None:
    web, second, third = machines
    desk = ImportContext(web.database, web.storage, web.settings)
    sequence_id = import_recording(desk, rendered, {}, LOCAL_ACCOUNT_ID)
    app = create_app(web.settings)
    with closing(web.database), TestClient(app, base_url=BASE_URL) as client:

        def queue() -> uuid.UUID:
            body = {"sequence_id": str(sequence_id), "params": {**PARAMS, "last_frame": 29}}
            return uuid.UUID(client.post(f"{API}/jobs", json=body).json()["id"])

        with second.worker() as worker:
            undisturbed = queue()
            done = web.wait(undisturbed)
            assert client.get(f"{API}/jobs/{undisturbed}").json()["worker"]["host"] == "bert"
            # Imported here, tracked there, read here.
            assert client.get(f"{API}/tracks/{done.track_id}/frames").json()["frame"] == list(range(30))
            assert client.get(f"{API}/tracks/{done.track_id}/files/track.npz").status_code == 200

            disturbed = queue()
            web.wait(disturbed, frames=22)  # in the second chunk
            worker.kill()
            worker.wait(20)
        with third.worker():
            _pass_time(web, "bert")
            ended = web.wait(disturbed)
            working_files = web.storage.remote_folder("jobs", disturbed)
            while working_files.read_document("start") is not None:  # they go last; the timeout of tests ends this
                time.sleep(0.05)
        with web.database.reading() as session:
            assert session.get_one(WorkerRow, ended.worker_id).host == "carl"
        told = {item["host"]: item["state"] for item in client.get(f"{API}/workers").json()["items"]}
        assert told["bert"] == "lost"
        lines = [line["text"] for line in client.get(f"{API}/jobs/{disturbed}/log").json()["lines"]]
        assert "its worker crashed; going on after the last finished step" in lines
        assert lines.count("placing the right hand") == 1, "the third machine began where the second had been"
        assert web.arrays(done.track_id) == web.arrays(ended.track_id) == third.arrays(ended.track_id)


@pytest.mark.slow
def test_two_machines_share_the_chunks_of_a_moving_scan_and_a_third_reads_its_frames(
    machines: list[Machine], moving_person: MovingPerson, tmp_path: Path
) -> None:
    web, second, third = machines
    folder = tmp_path / "walking"
    folder.mkdir()
    for name, data in moving_person.files.items():
        (folder / name).write_bytes(data)
    compute = Compute(web.settings, web.database, web.storage)
    account = LOCAL_ACCOUNT_ID
    row, _ = add_moving_scan(web.database, web.storage, compute, folder, "moving", MovingScanOptions(), account)
    compute.close()
    with second.worker(), third.worker():
        time.sleep(10.0)  # both are there before the chunks are
        with web.database.writing() as session:
            asked = RegisterMovingCreate(moving_scan_id=row.id, template_frames=1, chunk_frames=2)
            job_id = make_moving_job(session, web.storage, asked, account).id
        web.wait(job_id, seconds=300.0)
        time.sleep(1.0)  # the working files go last
    left = [list(machine.storage.folder("jobs", job_id).glob("frame-*.json")) for machine in (second, third)]
    assert sorted(map(len, left))[0] == 0 < sorted(map(len, left))[1] < 3, "of the one that does not hold the job"
    with web.database.reading() as session:
        frames = list(session.scalars(select(FrameRegistrationRow).order_by(FrameRegistrationRow.frame)))
    assert [frame.frame for frame in frames] == [0, 1, 2]
    for frame in frames:
        assert compute_digest(web.storage.folder(AREA, frame.id) / BODY) == frame.digest


def _pass_time(machine: Machine, host: str) -> None:
    """Have the worker of a host been silent for as long as the others wait."""
    with machine.database.writing() as session:
        for row in session.query(WorkerRow).where(WorkerRow.host == host):
            row.last_seen_at -= workers.LOST_AFTER + timedelta(seconds=1)
