"""A model is judged once, and one that cannot be says so: who was chosen to judge it on stays chosen."""

from __future__ import annotations

import uuid
from typing import Any

import pytest

from server.access.models import LOCAL_ACCOUNT_ID
from server.hand_models.models import HandModelRow
from server.hand_models.storing import UNTRAINED_ID
from server.jobs import service
from server.jobs.evaluating import evaluate_model
from server.jobs.run import WorkerContext
from server.jobs.scan_run import ModelCache, ScanRun
from server.registrations.training_set_models import TrainingSetRow
from server.registrations.training_set_schemas import TrainingRule
from tests.server.registrations.test_service import Bench


@pytest.fixture
def database_kind() -> str:
    """One will do: what is asked here are plain queries."""
    return "sqlite"


def open_run(context: WorkerContext, report: dict[str, Any] | None) -> tuple[ScanRun, uuid.UUID]:
    """A job that is to judge a model of this report on Zoe, of whom nobody has registered anything."""
    with context.database.writing() as session:
        rule = TrainingRule(by="verdict", leave_out_subjects=["Zoe"]).model_dump(mode="json")
        counts = {"registration_count": 0, "subject_count": 0, "mirrored_count": 0}
        session.add(kept := TrainingSetRow(name="set", rule=rule, digest="0" * 64, **counts))
        session.flush()
        about = {"kind": "trained", "side": "right", "digest": "0" * 64, "facts": {}, "training_set_id": kept.id}
        session.add(model := HandModelRow(name="Our hand", report=report, **about))
        params = {"evaluate": "quick", "test_subjects": ["Zoe"], "options": {}}
        job = service.create_job(session, "train", None, params, created_by=LOCAL_ACCOUNT_ID)
        service.claim_job(session, job.id, 1, context.worker_id)
        session.flush()
        ids = job.id, model.id
    return ScanRun(context, ids[0], ModelCache(context)), ids[1]


def judge(run: ScanRun, model_id: uuid.UUID) -> bool:
    return evaluate_model(run, 1, model_id, UNTRAINED_ID, 0, (0.5, 1.0))


def log(run: ScanRun) -> list[str]:
    with run.context.database.reading() as session:
        return [line.text for line in service.read_log(session, run.job_id, 0)]


def test_a_model_without_a_report_is_not_judged(context: WorkerContext) -> None:
    run, model_id = open_run(context, None)
    before = log(run)
    assert not judge(run, model_id) and log(run) == before


def test_a_model_that_was_judged_before_a_crash_is_not_judged_again(context: WorkerContext) -> None:
    report = {"study": {"level": "quick", "scans": 3}}
    run, model_id = open_run(context, report)
    before = log(run)
    assert judge(run, model_id) and log(run) == before
    with context.database.reading() as session:
        assert session.get_one(HandModelRow, model_id).report == report


def test_where_nobody_is_left_to_judge_on_the_model_stays_as_it_is_and_it_is_told(context: WorkerContext) -> None:
    run, model_id = open_run(context, {"study": {}})
    assert not judge(run, model_id)
    assert log(run)[-1] == "nobody kept for testing has a registration that counts: not evaluated"
    with context.database.reading() as session:
        assert session.get_one(HandModelRow, model_id).report == {"study": {}}


def test_who_is_registered_after_the_judging_began_does_not_count(context: WorkerContext) -> None:
    """A step that is done again must not see later decisions."""
    run, model_id = open_run(context, {"study": {}})
    assert not judge(run, model_id)
    bench = Bench(context.database)
    bench.register(bench.scan("late", subject="Zoe"))
    assert not judge(run, model_id), "its file would be missing if it were read"
    assert run.files.read_manifest("held-out-0") == {"files": {}, "registrations": []}
