"""Training and evaluating by real workers that are killed: the model comes out the same, to the last bit."""

from __future__ import annotations

import uuid
from typing import Any

import pytest
from fastapi.testclient import TestClient
from sqlalchemy import select, update

from server.access.models import LOCAL_ACCOUNT_ID
from server.app import create_app
from server.errors import InvalidError
from server.hand_models.storing import UNTRAINED_ID, find_file
from server.jobs import create_jobs, service
from server.jobs.evaluating import evaluate_model
from server.jobs.loop_schemas import LoopCreate
from server.jobs.run import WorkerContext
from server.jobs.scan_run import ModelCache, ScanRun
from server.jobs.train_schemas import TrainCreate, TrainingParams
from server.registrations.models import RegistrationRow
from server.registrations.training_set_schemas import TrainingRule
from server.registrations.training_sets import create_training_set
from server.scans.models import ScanRow
from tests.server.conftest import BASE_URL, GeneratedHand
from tests.server.curation import add_registered, make_true_hand
from tests.server.jobs.scan_bench import ScanBench, bench

__all__ = ["bench"]

POLICY = "content-security-policy"
POSES = (0, 5, 9, 13, 20, 27, 40)


@pytest.fixture(scope="module")
def hands(tmp_path_factory: pytest.TempPathFactory) -> list[GeneratedHand]:
    """Three people's right hands and a few left ones of a fourth to learn from, and one person to be judged on."""
    folder = tmp_path_factory.mktemp("hands")
    wanted = [(subject, pose, "right") for subject in (1, 2, 3) for pose in POSES]
    wanted += [(4, pose, "left") for pose in POSES[:3]] + [(32, pose, "right") for pose in POSES[:3]]
    return [make_true_hand(folder / f"{who}-{pose}", who, pose, side, 600) for who, pose, side in wanted]


@pytest.fixture
def filled(bench: ScanBench, hands: list[GeneratedHand]) -> ScanBench:
    for hand in hands:
        found = hand.found
        add_registered(bench.app, hand, hand.folder.name, subject=found.subject, side=found.side, pose=found.pose_name)
    return bench


def choose(bench: ScanBench, **rule: Any) -> uuid.UUID:
    with bench.database.writing() as session:
        wanted = TrainingRule.model_validate({"by": "verdict", "leave_out_subjects": ["S32"], **rule})
        return create_training_set(session, bench.storage, "chosen", wanted, LOCAL_ACCOUNT_ID)[0].id


def train(bench: ScanBench, set_id: uuid.UUID, **more: Any) -> uuid.UUID:
    options = TrainingParams(rounds=2, num_shapes=2, with_pose_shapes=False)
    asked = TrainCreate.model_validate({"training_set_id": set_id, "name": "Our hand", "options": options, **more})
    return bench.make(create_jobs.make_train_job, asked)


