"""Whether a worker of this machine was heard of lately: the health check of worker containers."""

import sys

from sqlalchemy import select

from server.database import Database
from server.jobs.models import WorkerRow
from server.jobs.workers import find_database_time, find_own_host, is_alive
from server.settings import Settings

settings = Settings()
with Database(settings.sqlalchemy_url).reading() as session:
    now = find_database_time(session)
    rows = session.scalars(select(WorkerRow).where(WorkerRow.host == find_own_host(settings.worker_host))).all()
sys.exit(not any(is_alive(row, now) for row in rows))
