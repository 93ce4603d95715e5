"""The workflow of a job that registers a moving scan: a step for each frame."""

from __future__ import annotations

from typing import Any
from uuid import UUID

from dbos import DBOS

from server.jobs.moving_run import FollowerCache, MovingRun
from server.jobs.run import WorkerContext


def register_moving_workflow(context: WorkerContext):
    """Make the workflow `register_moving` known to DBOS."""
    cache = FollowerCache(context)

    def open_run(job_id: str) -> MovingRun:
        return MovingRun(context, UUID(job_id), cache)

    @DBOS.step(name="plan moving scan")
    def plan(job_id: str) -> dict[str, Any]:
        return open_run(job_id).plan()

    @DBOS.step(name="register template frame")
    def register_template_frame(job_id: str, attempt: int, planned: dict[str, Any], number: int) -> None:
        open_run(job_id).register_template_frame(attempt, planned, number)

    @DBOS.step(name="make template")
    def make_template(job_id: str, planned: dict[str, Any]) -> None:
        open_run(job_id).make_template(planned)

    @DBOS.step(name="register frame")
    def register_frame(job_id: str, attempt: int, planned: dict[str, Any], number: int) -> str:
        return open_run(job_id).register_frame(attempt, planned, number)

    @DBOS.step(name="finish moving scan")
    def finish(job_id: str, attempt: int, planned: dict[str, Any], outcomes: list[str]) -> str:
        open_run(job_id).finish(attempt, planned, outcomes)
        return "done"

    @DBOS.workflow(name="register_moving", max_recovery_attempts=1000)
    def register_moving(job_id: str, attempt: int) -> str:
        run = open_run(job_id)

        def work() -> None:
            planned = plan(job_id)
            for number in range(len(planned["template"])):
                register_template_frame(job_id, attempt, planned, number)
            if planned["template"]:
                make_template(job_id, planned)
            outcomes = [register_frame(job_id, attempt, planned, number) for number in range(len(planned["frames"]))]
            finish(job_id, attempt, planned, outcomes)

        return run.attempt(attempt, work)

    return register_moving
