"""Carries what the rows of jobs ask for to DBOS: a queued job into the queue, a cancelled one out of it.

The row of a job is the request for it. The studio only writes rows, in the transaction of the browser's request; so a
job that was answered with 201 is done even if the studio dies the next moment, and no job is done that was rolled back.
"""

from __future__ import annotations

import logging
from collections.abc import Mapping

from dbos import DBOS, SetWorkflowID
from sqlalchemy import or_, select, update
from sqlalchemy.orm import Session

from server.database import Database
from server.jobs import workers
from server.jobs.models import JobRow
from server.jobs.workflow import QUEUE, Workflow, workflow_id

log = logging.getLogger(__name__)


AT_ONCE = 100
"""Rows of one look: with 1,000 that waited each look of each worker read them all (68 ms; benchmarks/scale.py)."""


def find_waiting(session: Session) -> list[JobRow]:
    """The oldest jobs that are to be put into the queue or taken out of it."""
    wants_start = (JobRow.state == "queued") & (JobRow.dispatched_attempt < JobRow.attempt)
    wants_end = (JobRow.state == "cancelled") & (JobRow.dispatched_attempt > 0)
    query = select(JobRow).where(or_(wants_start, wants_end)).order_by(JobRow.created_at)
    return list(session.scalars(query.limit(AT_ONCE)))


class Dispatcher:
    """Runs in every worker; what two of them do twice is done once, since a workflow is enqueued under its id."""

    def __init__(self, database: Database, workflows: Mapping[str, Workflow]) -> None:
        self._database, self._workflows = database, workflows

    def dispatch(self) -> None:
        """Look at the rows once."""
        with self._database.reading() as session:
            jobs = find_waiting(session)
        for job in jobs:
            if job.state == "queued":
                with SetWorkflowID(workflow_id(job.id, job.attempt)):
                    DBOS.enqueue_workflow(QUEUE, self._workflows[job.kind], str(job.id), job.attempt)
                self._note(job, job.attempt)
            else:
                DBOS.cancel_workflow(workflow_id(job.id, job.dispatched_attempt), cancel_children=True)
                self._note(job, 0)

    def adopt(self) -> None:
        """Give the unfinished work of workers that are gone back to the queue."""
        with self._database.writing() as session:
            gone = workers.find_abandoned_workers(session)
            for worker in gone:
                log.warning("worker %s (pid %d) is gone; its work goes back to the queue", worker.slot, worker.pid)
                DBOS._recover_pending_workflows([worker.slot])
                worker.recovered = True

    def _note(self, job: JobRow, dispatched_attempt: int) -> None:
        with self._database.writing() as session:
            is_same = (JobRow.id == job.id) & (JobRow.attempt == job.attempt)
            session.execute(update(JobRow).where(is_same).values(dispatched_attempt=dispatched_attempt))
