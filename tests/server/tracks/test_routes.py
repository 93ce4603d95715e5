"""Tracks over REST."""

from __future__ import annotations

import io
import uuid

import cv2
import numpy as np
import pytest
from fastapi.testclient import TestClient

from tests.server.conftest import Studio, Tracked
from tracker import EXPORT_KINDS

API = "/api/v1"


@pytest.fixture
def address(tracked: Tracked) -> str:
    return f"{API}/tracks/{tracked.track_id}"


def test_a_track_tells_what_it_is_and_its_recording_names_it_as_its_best(
    client: TestClient, tracked: Tracked, address: str
) -> None:
    track = client.get(address).json()
    assert (track["frame_first"], track["frame_count"], track["hands"]) == (0, 12, ["right"])
    assert track["summary"]["frames"] == 12
    assert client.get(f"{API}/tracks", params={"sequence_id": str(tracked.sequence_id)}).json()["items"] == [track]
    recording = client.get(f"{API}/sequences/{tracked.sequence_id}").json()
    assert recording["best_track"]["id"] == track["id"]


def test_columns_have_a_value_for_every_frame(client: TestClient, address: str) -> None:
    columns = client.get(f"{address}/frames").json()
    assert columns["frame"] == list(range(12))
    assert set(columns["status"]) == {"ok"}
    for name in ("seconds", "depth_residual_mm", "silhouette_iou", "iterations"):
        assert len(columns[name]) == 12
    assert all(len(column) == 12 for column in (*columns["costs"].values(), *columns["stages"].values()))
    assert [term["name"] for term in columns["terms"]] == list(columns["costs"])
    looks = {term["name"]: term for term in columns["terms"]}
    assert looks["model_to_data"]["label"] == "Model to data"
    assert looks["data_to_model"]["dash"] == [6, 3]
    assert columns["views"] == [], "one depth camera is compared with no other"


def test_the_energy_of_a_frame_is_told_by_term_and_iteration(client: TestClient, address: str) -> None:
    columns = client.get(f"{address}/frames").json()
    for frame in (0, 5):
        energy = client.get(f"{address}/frames/{frame}/energy").json()
        assert (energy["frame"], energy["is_recorded"]) == (frame, True)
        assert energy["iterations"] == columns["iterations"][frame]
        had_part = {term for term, costs in columns["costs"].items() if costs[frame] is not None}
        assert energy["costs"].keys() == had_part
        for term, costs in energy["costs"].items():
            assert len(costs) == energy["iterations"]
            assert np.isclose(costs[-1], columns["costs"][term][frame], rtol=1e-6), "the last is what the frames have"
    assert sum(costs[0] for costs in energy["costs"].values()) > sum(costs[-1] for costs in energy["costs"].values())
    assert columns["costs"]["marks_right"][5] is None, "marks are of the first frame only"
    assert client.get(f"{address}/frames/12/energy").status_code == 404


def test_a_track_from_before_iterations_were_recorded_says_so(
    client: TestClient, studio: Studio, tracked: Tracked, address: str
) -> None:
    path = studio.app.state.storage.folder("tracks", tracked.track_id) / "frames.npz"
    with np.load(path) as arrays:
        old = {name: arrays[name] for name in arrays.files if name != "iteration_costs"}
    np.savez(path, **old)
    energy = client.get(f"{address}/frames/5/energy").json()
    assert energy == {"frame": 5, "is_recorded": False, "iterations": 0, "costs": {}}
    assert client.get(f"{address}/frames").json()["iterations"][5] == 10


def test_joints_lie_where_the_downloaded_track_has_them(client: TestClient, address: str) -> None:
    answer = client.get(f"{address}/files/track.npz")
    assert "attachment" in answer.headers["content-disposition"]
    arrays = np.load(io.BytesIO(answer.content))
    joints = client.get(f"{address}/joints", params={"camera": "cam0"}).json()
    assert joints["joint_names"] == arrays["joint_names"].tolist()
    assert np.allclose(joints["points"], arrays["joints_2d"][:, 0], atol=1e-3)
    assert client.get(f"{address}/joints", params={"camera": "cam7"}).status_code == 404
    assert client.get(f"{address}/files/summary.json").json()["frames"] == 12
    assert client.get(f"{address}/files/setup.json").status_code == 422
    assert client.get(f"{address}/files/..%2ftrack.npz").status_code in (404, 422)


