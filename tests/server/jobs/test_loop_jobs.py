"""Registering that is cancelled, and the loop over several rounds by a worker that is killed in the middle."""

from __future__ import annotations

import uuid

import pytest
from sqlalchemy import select

from server.access.models import LOCAL_ACCOUNT_ID
from server.hand_models.models import HandModelRow
from server.hand_models.storing import UNTRAINED_ID, add_uploaded
from server.jobs import create_jobs
from server.jobs.loop_schemas import LoopCreate
from server.jobs.register_schemas import RegisterCreate
from server.jobs.train_schemas import TrainingParams
from server.registrations.models import RegistrationRow
from server.registrations.training_set_models import TrainingMemberRow
from server.scans.models import ScanRow
from tests.server.conftest import GeneratedHand
from tests.server.curation import add_registered, make_true_hand
from tests.server.jobs.scan_bench import ScanBench, bench
from tracker import untrained_hand

__all__ = ["bench"]

POSES = (0, 2, 5, 9, 11, 20, 27, 40)


@pytest.fixture(scope="module")
def hands(tmp_path_factory: pytest.TempPathFactory) -> list[GeneratedHand]:
    """Three people to learn from, and one to be judged on."""
    folder = tmp_path_factory.mktemp("hands")
    wanted = [(who, pose) for who in (1, 2, 3) for pose in POSES] + [(32, pose) for pose in POSES[:2]]
    return [make_true_hand(folder / f"{who:02d}-{pose:02d}", who, pose, points=1500) for who, pose in wanted]


@pytest.fixture
def filled(bench: ScanBench, hands: list[GeneratedHand]) -> ScanBench:
    """A model that somebody uploaded has registered all scans: who registers them again begins there, and is quick."""
    with bench.database.writing() as session:
        other = add_uploaded(session, bench.storage, untrained_hand("right"), "other", LOCAL_ACCOUNT_ID).id
    for hand in hands:
        add_registered(bench.app, hand, hand.folder.name, subject=hand.found.subject, model_id=other)
    return bench


@pytest.mark.slow
def test_a_cancelled_job_keeps_what_is_registered_and_goes_on_with_the_rest(filled: ScanBench) -> None:
    bench = filled
    bench.start_worker()
    job_id = bench.make(create_jobs.make_register_job, RegisterCreate(subject="S1"))
    bench.wait(job_id, lambda job: job.frames_done >= 2)
    bench.cancel(job_id)
    before = {row.id: row.created_at for row in bench.registrations(job_id)}
    bench.resume(job_id)
    job = bench.wait_for_end(job_id)
    assert (job.frames_done, job.frames_total, job.attempt) == (len(POSES), len(POSES), 2)
    made = bench.registrations(job_id)
    assert len({row.scan_id for row in made}) == len(made) == len(POSES)
    assert len(before) >= 2
    assert {row.id: row.created_at for row in made if row.id in before} == before, "none was done twice"


@pytest.mark.slow
def test_a_loop_of_two_rounds_goes_on_after_a_killed_worker_and_each_round_learns_from_its_own(
    filled: ScanBench,
) -> None:
    bench = filled
    asked = LoopCreate(
        name="Our hand",
        rounds=2,
        leave_out_subjects=["S32"],
        evaluate="quick",
        options=TrainingParams(rounds=1, num_shapes=2, with_pose_shapes=False),
    )
    job_id = bench.make(create_jobs.make_loop_job, asked)
    worker = bench.start_worker()
    bench.wait_for_file(job_id, "train-1-first-poses.json")
    bench.kill(worker)  # in the first training
    worker = bench.start_worker()
    bench.wait(job_id, lambda job: len(bench.models(job_id)) == 1 and 5 <= job.frames_done < 20)
    bench.kill(worker)  # while the first model registers
    bench.start_worker()
    job = bench.wait_for_end(job_id)
    first, second = bench.models(job_id)
    assert [model.name for model in (first, second)] == ["Our hand, round 1", "Our hand, round 2"]
    assert [(model.round, model.parent_id) for model in (first, second)] == [(1, UNTRAINED_ID), (2, first.id)]
    assert job.hand_model_id == second.id and (job.progress, job.frames_done) == (1.0, 26)
    made = bench.registrations(job_id)
    assert len({(row.scan_id, row.model_id) for row in made}) == len(made) == 3 * 26, "each scan once by each model"
    for model, by, number in ((first, UNTRAINED_ID, 1), (second, first.id, 2)):
        chosen = _list_members(bench, model)
        assert {(row.model_id, row.round, row.verdict) for row in chosen} == {(by, number, "good")}
        assert len(chosen) >= 20 and "S32" not in _list_subjects(bench, chosen)
        study = (model.report or {})["study"]
        assert (study["level"], study["people"]) == ("quick", ["S32"])
    assert set((second.report or {})["study"]["models"]) == {"learned", "the model before", "untrained"}
    with bench.database.reading() as session:
        current = session.scalars(select(RegistrationRow.model_id).where(RegistrationRow.is_current)).all()
    assert set(current) == {second.id} and len(current) == 26


def _list_members(bench: ScanBench, model: HandModelRow) -> list[RegistrationRow]:
    query = select(RegistrationRow).join(TrainingMemberRow, TrainingMemberRow.registration_id == RegistrationRow.id)
    with bench.database.reading() as session:
        return list(session.scalars(query.where(TrainingMemberRow.training_set_id == model.training_set_id)))


def _list_subjects(bench: ScanBench, rows: list[RegistrationRow]) -> set[str]:
    ids: list[uuid.UUID] = [row.scan_id for row in rows]
    with bench.database.reading() as session:
        return set(session.scalars(select(ScanRow.subject).where(ScanRow.id.in_(ids))))
