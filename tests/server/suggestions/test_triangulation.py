"""`/sequences/{id}/triangulation`: joints in space from marks in several cameras, nothing stored."""

from __future__ import annotations

import argparse
import json
import time
import uuid
from pathlib import Path

import numpy as np
import pytest

from server.access.models import LOCAL_ACCOUNT_ID
from server.imports.service import ImportContext, import_recording
from tracker import Camera, add_commands, load_sequence

BENT = [-0.21, 0.07, 0.0011, -0.0007, 0.0]


@pytest.fixture(scope="module")
def surrounded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A hand that three cameras see, the last of them through a lens that distorts."""
    folder = tmp_path_factory.mktemp("surrounded") / "recording"
    parser = argparse.ArgumentParser()
    add_commands(parser.add_subparsers())
    command = ["synthesize", "--motion", "pinch", "--frames", "0:1", "--cameras", "3", "--size", "160x120"]
    args = parser.parse_args([*command, "--out", str(folder)])
    assert args.run(args) == 0
    document = json.loads((folder / "sequence.json").read_text())
    document["cameras"][2]["distortion"] = BENT
    del document["annotations"]
    (folder / "sequence.json").write_text(json.dumps(document))
    return folder


@pytest.fixture
def sequence_id(studio, surrounded: Path) -> uuid.UUID:
    desk = ImportContext(studio.database, studio.app.state.storage, studio.settings)
    return import_recording(desk, surrounded, {}, LOCAL_ACCOUNT_ID)


@pytest.fixture
def cameras(surrounded: Path) -> dict[str, Camera]:
    return {camera.id: camera for camera in load_sequence(surrounded).cameras}


@pytest.fixture
def joints(surrounded: Path) -> np.ndarray:
    """(21, 3) world, m."""
    with np.load(surrounded / "truth.npz") as truth:
        return truth["joints_3d"][0]


def view(camera: Camera, joints: np.ndarray, v: int = 2) -> dict:
    points = [[float(x), float(y), v] for x, y in camera.project(joints)]
    return {"camera": camera.id, "points": points}


def test_two_views_fill_the_third(client, sequence_id, cameras, joints):
    views = [view(cameras["cam0"], joints), view(cameras["cam2"], joints, v=1)]
    answer = client.post(f"/api/v1/sequences/{sequence_id}/triangulation", json={"views": views})
    assert answer.status_code == 200, answer.text
    found = answer.json()["joints"]
    assert len(found) == 21
    for joint, there in enumerate(found):
        assert there["refusal"] == ""
        np.testing.assert_allclose(there["point"], joints[joint], atol=1e-6)
        assert there["angle_deg"] > 20 and 0 < there["std_mm"] < 10
        by_camera = {one["camera"]: one for one in there["views"]}
        assert list(by_camera) == ["cam0", "cam1", "cam2"]
        suggested = by_camera["cam1"]
        expected = cameras["cam1"].project(joints[joint][None])[0]
        np.testing.assert_allclose([suggested["x"], suggested["y"]], expected, atol=1e-3)
        assert suggested["is_seen"] and not suggested["is_used"]
        assert suggested["residual_px"] is None and suggested["left_out_px"] is None
        assert by_camera["cam0"]["is_used"] and by_camera["cam0"]["residual_px"] < 1e-2
        assert by_camera["cam0"]["left_out_px"] is None, "one other view makes no point"
    assert client.get(f"/api/v1/sequences/{sequence_id}/annotations").json()["items"] == []


def test_a_wrong_mark_is_named(client, sequence_id, cameras, joints):
    views = [view(camera, joints) for camera in cameras.values()]
    views[1]["points"][8][0] += 3.0
    views[1]["points"][8][1] += 4.0
    found = client.post(f"/api/v1/sequences/{sequence_id}/triangulation", json={"views": views}).json()["joints"]
    left_out = [[one["left_out_px"] for one in joint["views"]] for joint in found]
    assert left_out[8][1] == pytest.approx(5.0, abs=0.02)
    assert max(max(values) for joint, values in enumerate(left_out) if joint != 8) < 0.01
    assert max(one["residual_px"] for one in found[8]["views"]) > 1.0


def test_a_joint_that_is_not_marked_twice_says_so(client, sequence_id, cameras, joints):
    views = [view(cameras["cam0"], joints), view(cameras["cam1"], joints)]
    views[1]["points"][3] = [0, 0, 0]
    found = client.post(f"/api/v1/sequences/{sequence_id}/triangulation", json={"views": views}).json()["joints"]
    assert found[3]["refusal"] == "Marked in 1 of the views; two are needed."
    assert found[3]["point"] is None and found[3]["angle_deg"] is None and found[3]["std_mm"] is None
    assert all(one["x"] is None and not one["is_seen"] for one in found[3]["views"])
    assert found[4]["refusal"] == ""


def test_views_that_make_no_sense_are_refused(client, sequence_id, cameras, joints):
    good, path = view(cameras["cam0"], joints), f"/api/v1/sequences/{sequence_id}/triangulation"

    def send(views) -> tuple[int, str]:
        answer = client.post(path, json={"views": views})
        return answer.status_code, answer.json()["detail"]

    assert send([good, good]) == (
        422,
        "A camera is named twice. Send one view for each camera: all its 21 joints together.",
    )
    status, detail = send([good | {"camera": "cam7"}])
    assert status == 422 and "no camera 'cam7'; it has cam0, cam1, cam2" in detail
    for bad in ([], [good] * 17, [good | {"points": good["points"][:20]}], [good | {"points": [[1e9, 0, 2]] * 21}]):
        assert send(bad)[0] == 422
    assert client.post(f"/api/v1/sequences/{uuid.uuid4()}/triangulation", json={"views": [good]}).status_code == 404


def test_marks_at_the_ends_of_the_earth_are_answered(client, sequence_id, cameras):
    far = [[1e6, -1e6, 2], [-1e6, 1e6, 1], *[[0.0, 0.0, 2]] * 19]
    views = [{"camera": name, "points": far} for name in cameras]
    answer = client.post(f"/api/v1/sequences/{sequence_id}/triangulation", json={"views": views})
    assert answer.status_code == 200
    assert all((joint["point"] is None) == bool(joint["refusal"]) for joint in answer.json()["joints"])


def test_an_answer_takes_some_milliseconds(client, sequence_id, cameras, joints):
    views = [view(camera, joints) for camera in cameras.values()]
    times = []
    for _ in range(6):
        began = time.process_time()
        client.post(f"/api/v1/sequences/{sequence_id}/triangulation", json={"views": views})
        times.append(time.process_time() - began)
    assert min(times) < 0.1
