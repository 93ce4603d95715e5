"""The DBOS workflows of jobs, by kind. Only the worker process imports this: DBOS takes a second to load."""

from __future__ import annotations

from collections.abc import Callable
from uuid import UUID

from server.jobs.calibrate_workflow import register_calibrate_workflow
from server.jobs.detect_workflow import register_detect_workflow
from server.jobs.moving_workflow import register_moving_workflow
from server.jobs.run import WorkerContext
from server.jobs.scan_workflow import register_scan_workflows
from server.jobs.track_workflow import register_track_workflow

QUEUE = "jobs"
APPLICATION = "handloom"
APPLICATION_VERSION = "5"
"""Of the steps and their files. A job begun under one version is only continued by workers of that version."""

Workflow = Callable[[str, int], str]
"""Takes the id of a job and its attempt."""


def workflow_id(job_id: UUID, attempt: int) -> str:
    """Name of the workflow that does one attempt of a job."""
    return f"{job_id}:{attempt}"


def register_workflows(context: WorkerContext) -> dict[str, Workflow]:
    """Make the workflow of each kind of job known to DBOS, before it is launched."""
    return {
        "track": register_track_workflow(context),
        "detect": register_detect_workflow(context),
        "calibrate": register_calibrate_workflow(context),
        "register_moving": register_moving_workflow(context),
        **register_scan_workflows(context),
    }
