"""The workflows of jobs that register scans and train hand models: a step for each scan, training and evaluation."""

from __future__ import annotations

from collections.abc import Callable
from uuid import UUID

from dbos import DBOS

from server.jobs.evaluating import evaluate_model
from server.jobs.run import WorkerContext
from server.jobs.scan_run import ModelCache, ScanRun, Span


def register_scan_workflows(context: WorkerContext) -> dict[str, Callable[[str, int], str]]:
    """Make the workflows `register`, `train` and `loop` known to DBOS."""
    cache = ModelCache(context)

    def open_run(job_id: str) -> ScanRun:
        return ScanRun(context, UUID(job_id), cache)

    @DBOS.step(name="list scans")
    def list_scans(job_id: str) -> list[str]:
        return open_run(job_id).list_scans()

    @DBOS.step(name="register one")
    def register_one(job_id: str, attempt: int, scan_id: str, model_id: str, place: tuple[int, int], span: Span) -> str:
        return open_run(job_id).register_one(attempt, UUID(scan_id), UUID(model_id), place, span)

    @DBOS.step(name="choose")
    def choose(job_id: str, attempt: int, model_id: str, number: int) -> str:
        return open_run(job_id).choose(attempt, UUID(model_id), number)

    @DBOS.step(name="train model")
    def train_model(
        job_id: str, attempt: int, training_set_id: str, model_id: str, name: str, number: int, span: Span
    ) -> str:
        return open_run(job_id).train(attempt, UUID(training_set_id), UUID(model_id), name, number, span)

    @DBOS.step(name="evaluate model")
    def evaluate(job_id: str, attempt: int, model_id: str, parent_id: str, number: int, span: Span) -> bool:
        return evaluate_model(open_run(job_id), attempt, UUID(model_id), UUID(parent_id), number, span)

    def train_and_evaluate(
        run: ScanRun, attempt: int, training_set_id: str, parent_id: str, name: str, number: int, span: Span
    ) -> str:
        job_id, level = str(run.job_id), run.row.params.get("evaluate", "no")
        border = span[0] + TRAINED[level] * (span[1] - span[0])
        made = train_model(job_id, attempt, training_set_id, parent_id, name, number, (span[0], border))
        if level != "no":
            evaluate(job_id, attempt, made, parent_id, number, (border, span[1]))
        return made

    @DBOS.step(name="finish scans")
    def finish(job_id: str, attempt: int, model_id: str | None, outcomes: list[str]) -> str:
        open_run(job_id).finish(attempt, None if model_id is None else UUID(model_id), outcomes)
        return "done"

    def register_all(job_id: str, attempt: int, model_id: str, span: Span) -> list[str]:
        scans = list_scans(job_id)
        return [
            register_one(job_id, attempt, scan_id, model_id, (number, len(scans)), span)
            for number, scan_id in enumerate(scans)
        ]

    @DBOS.workflow(name="register", max_recovery_attempts=1000)
    def register(job_id: str, attempt: int) -> str:
        run = open_run(job_id)

        def work() -> None:
            outcomes = register_all(job_id, attempt, run.row.params["model_id"], (0.0, 1.0))
            finish(job_id, attempt, None, outcomes)

        return run.attempt(attempt, work)

    @DBOS.workflow(name="train", max_recovery_attempts=1000)
    def train(job_id: str, attempt: int) -> str:
        run = open_run(job_id)

        def work() -> None:
            params = run.row.params
            made = train_and_evaluate(
                run, attempt, params["training_set_id"], params["model_id"], params["name"], 0, (0.0, 1.0)
            )
            finish(job_id, attempt, made, [])

        return run.attempt(attempt, work)

    @DBOS.workflow(name="loop", max_recovery_attempts=1000)
    def loop(job_id: str, attempt: int) -> str:
        run = open_run(job_id)

        def work() -> None:
            params, model_id = run.row.params, run.row.params["model_id"]
            spans = plan_loop(params["rounds"], params["by"] == "verdict")
            outcomes: list[str] = []
            if params["by"] == "verdict":
                outcomes = register_all(job_id, attempt, model_id, spans.pop(0))
            for number in range(1, params["rounds"] + 1):
                chosen = choose(job_id, attempt, model_id, number)
                name = params["name"] if params["rounds"] == 1 else f"{params['name']}, round {number}"
                model_id = train_and_evaluate(run, attempt, chosen, model_id, name, number, spans.pop(0))
                outcomes = register_all(job_id, attempt, model_id, spans.pop(0))
            finish(job_id, attempt, model_id, outcomes)

        return run.attempt(attempt, work)

    return {"register": register, "train": train, "loop": loop}


COLD, WARM, TRAINING = 8.0, 2.0, 1.0
"""Rough shares of the time of a loop: registering without a start, from a start, and training."""

TRAINED = {"no": 1.0, "quick": 0.7, "full": 0.3}
"""Share of training in training and evaluation."""


def plan_loop(rounds: int, registers_first: bool) -> list[Span]:
    """Parts of the progress bar, in the order in which a loop uses them."""
    parts = [COLD] * registers_first + [TRAINING, WARM] * rounds
    ends = [sum(parts[: number + 1]) / sum(parts) for number in range(len(parts))]
    return list(zip([0.0, *ends[:-1]], ends, strict=True))
