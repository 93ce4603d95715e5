"""Registrations of moving scans: decided about by stretch, taken back, kept, and written for other programs."""

from __future__ import annotations

import io
import json
import uuid
import zipfile
from typing import Any

import numpy as np
import pytest
import trimesh
from sqlalchemy import select

from server.access.models import AuditRow
from server.moving_scans.storing import AREA, TEMPLATES, name_frame
from tests.server.moving_scans.curated import Curated, curated
from tests.server.moving_scans.moving import API, MovingPerson, moving_person
from tests.server.packed_arrays import unpack_arrays
from tests.server.teams.conftest import Join, join
from tracker.cli.__main__ import main
from tracker.model.body_motion import load_body_motion

__all__ = ["curated", "join", "moving_person"]


def test_a_registration_says_how_far_it_is_how_good_and_which_hands_are_guessed(curated: Curated) -> None:
    newest, oldest = curated.ann.get(f"/moving-scans/{curated.scan_id}/registrations")["items"]
    assert (newest["id"], newest["number"], newest["parent_id"]) == (curated.second, 2, curated.first)
    assert (oldest["number"], oldest["prior"], oldest["frames_done"]) == (1, "mixture", 3)
    assert (oldest["verdicts"], oldest["guessed"]) == ({"good": 2, "doubtful": 1}, {"left": 1})
    frames = curated.frames(curated.first)
    assert [(each["frame"], each["verdict"], each["guessed"]) for each in frames] == [
        (0, "doubtful", []),
        (1, "good", []),
        (2, "good", ["left"]),
    ]
    assert oldest["scan_to_mesh_mm"] == pytest.approx(np.mean([each["mean_mm"] for each in frames]))
    answer = curated.studio.client.get(f"{API}/moving-registrations/{curated.first}/frames/2/geometry")
    arrays, _ = unpack_arrays(answer.content)
    assert {name: array.dtype.name for name, array in arrays.items()} == {
        "vertices": "float32",
        "normals": "int8",
        "vertex_error_mm": "float32",
        "point_error_mm": "float32",
        "guessed": "uint8",
    }
    lengths = np.linalg.norm(arrays["normals"] / 127.0, axis=1)
    assert np.abs(lengths - 1.0).max() < 0.02 and arrays["guessed"].sum() > 100
    missing = curated.studio.client.get(f"{API}/moving-registrations/{curated.second}/frames/0/geometry")
    assert missing.status_code == 404


def test_of_each_frame_the_registration_accepted_last_counts_and_what_is_taken_back_does_not(curated: Curated) -> None:
    one = curated.decide(curated.rob, curated.first, "accept", 0, 2)
    assert one.status_code == 201 and curated.accepted() == [(0, 2, 1, "rob")]
    two = curated.decide(curated.rob, curated.second, "accept", 1, 1).json()
    assert curated.accepted() == [(0, 0, 1, "rob"), (1, 1, 2, "rob"), (2, 2, 1, "rob")]
    curated.decide(curated.rob, curated.first, "reject", 2, 2, note="the hand is off")
    assert curated.accepted() == [(0, 0, 1, "rob"), (1, 1, 2, "rob")]
    assert [each["decision"] for each in curated.frames(curated.first)] == ["accept", "accept", "reject"]
    assert curated.undo(curated.rob, two).status_code == 201
    assert curated.accepted() == [(0, 1, 1, "rob")], "what stood before stands again"
    listed = curated.ann.get(f"/moving-scans/{curated.scan_id}/decisions")["items"]
    assert [(each["decision"], each["stands"]) for each in listed] == [
        ("undo", False),
        ("reject", True),
        ("accept", False),
        ("accept", True),
    ]
    scan = curated.ann.get(f"/moving-scans/{curated.scan_id}")
    assert (scan["accepted_count"], scan["registration_count"]) == (2, 2)
    with curated.studio.database.reading() as session:
        acts = list(session.scalars(select(AuditRow.act).where(AuditRow.act.startswith("stretch."))))
    assert sorted(acts) == ["stretch.accept", "stretch.accept", "stretch.reject", "stretch.undo"]


