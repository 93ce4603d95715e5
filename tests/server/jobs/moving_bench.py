"""A job that registers the moving scan of `Bench`, without files of its frames."""

from __future__ import annotations

from typing import Any

from server.access.models import LOCAL_ACCOUNT_ID
from server.jobs import service
from server.jobs.moving_run import MovingRun
from server.jobs.moving_schemas import RegisterMovingCreate
from server.jobs.run import WorkerContext
from tests.server.moving_scans.bench import FRAMES, Bench


def open_run(context: WorkerContext, damaged: tuple[int, ...] = (), goes_on: bool = False, **asked: Any) -> MovingRun:
    """The job, running in this worker; where it goes on from another, from the first one there is."""
    with context.database.writing() as session:
        bench = Bench(session)
        for frame in damaged:
            bench.damage(frame)
        parent = {"parent_id": bench.registrations[0].id} if goes_on else {}
        wanted = {"moving_scan_id": bench.scan.id, "last_frame": FRAMES - 1} | parent | asked
        params = RegisterMovingCreate.model_validate(wanted).model_dump(mode="json")
        job = service.create_job(
            session, "register_moving", None, params, created_by=LOCAL_ACCOUNT_ID, moving_scan_id=bench.scan.id
        )
        service.claim_job(session, job.id, 1, context.worker_id)
        job_id = job.id
    return MovingRun(context, job_id)
