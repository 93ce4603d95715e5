"""`/training-sets`: what a rule chooses, kept for good."""

from __future__ import annotations

import hashlib
import io
import json
import uuid
import zipfile
from pathlib import Path

from tests.server.curation import API, Curation, curation, join
from tracker.training import load_training_set

__all__ = ["curation", "join"]


def make(curation: Curation, name: str = "set", **rule: object):
    return curation.rob.send("POST", "/training-sets", {"name": name, "rule": rule})


def preview(curation: Curation, **rule: object) -> int:
    return curation.rob.send("POST", "/training-sets/preview", rule).json()["registrations"]


def test_accepted_registrations_become_a_set_that_never_changes(curation: Curation) -> None:
    accepted, rejected = curation.register("a", subject="Ada"), curation.register("b", subject="Bob")
    curation.register("c")
    assert make(curation).status_code == 422, "nothing is accepted yet"
    curation.decide(curation.rob, accepted)
    curation.decide(curation.rob, rejected, "reject")
    made = make(curation)
    assert made.status_code == 201, made.text
    one = made.json()
    assert (one["registration_count"], one["subject_count"], one["mirrored_count"]) == (1, 1, 0)
    assert make(curation, "again").json()["id"] == one["id"], "the same registrations are kept once"
    curation.decide(curation.rob, accepted, "reject")
    curation.decide(curation.rob, rejected, "accept")
    members = curation.rob.get(f"/training-sets/{one['id']}/registrations")["items"]
    assert [(item["registration_id"], item["scan_name"]) for item in members] == [(str(accepted), "a")]
    assert make(curation, "other").json()["digest"] != one["digest"]
    assert curation.rob.get(f"/training-sets/{one['id']}/verify") == {"is_intact": True, "damaged": []}


def test_the_download_is_what_training_takes_and_its_list_has_the_sets_hash(curation: Curation, tmp_path: Path) -> None:
    for name in "abc":
        curation.decide(curation.rob, curation.register(name, subject=name, verdict="doubtful"))
    made = make(curation).json()
    data = curation.studio.client.get(f"{API}/training-sets/{made['id']}/registrations.zip").content
    folder = tmp_path / "set"
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        archive.extractall(folder)
    listed = (folder / "training_set.json").read_bytes()
    assert hashlib.sha256(listed).hexdigest() == made["digest"]
    for item in json.loads(listed)["registrations"]:
        file = folder / item["registration"] / "registration.npz"
        assert hashlib.sha256(file.read_bytes()).hexdigest() == item["sha256"]
    accepted = json.loads((folder / "accepted.json").read_text())
    assert len(load_training_set(folder, accepted)) == 3, "whatever the program's own verdict was"


def test_a_damaged_file_is_found_and_not_given_out(curation: Curation) -> None:
    id_ = curation.register("a")
    curation.decide(curation.rob, id_)
    made = make(curation).json()
    path = curation.studio.settings.data_dir / "registrations" / str(id_) / "registration.npz"
    path.write_bytes(path.read_bytes()[:-1] + b"x")
    checked = curation.rob.get(f"/training-sets/{made['id']}/verify")
    assert checked == {"is_intact": False, "damaged": [str(id_)]}
    answer = curation.rob.send("GET", f"/training-sets/{made['id']}/registrations.zip")
    assert answer.status_code == 409 and str(id_) in answer.json()["detail"]


def test_the_rule_chooses_by_people_or_by_the_programs_own_verdict(curation: Curation) -> None:
    ids = {
        "good": curation.register("good", subject="Ada", collection="x"),
        "good but rejected": curation.register("rejected", subject="Ada", collection="x"),
        "bad but accepted": curation.register("accepted", subject="Bob", collection="x", verdict="bad"),
        "elsewhere": curation.register("elsewhere", subject="Cem", collection="y", side="left"),
    }
    curation.decide(curation.rob, ids["good but rejected"], "reject")
    curation.decide(curation.rob, ids["bad but accepted"], "accept")
    curation.decide(curation.eve, ids["bad but accepted"], "accept")
    curation.decide(curation.rob, ids["elsewhere"], "accept")
    assert preview(curation) == 2
    assert preview(curation, needs_two=True) == 1
    assert preview(curation, collections=["x"]) == 1
    assert preview(curation, leave_out_subjects=["Bob"]) == 1
    assert preview(curation, verdicts=["good"]) == 1
    assert preview(curation, by="verdict") == 2
    assert preview(curation, by="verdict", collections=["x"]) == 1
    assert preview(curation, model_id=str(uuid.uuid4())) == 0
    body = {"name": "x", "rule": {"by": "chance"}}
    assert curation.rob.send("POST", "/training-sets", body).status_code == 422