def test_the_overlay_covers_the_joints_and_is_drawn_once(client: TestClient, address: str) -> None:
    answer = client.get(f"{address}/cameras/cam0/frames/5/overlay.png")
    assert answer.headers["content-type"] == "image/png"
    assert "immutable" in answer.headers["cache-control"]
    image = cv2.imdecode(np.frombuffer(answer.content, np.uint8), cv2.IMREAD_UNCHANGED)
    assert image.shape[2] == 4
    points = np.array(client.get(f"{address}/joints").json()["points"][5])
    middle = np.round(points[9]).astype(int)  # middle_mcp
    assert image[middle[1], middle[0], 3] > 0
    assert image[0, 0, 3] == 0
    blue, _, red = image[middle[1], middle[0], :3].astype(int)
    assert red > blue, "a right hand is orange"
    assert client.get(f"{address}/cameras/cam0/frames/5/overlay.png").content == answer.content
    assert client.get(f"{address}/cameras/cam0/frames/12/overlay.png").status_code == 404
    assert client.get(f"{address}/cameras/cam1/frames/5/overlay.png").status_code == 404


def test_what_is_unknown_is_drawn_in_one_colour_apart_from_the_meshes(client: TestClient, address: str) -> None:
    answer = client.get(f"{address}/cameras/cam0/frames/5/unknown.png")
    assert answer.status_code == 200 and "immutable" in answer.headers["cache-control"]
    image = cv2.imdecode(np.frombuffer(answer.content, np.uint8), cv2.IMREAD_UNCHANGED)
    assert image.shape == (480, 640, 4)
    marked = image[image[..., 3] > 0]
    assert (marked == (149, 101, 240, 165)).all()
    assert len(marked) < 1000, "a bare hand: no more than its rims"
    mesh = client.get(f"{address}/cameras/cam0/frames/5/overlay.png").content
    assert answer.content != mesh
    assert client.get(f"{address}/cameras/cam0/frames/5/unknown.png").content == answer.content
    for gone in ("cam0/frames/12", "cam1/frames/5"):
        assert client.get(f"{address}/cameras/{gone}/unknown.png").status_code == 404


def test_a_track_is_exported_for_other_programs(client: TestClient, studio: Studio, tracked: Tracked) -> None:
    address = f"{API}/tracks/{tracked.track_id}"
    answers = {kind: client.get(f"{address}/export/{kind}") for kind in EXPORT_KINDS}
    assert {answer.status_code for answer in answers.values()} == {200}
    for kind, answer in answers.items():
        name = answer.headers["content-disposition"]
        assert name.startswith('attachment; filename="') and name.endswith(f'-Track_1-{EXPORT_KINDS[kind]}"')
    assert answers["npz"].content == client.get(f"{address}/files/track.npz").content
    assert answers["csv"].headers["content-type"] == "text/csv; charset=utf-8"
    assert len(answers["csv"].text.splitlines()) == 1 + 12 * 21
    assert answers["glb"].headers["content-type"] == "model/gltf-binary"
    assert answers["glb"].content[:4] == b"glTF"
    with np.load(io.BytesIO(answers["mano"].content), allow_pickle=False) as arrays:
        assert arrays["right_hand_pose"].shape == (12, 45)
    assert client.get(f"{address}/export/glb").content == answers["glb"].content
    kept = studio.app.state.storage.folder("tracks", tracked.track_id) / "exports"
    assert sorted(path.name for path in kept.iterdir()) == sorted(f"1-{name}" for name in EXPORT_KINDS.values())


def test_what_cannot_be_exported_is_refused_with_the_reason(
    client: TestClient, studio: Studio, tracked: Tracked, address: str
) -> None:
    assert client.get(f"{API}/tracks/{uuid.uuid4()}/export/csv").status_code == 404
    assert client.get(f"{address}/export/fbx").status_code == 422
    folder = studio.app.state.storage.folder("tracks", tracked.track_id)
    (folder / "track.npz").write_bytes(b"damaged")
    refused = client.get(f"{address}/export/glb")
    assert refused.status_code == 422
    assert "needed an npz file as tracking writes it" in refused.json()["detail"]
    assert str(studio.settings.data_dir) not in refused.text


def test_a_deleted_track_is_gone_until_it_is_restored(client: TestClient, tracked: Tracked, address: str) -> None:
    assert client.delete(address).status_code == 200
    assert client.get(address).status_code == 404
    assert client.get(f"{API}/tracks").json()["items"] == []
    assert client.get(f"{API}/sequences/{tracked.sequence_id}").json()["best_track"] is None
    assert client.post(f"{address}/restore").status_code == 200
    assert client.get(address).status_code == 200
    assert client.post(f"{API}/tracks/{uuid.uuid4()}/restore").status_code == 404
