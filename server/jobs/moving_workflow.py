"""The workflow of a job that registers a moving scan, and that of a chunk of it, which any worker may do."""

from __future__ import annotations

from uuid import UUID

from dbos import DBOS, SetWorkflowID, WorkflowHandle, error

from server.errors import StudioError
from server.jobs.moving_run import MovingRun
from server.jobs.progress import JobStoppedError
from server.jobs.run import WorkerContext

CHUNK_QUEUE = "chunks"
"""Of their own: a job that waits for its chunks keeps no place from them, so one worker alone does both."""

MAX_RESTARTS = 10
"""Of a chunk: after crashes, but also when workers are stopped in the midst of it."""


def register_moving_workflow(context: WorkerContext):
    """Make the workflows `register_moving` and `register_moving_chunk` known to DBOS."""

    @DBOS.workflow(name="register_moving_chunk", max_recovery_attempts=MAX_RESTARTS)
    def register_chunk(job_id: str, attempt: int, number: int) -> str:
        run = MovingRun(context, UUID(job_id))
        return run.part(attempt, lambda: DBOS.run_step({"name": "chunk"}, run.register_chunk, attempt, number))

    @DBOS.workflow(name="register_moving", max_recovery_attempts=1000)
    def register_moving(job_id: str, attempt: int) -> str:
        run = MovingRun(context, UUID(job_id))

        def begin_chunk(number: int) -> WorkflowHandle[str]:
            with SetWorkflowID(f"{job_id}:{attempt}:chunk-{number}"):
                return DBOS.enqueue_workflow(CHUNK_QUEUE, register_chunk, job_id, attempt, number)

        def work() -> None:
            DBOS.run_step({"name": "plan"}, run.plan)
            for number in range(len(run.template)):
                DBOS.run_step({"name": "template frame"}, run.register_template_frame, attempt, number)
            if run.template:
                DBOS.run_step({"name": "template"}, run.make_template)
            handles = [begin_chunk(number) for number in range(len(run.chunks))]
            for number, handle in enumerate(handles):
                _wait(handle)
                DBOS.run_step({"name": "join chunk"}, run.join_chunk, attempt, number)
            DBOS.run_step({"name": "finish"}, run.finish, attempt)

        return run.attempt(attempt, work)

    return register_moving


def _wait(chunk: WorkflowHandle[str]) -> None:
    """Until a chunk is done; ends as its job does where it is not."""
    try:
        outcome = chunk.get_result(polling_interval_sec=0.25)
    except error.DBOSAwaitedWorkflowCancelledError:
        raise JobStoppedError("The job was cancelled.") from None
    except error.DBOSAwaitedWorkflowMaxRecoveryAttemptsExceeded:
        raise StudioError(
            f"Workers ended {MAX_RESTARTS + 1} times while they did the same chunk of frames, by a crash or for want "
            "of memory. The log of the worker says more; `resume` tries once again."
        ) from None
    if outcome != "succeeded":
        raise JobStoppedError("The job ended with one of its chunks.")
