"""Jobs on scans: what they are to do, that a killed worker loses one scan at most, and what training leaves."""

from __future__ import annotations

import shutil
import uuid
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from sqlalchemy import select

from server.access.models import LOCAL_ACCOUNT_ID
from server.hand_models.models import HandModelRow
from server.hand_models.storing import UNTRAINED_ID, find_file
from server.jobs import create_jobs, service
from server.jobs.files import JobFiles
from server.jobs.loop_schemas import LoopCreate
from server.jobs.register_schemas import RegisterCreate
from server.jobs.tracking import TrackingJob
from server.jobs.train_schemas import TrainCreate, TrainingParams
from server.registrations.models import RegistrationRow
from server.registrations.training_set_schemas import TrainingRule
from server.registrations.training_sets import create_training_set
from server.scans.models import ScanRow
from tests.server.conftest import GeneratedHand, Studio, Tracked
from tests.server.curation import add_registered
from tests.server.jobs.scan_bench import ScanBench, bench
from tests.server.teams.conftest import Join, join
from tracker import load_blend_model, load_registration, save_registration, untrained_hand
from tracker.evaluation.scan_fit import fit_pose_to_vertices
from tracker.synthesis.scans.generate import generate_truth

__all__ = ["bench", "join"]


@pytest.mark.slow
def test_a_killed_worker_loses_one_scan_at_most_and_none_is_registered_twice(
    bench: ScanBench, generated_hand: GeneratedHand
) -> None:
    for number in range(3):
        add_registered(bench.app, generated_hand, f"s{number}")
    with bench.database.writing() as session:
        damaged = session.scalars(select(ScanRow).where(ScanRow.name == "s2")).one()
    (bench.storage.folder("scans", damaged.id) / "scan.ply").write_bytes(b"ply\nnothing\n")
    worker = bench.start_worker()
    job_id = bench.make(create_jobs.make_register_job, RegisterCreate(only="all"))
    bench.wait(job_id, lambda job: job.frames_done >= 1)
    bench.kill(worker)
    assert bench.job(job_id).state == "running"
    bench.start_worker()
    job = bench.wait_for_end(job_id)
    assert (job.frames_done, job.frames_total, job.progress, job.seconds_left) == (3, 3, 1.0, None)
    assert any("going on after the last finished step" in line for line in bench.log(job_id))
    made = bench.registrations(job_id)
    assert len(made) == 2 and len({row.scan_id for row in made}) == 2
    for row in made:
        assert row.is_current and row.model_id == UNTRAINED_ID and row.round == 1
        found = load_registration(bench.storage.folder("registrations", row.id))
        np.testing.assert_allclose(found.vertices, generated_hand.found.vertices, atol=1e-9)
        assert (found.subject, found.pose_name) == ("Ada", "flat")
    with bench.database.reading() as session:
        assert session.get_one(ScanRow, damaged.id).state == "failed"
        assert session.scalars(select(RegistrationRow).where(RegistrationRow.is_current)).all().__len__() == 3
    assert any("1 not read" in line for line in bench.log(job_id))


@pytest.mark.slow
def test_a_trained_model_knows_what_it_was_trained_from_and_registers_the_next_round(
    bench: ScanBench, generated_hand: GeneratedHand, tmp_path: Path
) -> None:
    """The registrations are true ones here, so that there are enough of them."""
    for subject in (1, 2, 4):
        for pose in range(8):
            truth = generate_truth(subject, 5 * pose)
            fit = fit_pose_to_vertices(untrained_hand("right"), truth.vertices)
            folder = tmp_path / f"{subject}-{pose}"
            found = replace(generated_hand.found, vertices=truth.vertices, pose=fit.pose, subject=str(subject))
            save_registration(replace(found, verdict="doubtful"), folder)
            shutil.copyfile(generated_hand.folder / "hand.ply", folder / "hand.ply")
            hand = replace(generated_hand, folder=folder)
            add_registered(bench.app, hand, folder.name, subject=str(subject), verdict="good", collection="true")
    with bench.database.writing() as session:
        rule = TrainingRule(by="verdict")
        chosen, _ = create_training_set(session, bench.storage, "true", rule, LOCAL_ACCOUNT_ID)
    options = TrainingParams(rounds=1, num_shapes=2, with_pose_shapes=False)
    job_id = bench.make(
        create_jobs.make_train_job, TrainCreate(training_set_id=chosen.id, name="Our hand", options=options)
    )
    bench.start_worker()
    job = bench.wait_for_end(job_id)
    with bench.database.reading() as session:
        model = session.get_one(HandModelRow, job.hand_model_id)
        assert (model.kind, model.round, model.parent_id) == ("trained", 1, UNTRAINED_ID)
        assert (model.training_set_id, model.job_id, model.name) == (chosen.id, job_id, "Our hand")
        assert model.report is not None and model.facts["shape_parameters"] == ["shape 1", "shape 2"]
    assert load_blend_model(find_file(bench.storage, model)).num_shape == 2
    with bench.database.reading() as session:
        scan_id = session.scalars(select(ScanRow.id).order_by(ScanRow.name).limit(1)).one()
    asked = RegisterCreate(scan_ids=[scan_id], model_id=model.id)
    again = bench.make(create_jobs.make_register_job, asked)
    bench.wait_for_end(again)
    [row] = bench.registrations(again)
    assert (row.round, row.model_id, row.scan_id) == (2, model.id, scan_id)
    assert not bench.storage.folder("jobs", job_id).exists()