@pytest.mark.slow
def test_killed_and_cancelled_in_training_and_in_evaluating_a_job_ends_with_the_same_bits(filled: ScanBench) -> None:
    bench, chosen = filled, choose(filled)
    worker = bench.start_worker()
    undisturbed = train(bench, chosen, evaluate="quick")
    disturbed = train(bench, chosen, evaluate="quick", test_subjects=["S32"])
    bench.wait_for_end(undisturbed)
    first = bench.wait_for_file(disturbed, "train-0-first-poses.json")
    stamp = first.stat().st_mtime_ns
    bench.kill(worker)
    worker = bench.start_worker()
    bench.wait_for_file(disturbed, "train-0-round-1-joints.json")
    bench.cancel(disturbed)
    assert first.stat().st_mtime_ns == stamp, "what was kept is not done again"
    bench.resume(disturbed)
    bench.wait_for_file(disturbed, "evaluate-0-judged-learned-pose-and-shape.json")
    bench.kill(worker)
    [model] = bench.models(disturbed)
    assert bench.job(disturbed).hand_model_id == model.id, "the model is there before it is evaluated"
    assert "level" not in (model.report or {})["study"]
    with bench.database.writing() as session:  # what people decide meanwhile does not change what it is judged on
        scans = select(ScanRow.id).where(ScanRow.subject == "S32")
        session.execute(update(RegistrationRow).where(RegistrationRow.scan_id.in_(scans)).values(decision="reject"))
    bench.start_worker()
    job = bench.wait_for_end(disturbed)
    assert (job.crashes, job.attempt, job.progress) == (0, 2, 1.0)
    kept = [line.removesuffix(" is kept from before") for line in bench.log(disturbed) if "kept from before" in line]
    assert kept[0] == "first poses" and len(kept) == 2, "gone on with once after the kill, once after the cancel"
    [one], [other] = bench.models(undisturbed), bench.models(disturbed)
    assert find_file(bench.storage, one).read_bytes() == find_file(bench.storage, other).read_bytes()
    assert other.parent_id == UNTRAINED_ID and job.hand_model_id == other.id
    assert one.report is not None and other.report is not None
    study = other.report["study"]
    rest = {"seconds": 0, "study": 0}
    assert one.report | rest == other.report | rest
    assert study | {"seconds": 0} == one.report["study"] | {"seconds": 0}
    assert (study["level"], study["people"], study["scans"]) == ("quick", ["S32"], 2)
    assert set(study["models"]) == {"learned", "untrained"} and set(study["own_template"]) == {"learned"}
    assert study["models"]["learned"]["scan_to_mesh_mm"] < study["models"]["untrained"]["scan_to_mesh_mm"]
    curve = [row["mean_mm"] for row in study["pose_generalisation"]["learned"]]
    assert curve[-1] < curve[0]
    assert study["not_compared"] == {} and len(study["shape_generalisation"]) >= 1
    with TestClient(create_app(bench.settings), base_url=BASE_URL) as client:
        answer = client.get(f"/api/v1/hand-models/{other.id}/report.html")
        assert answer.headers["content-disposition"].endswith('.html"') and "sandbox" in answer.headers[POLICY]
        assert f"{study['models']['learned']['scan_to_mesh_mm']:.3f}" in answer.text and "Our hand" in answer.text
        assert client.get(f"/api/v1/hand-models/{UNTRAINED_ID}/report.html").status_code == 404
        assert client.get(f"/api/v1/hand-models/{UNTRAINED_ID}").json()["registration_count"] == 27


def test_who_is_judged_on_must_be_there_and_not_have_been_learnt_from(filled: ScanBench) -> None:
    bench, chosen = filled, choose(filled)
    everybody = choose(bench, leave_out_subjects=[])
    for set_id, subjects, told in (
        (everybody, [], "Nobody is kept for testing"),
        (everybody, ["S32"], "S32 is in the training set"),
        (chosen, ["S1"], "S1 is in the training set"),
        (chosen, ["S99"], "S99 has no registration that is good"),
    ):
        with pytest.raises(InvalidError, match=told):
            train(bench, set_id, evaluate="quick", test_subjects=subjects)
        train(bench, set_id, test_subjects=subjects)  # where nothing is to be judged nothing is wrong
    with pytest.raises(InvalidError, match="Nobody is kept for testing"):
        bench.make(create_jobs.make_loop_job, LoopCreate(name="x", evaluate="quick"))


def test_a_model_that_nobody_was_kept_for_says_so_and_is_there_all_the_same(filled: ScanBench) -> None:
    """Those to be judged on are rejected between the making of the job and its evaluation."""
    bench, chosen = filled, choose(filled)
    job_id = train(bench, chosen, evaluate="quick")
    with bench.database.writing() as session:
        session.execute(update(RegistrationRow).values(decision="reject"))
    context = WorkerContext(bench.database, bench.storage, uuid.uuid4())
    with bench.database.writing() as session:
        assert service.claim_job(session, job_id, 1, context.worker_id) is not None
    run = ScanRun(context, job_id, ModelCache(context))
    model_id = uuid.UUID(run.train(1, chosen, UNTRAINED_ID, "Our hand", 0, (0.0, 0.5)))
    for _ in range(2):
        assert not evaluate_model(run, 1, model_id, UNTRAINED_ID, 0, (0.5, 1.0))
    [model] = bench.models(job_id)
    assert model.id == model_id and "models" not in (model.report or {})["study"]
    assert any("not evaluated" in line for line in bench.log(job_id))
