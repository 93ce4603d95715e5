"""A studio's data with scans in it, and workers to be started."""

from __future__ import annotations

import time
import uuid
from collections.abc import Callable, Iterator
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest
from fastapi import FastAPI
from sqlalchemy import select

from server.access.models import LOCAL_ACCOUNT_ID
from server.database import Database
from server.hand_models.models import HandModelRow
from server.jobs import service
from server.jobs.models import JobRow
from server.registrations.models import RegistrationRow
from server.settings import Settings
from server.storage import Storage
from tests.server.jobs.test_worker import Bench


class ScanBench(Bench):
    """As `Bench`, without a recording."""

    def __init__(self, settings: Settings, database: Database) -> None:
        self.settings, self.database = settings, database
        self.storage = Storage(settings.data_dir)
        self.processes = []
        self.app = FastAPI()
        self.app.state.storage, self.app.state.database = self.storage, database

    def make(self, maker: Callable[..., JobRow], asked: Any) -> uuid.UUID:
        with self.database.writing() as session:
            return maker(session, self.storage, asked, LOCAL_ACCOUNT_ID).id

    def cancel(self, job_id: uuid.UUID) -> None:
        with self.database.writing() as session:
            service.cancel_job(session, job_id)

    def resume(self, job_id: uuid.UUID) -> None:
        with self.database.writing() as session:
            service.resume_job(session, job_id)

    def registrations(self, job_id: uuid.UUID) -> list[RegistrationRow]:
        with self.database.reading() as session:
            return list(session.scalars(select(RegistrationRow).where(RegistrationRow.job_id == job_id)))

    def models(self, job_id: uuid.UUID) -> list[HandModelRow]:
        """Trained by a job, in their order."""
        with self.database.reading() as session:
            query = select(HandModelRow).where(HandModelRow.job_id == job_id).order_by(HandModelRow.created_at)
            return list(session.scalars(query))

    def wait_for_file(self, job_id: uuid.UUID, name: str, seconds: float = 90.0) -> Path:
        """Wait until a running job has written a working file."""
        path = self.storage.folder("jobs", job_id) / name
        ends = time.monotonic() + seconds
        while not path.exists():
            job = self.job(job_id)
            assert job.state in ("queued", "running"), (job.state, job.error, self.log(job_id))
            assert time.monotonic() < ends, self.log(job_id)
            time.sleep(0.005)
        return path


@pytest.fixture
def bench(sqlite_settings: Settings) -> Iterator[ScanBench]:
    with closing(Database(sqlite_settings.sqlalchemy_url)) as database:
        opened = ScanBench(sqlite_settings, database)
        yield opened
        for process in opened.processes:
            if process.poll() is None:
                opened.kill(process)