def test_a_job_registers_what_was_chosen_when_it_was_made(studio: Studio, generated_hand: GeneratedHand) -> None:
    bench = ScanBench(studio.settings, studio.database)
    one = add_registered(studio.app, generated_hand, "one", collection="x")
    add_registered(studio.app, generated_hand, "two", collection="x", subject="Bob")
    with pytest.raises(Exception, match="Untrained right hand has registered all 2 scans of x as cropped now"):
        bench.make(create_jobs.make_register_job, RegisterCreate(collection="x"))  # this model has registered both
    with studio.database.writing() as session:
        session.get_one(RegistrationRow, one).decision = "accept"
        scan = session.get_one(RegistrationRow, one).scan_id
    for asked, names in (
        (RegisterCreate(collection="x", only="all"), ["one", "two"]),
        (RegisterCreate(only="not_accepted"), ["two"]),
        (RegisterCreate(only="all", subject="Bob"), ["two"]),
        (RegisterCreate(only="all", scan_ids=[scan]), ["one"]),
    ):
        job_id = bench.make(create_jobs.make_register_job, asked)
        with studio.database.reading() as session:
            chosen = [session.get_one(ScanRow, id_).name for id_ in create_jobs.list_job_scans(session, job_id)]
        assert chosen == names
        retried = studio.client.post(f"/api/v1/jobs/{job_id}/cancel").status_code
        again = studio.client.post(f"/api/v1/jobs/{job_id}/retry").json()
        with studio.database.reading() as session:
            assert len(create_jobs.list_job_scans(session, uuid.UUID(again["id"]))) == len(names)
        assert retried == 200 and again["title"].endswith("with Untrained right hand")


def test_jobs_that_make_no_sense_are_refused(studio: Studio, generated_hand: GeneratedHand, join: Join) -> None:
    rob, ann = join("rob", "reviewer"), join("ann")
    nobody = str(uuid.uuid4())
    assert rob.send("POST", "/jobs/register", {}).status_code == 422
    add_registered(studio.app, generated_hand, "one")
    assert rob.send("POST", "/jobs/register", {"scan_ids": [nobody]}).status_code == 404
    unknown = rob.send("POST", "/jobs/register", {"only": "all", "model_id": nobody})
    assert unknown.status_code == 422 and nobody in unknown.json()["obstacles"][0], unknown.text
    assert rob.send("POST", "/jobs/train", {"training_set_id": nobody, "name": "x"}).status_code == 404
    assert rob.send("POST", "/jobs/loop", {"name": "x", "by": "decisions", "rounds": 2}).status_code == 422
    refused = rob.send("POST", "/jobs/loop", {"name": "x", "by": "decisions"}).json()["obstacles"]
    assert "There are 0 registrations" in refused[0] and "1 registration waits for a decision" in refused[1]
    assert rob.send("POST", "/jobs/loop", {"name": "x", "options": {"rounds": 0}}).status_code == 422
    assert "1 registration does not count" in rob.send("POST", "/jobs/loop", {"name": "x"}).json()["detail"]
    for number in range(19):
        add_registered(studio.app, generated_hand, f"s{number}", subject=("Ada", "Bob")[number % 2])
    made = rob.send("POST", "/jobs/loop", {"name": "x"}).json()
    told = (made["kind"], made["title"], made["unit"], made["sequence_id"])
    assert told == ("loop", "x: 1 round over 20 scans", "scans", None)
    for kind in ("register", "train", "loop"):
        assert ann.send("POST", f"/jobs/{kind}", {"name": "x"}).status_code in (403, 422)
    listed = rob.get("/jobs", kind="loop", search="round")["items"]
    assert [item["id"] for item in listed] == [made["id"]]
    assert LoopCreate.model_validate({"name": "x"}).rounds == 1 and service.KINDS


def test_recordings_are_tracked_with_a_model_of_the_studio_and_its_mirror_image(
    studio: Studio, generated_hand: GeneratedHand, tracked: Tracked, tmp_path: Path
) -> None:
    add_registered(studio.app, generated_hand, "one")  # the untrained hand is stored when it is first used
    fields = {field["name"]: field for field in studio.client.get("/api/v1/jobs/form").json()["fields"]}
    assert fields["hand_model_id"]["choices"] == ["", "trained", str(UNTRAINED_ID)]
    body = {"kind": "track", "sequence_id": str(tracked.sequence_id)}
    params = {"hand_model_id": str(UNTRAINED_ID), "calibrate": False, "last_frame": 1}
    job = studio.client.post("/api/v1/jobs", json=body | {"params": params}).json()
    assert job["params"]["hand_model_id"] == str(UNTRAINED_ID)
    default = studio.client.post("/api/v1/jobs", json=body | {"params": {"hand_model_id": ""}}).json()
    assert "hand_model_id" not in default["params"]
    shipped = studio.client.post("/api/v1/jobs", json=body | {"params": {"hand_model_id": "trained"}}).json()
    assert shipped["params"]["hand_model_id"] == "trained"
    for wrong in (str(uuid.uuid4()), "x", 3):
        answer = studio.client.post("/api/v1/jobs", json=body | {"params": {"hand_model_id": wrong}})
        assert answer.status_code in (404, 422), answer.text
    storage = studio.app.state.storage
    with studio.database.reading() as session:
        file = find_file(storage, session.get_one(HandModelRow, UNTRAINED_ID))
    recording = storage.folder("sequences", tracked.sequence_id)
    for params, model in ((job["params"], file), (shipped["params"], None)):
        tracking = TrackingJob(recording, params | {"calibrate": False}, JobFiles(tmp_path / "job"), "key", model)
        hands = tracking.load_hands()
        assert hands is not None and hands.keys() == {"right", "left"}
        for side, hand in hands.items():
            assert hand.hand is not None and hand.hand.side == side and len(hand.skeleton.bone_names) == 16
            assert (hand.pose_blend is None) == (model is not None), "only the trained one changes with the pose"
        assert not tracking.options.calibrate