def test_decisions_are_reviewers_own_made_once_and_of_frames_that_are_there(curated: Curated, join: Join) -> None:
    sue, operation = join("sue", "reviewer"), str(uuid.uuid4())
    assert curated.decide(curated.ann, curated.first, "accept", 0, 1).status_code == 403
    made = curated.decide(curated.rob, curated.first, "accept", 0, 1, operation_id=operation)
    again = curated.decide(curated.rob, curated.first, "accept", 0, 1, operation_id=operation)
    assert (made.status_code, again.status_code) == (201, 200) and made.json() == again.json()
    other = curated.decide(curated.rob, curated.first, "reject", 0, 1, operation_id=operation)
    assert other.status_code == 422 and "belongs to another decision" in other.json()["detail"]
    assert curated.undo(sue, made.json()).status_code == 403
    assert curated.undo(curated.rob, made.json()).status_code == 201
    assert curated.undo(curated.rob, made.json()).status_code == 409
    wrong: list[tuple[Any, Any, str]] = [(0, 3, "registered are 0 to 2"), (2, 1, "is after"), (-1, 1, "first_frame")]
    for first, last, told in [*wrong, (0, 1.5, "last_frame"), (0, True, "last_frame")]:
        refused = curated.decide(curated.rob, curated.first, "accept", first, last)
        assert refused.status_code == 422 and told in refused.text
    early = curated.decide(curated.rob, curated.second, "accept", 0, 2)
    assert early.status_code == 422 and "registered are 1 to 2" in early.json()["detail"]
    assert curated.decide(curated.rob, str(uuid.uuid4()), "accept", 0, 1).status_code == 404
    assert curated.accepted() == []


def test_accepted_frames_are_kept_with_their_lineage_and_written_for_other_programs(
    curated: Curated, moving_person: MovingPerson, tmp_path
) -> None:
    asked = {"moving_scan_id": curated.scan_id, "name": "For the model"}
    assert curated.rob.send("POST", "/body-sets", asked).status_code == 422, "nothing is accepted"
    curated.decide(curated.rob, curated.first, "accept", 0, 1)
    second = curated.decide(curated.rob, curated.second, "accept", 2, 2).json()
    assert curated.ann.send("POST", "/body-sets", asked).status_code == 403
    kept = curated.rob.send("POST", "/body-sets", asked)
    assert kept.status_code == 201 and curated.rob.send("POST", "/body-sets", asked).json() == kept.json()
    told = kept.json()
    assert told["frame_count"] == 3 and [each["prior"] for each in told["stretches"]] == ["mixture", "none"]
    curated.undo(curated.rob, second)
    assert curated.ann.get("/body-sets", moving_scan_id=curated.scan_id)["items"] == [told], "it never changes"

    answer = curated.studio.client.get(f"{API}/body-sets/{told['id']}/archive.zip")
    assert answer.status_code == 200 and len(answer.content) == int(answer.headers["content-length"])
    assert not list(curated.studio.settings.data_dir.glob("*.zip"))
    with zipfile.ZipFile(io.BytesIO(answer.content)) as archive:
        archive.extractall(tmp_path)
    lineage = json.loads((tmp_path / "lineage.json").read_text())
    assert lineage["moving_scan"]["subject"] == "Ada" and lineage["set"]["id"] == told["id"]
    assert [each["registration"] for each in lineage["frames"]] == [curated.first, curated.first, curated.second]
    assert [each["scan"] for each in lineage["frames"]] == [f"frame{frame}.ply" for frame in range(3)]
    assert lineage["frames"][2]["decision"] == second["id"]
    assert [each["prior"] for each in lineage["registrations"]] == ["mixture", "none"]
    assert (tmp_path / lineage["registrations"][1]["model"]).is_file()
    motion = load_body_motion(tmp_path / "motion.npz")
    assert (len(motion), motion.fps, motion.population) == (3, 30.0, "neutral")
    np.testing.assert_allclose(motion.poses[1][:22], moving_person.bodies[1].pose[:22])
    np.testing.assert_allclose(motion.translations[:, 1], [0.0, 0.1, 0.2])
    assert np.abs(motion.shape).max() < 1e-6, "the model here is the mean person"
    mesh = trimesh.load_mesh(tmp_path / "meshes" / "000002.ply", process=False)
    np.testing.assert_allclose(mesh.vertices, moving_person.bodies[2].true_vertices, atol=1e-6)
    assert main(["body", "pose", str(tmp_path / "motion.npz"), "--to", str(tmp_path / "posed"), "--format", "ply"]) == 0
    assert len(list((tmp_path / "posed").glob("*.ply"))) == 3

    damaged = curated.studio.settings.data_dir / AREA / str(name_frame(uuid.UUID(curated.first), 1)) / "body.npz"
    damaged.write_bytes(b"other")
    answer = curated.studio.client.get(f"{API}/body-sets/{told['id']}/archive.zip")
    assert answer.status_code == 409 and "Frame 1 of “For the model” was changed after it was accepted" in answer.text
    assert not list(curated.studio.settings.data_dir.glob("*.zip"))


def test_what_is_kept_in_a_set_cannot_be_deleted_for_good_and_all_else_goes_with_its_scan(
    curated: Curated, join: Join
) -> None:
    lea = join("lea", "lead")
    curated.decide(curated.rob, curated.first, "accept", 0, 2)
    lea.send("DELETE", f"/moving-scans/{curated.scan_id}")
    assert lea.send("DELETE", f"/bin/moving_scan/{curated.scan_id}").status_code == 204
    data = curated.studio.settings.data_dir
    assert not [each for area in ("moving_scans", TEMPLATES, AREA) for each in (data / area).iterdir()]
