"""The viewer through the studio: its page, its socket, and who may not have them."""

from __future__ import annotations

import os
import signal
import time
import uuid
from collections.abc import Iterator
from typing import Any

import msgspec.msgpack
import pytest
import viser
from fastapi.testclient import TestClient
from starlette.testclient import WebSocketTestSession
from starlette.websockets import WebSocketDisconnect
from zstandard import ZstdDecompressor

from server.viewer import sessions
from server.viewer.sessions import ViewerSessions

PROTOCOL = f"viser-v{viser.__version__}"
ORIGIN = {"Origin": "http://127.0.0.1:8000"}


@pytest.fixture
def view(client: TestClient, tracked) -> dict[str, Any]:
    answer = client.post("/api/v1/viewer-sessions", json={"track_id": str(tracked.track_id)})
    assert answer.status_code == 201, answer.text
    return answer.json()


def read_messages(raw: bytes) -> list[dict[str, Any]]:
    """Messages of one window of viser's wire format: two lengths, packed messages, then the arrays."""
    packed_length = int.from_bytes(raw[8:16], "little")
    packed = ZstdDecompressor().decompress(raw[16 : 16 + packed_length])
    return [dict(message) for message in msgspec.msgpack.decode(packed)["messages"]]


def connect(client: TestClient, view: dict[str, Any], **headers: str) -> WebSocketTestSession:
    """A socket as the page opens it: without the slash at the end."""
    url = f"ws://127.0.0.1:8000{view['url'].rstrip('/')}"
    return client.websocket_connect(url, subprotocols=[PROTOCOL], headers={**ORIGIN, **headers})


def read_scene(socket) -> dict[str, dict[str, Any]]:
    """Scene nodes by name, as sent to a browser that has just come."""
    nodes: dict[str, dict[str, Any]] = {}
    while True:
        for message in read_messages(socket.receive_bytes()):
            if message["type"] == "ReplayDoneMessage":
                return nodes
            if "props" in message and str(message.get("name", "")).startswith("/"):
                nodes[message["name"]] = message


def show(client: TestClient, view: dict[str, Any], **body: Any) -> dict[str, Any]:
    answer = client.put(f"/api/v1/viewer-sessions/{view['id']}", json=body)
    assert answer.status_code == 200, answer.text
    return answer.json()


def test_a_browser_gets_the_page_and_the_scene_through_the_studio(client: TestClient, view) -> None:
    page = client.get(view["url"])
    assert page.status_code == 200
    assert "<title>Viser</title>" in page.text
    assert "[data-floating-window]" in page.text, "viser's own panel is hidden"
    assert "default-src 'none'" in page.headers["content-security-policy"]
    bare = view["url"].rstrip("/")
    assert client.get(bare, follow_redirects=False).headers["location"] == view["url"]
    with connect(client, view) as socket:
        assert socket.accepted_subprotocol == PROTOCOL
        nodes = read_scene(socket)
    assert {"/cloud", "/mesh/right"} <= nodes.keys()
    assert nodes["/cloud"]["props"]["precision"] == "float32"
    assert tuple(nodes["/mesh/right"]["props"]["color"]) == (255, 146, 43)


def test_layers_come_when_they_are_asked_for(client: TestClient, view) -> None:
    answer = show(client, view, frame=3, show={"skeleton": True, "correspondences": True, "cloud": False})
    assert answer["frame"] == 3
    terms = {term["name"]: term["count"] for term in answer["terms"]}
    assert all(terms[name] > 0 for name in ("model_to_data", "data_to_surface", "data_to_model"))
    assert terms["collision"] == 0, "an open hand"
    with connect(client, view) as socket:
        nodes = read_scene(socket)
    assert {"/skeleton/right/joints", "/skeleton/right/bones"} <= nodes.keys()
    assert {f"/correspondences/{term}" for term, count in terms.items() if count > 0} <= nodes.keys()


def test_one_term_can_be_hidden(client: TestClient, view) -> None:
    assert view["terms"] == [], "nothing is looked for that nobody wants to see"
    terms = ("model_to_data", "data_to_surface")
    answer = show(client, view, show={"correspondences": {terms[0]: True, terms[1]: False}})
    assert set(terms) <= {term["name"] for term in answer["terms"]}
    with connect(client, view) as socket:
        nodes = read_scene(socket)
    assert f"/correspondences/{terms[0]}" in nodes
    assert f"/correspondences/{terms[1]}" not in nodes


def test_evidence_is_worked_out_when_it_is_asked_for_also_where_the_run_did_without(client: TestClient, view) -> None:
    layers = ("detections", "collisions", "contacts", "unknown", "distances")
    assert all(view[layer] is None for layer in layers)
    answer = show(client, view, frame=2, show=dict.fromkeys(layers, True))
    assert [answer[layer]["is_of_run"] for layer in layers[:3]] == [True, True, False], "the run had no physics"
    items = answer["detections"]["items"]
    assert len(items) >= 3
    assert all(item["hand"] == "right" and item["distance_mm"] < 15.0 for item in items if item["finger"])
    assert len({item["finger"] for item in items if item["finger"]}) >= 3
    assert answer["detections"]["own_detector"] is None
    assert answer["contacts"]["object"] is None, "there is nothing to hold"
    unknown = answer["unknown"]
    assert unknown["by_color"] and unknown["color"] == "#f06595"
    assert 0 <= unknown["before"] <= unknown["pixels"] < 1000, "a bare hand: no more than its rims"
    (hand,) = answer["distances"]["models"]
    assert 0.2 < hand["visible_share"] < 0.8
    assert hand["median_mm"] < 2.0
    with connect(client, view) as socket:
        nodes = read_scene(socket)
    assert {"/detections/marks", "/detections/boxes", "/detections/links", "/distances/right"} <= nodes.keys()
    assert ("/unknown" in nodes) == (unknown["pixels"] > 0)
    labels = [node["props"]["text"] for name, node in nodes.items() if name.startswith("/detections/label-")]
    assert len(labels) == len(items)
    again = show(client, view, show=dict.fromkeys(layers, False))
    assert all(again[layer] is None for layer in layers)


def test_the_cameras_stand_where_they_are(client: TestClient, view) -> None:
    with connect(client, view) as socket:
        assert not any(name.startswith("/cameras") for name in read_scene(socket))
    show(client, view, show={"cameras": True})
    with connect(client, view) as socket:
        nodes = read_scene(socket)
    assert {"/cameras/cam0/outline", "/cameras/cam0/label"} <= nodes.keys()
    assert "/cameras/cam0/rays" not in nodes, "a depth camera saw no joints along rays"


def test_a_connected_browser_is_told_of_another_frame(client: TestClient, view) -> None:
    with connect(client, view) as socket:
        read_scene(socket)
        show(client, view, frame=5)
        updated: set[str] = set()
        while "/mesh/right" not in updated:
            updated |= {str(message.get("name")) for message in read_messages(socket.receive_bytes())}


def test_a_frame_that_the_track_does_not_hold_shows_the_nearest(client: TestClient, view) -> None:
    assert show(client, view, frame=400)["frame"] == 11


def test_playing_on_is_answered_from_prepared_frames(client: TestClient, view) -> None:
    for frame in range(1, 4):
        show(client, view, frame=frame)
    time.sleep(1.5)
    assert show(client, view, frame=4)["milliseconds"] < 50.0


@pytest.mark.parametrize("origin", ["https://evil.example", "http://127.0.0.1:9999", "null"])
def test_a_foreign_page_gets_no_socket(client: TestClient, view, origin: str) -> None:
    with (
        pytest.raises(WebSocketDisconnect) as refused,
        connect(client, view, Origin=origin) as socket,
    ):
        socket.receive_bytes()
    assert refused.value.code == 1008


def test_a_foreign_host_gets_neither_page_nor_socket(client: TestClient, view) -> None:
    assert client.get(view["url"], headers={"Host": "rebound.example"}).status_code == 403
    with (
        pytest.raises(WebSocketDisconnect),
        connect(client, view, Host="rebound.example") as socket,
    ):
        socket.receive_bytes()


@pytest.mark.parametrize(
    "path", ["%2e%2e%2f%2e%2e%2fetc%2fhostname", "%2e%2e/%2e%2e/etc/hostname", "..%5c..%5cetc", "assets/none.js", "%00"]
)
def test_no_file_but_the_viewers_own_can_be_read(client: TestClient, view, path: str) -> None:
    assert client.get(view["url"] + path).status_code in (404, 400)


def test_nobody_can_open_a_public_tunnel(client: TestClient, view) -> None:
    from server.viewer.proxy import is_refused

    assert is_refused(msgspec.msgpack.encode({"type": "ShareUrlRequest"}))
    assert is_refused(b"\xc1not msgpack")
    with connect(client, view) as socket:
        read_scene(socket)
        socket.send_bytes(msgspec.msgpack.encode({"type": "ShareUrlRequest"}))
        show(client, view, frame=2)
        kinds = {message["type"] for message in read_messages(socket.receive_bytes())}
    assert "ShareUrlUpdated" not in kinds


def test_the_scene_itself_ignores_a_request_for_a_tunnel(studio, tracked_folder, rendered) -> None:
    from viser import _messages

    from server.viewer.scene import ViewerScene
    from tracker import load_sequence, load_track
    from tracker.inspection import describe_frame

    sequence, track = load_sequence(rendered), load_track(tracked_folder)
    view = describe_frame(sequence, track.setup, track.pose[0], 0)
    scene = ViewerScene(sequence.cameras[0], view.models[0].vertices.mean(axis=0), dark=True)
    try:
        handlers = scene.server._websock_server._incoming_handlers
        assert not handlers.get(_messages.ShareUrlRequest)
        assert scene.server.get_host() == "127.0.0.1"
    finally:
        scene.close()


def test_what_is_not_there_is_said_to_be_gone(client: TestClient, view, tracked) -> None:
    assert client.post("/api/v1/viewer-sessions", json={"track_id": str(uuid.uuid4())}).status_code == 404
    assert client.delete(f"/api/v1/viewer-sessions/{view['id']}").status_code == 204
    assert client.delete(f"/api/v1/viewer-sessions/{view['id']}").status_code == 204
    answer = client.put(f"/api/v1/viewer-sessions/{view['id']}", json={"frame": 1})
    assert answer.status_code == 404
    assert answer.json()["detail"] == "This view is closed. Open it again."
    assert client.get(view["url"]).status_code == 404


def test_the_least_used_session_makes_room_and_an_idle_one_is_closed(
    client: TestClient, studio, tracked, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sessions, "MAX_SESSIONS", 2)
    body = {"track_id": str(tracked.track_id)}
    first, second, third = (client.post("/api/v1/viewer-sessions", json=body).json() for _ in range(3))
    assert client.get(first["url"]).status_code == 404
    assert client.get(second["url"]).status_code == client.get(third["url"]).status_code == 200
    monkeypatch.setattr(sessions, "IDLE_SECONDS", 0.0)
    studio.app.state.viewer_sessions.close_idle()
    assert client.get(third["url"]).status_code == 404


def test_a_viewer_process_that_dies_is_replaced(client: TestClient, studio, tracked, view) -> None:
    process = studio.app.state.viewer_sessions._link._process
    os.kill(process.pid, signal.SIGKILL)
    process.wait(10)
    assert client.put(f"/api/v1/viewer-sessions/{view['id']}", json={"frame": 1}).status_code == 404
    again = client.post("/api/v1/viewer-sessions", json={"track_id": str(tracked.track_id)})
    assert again.status_code == 201
    assert client.get(again.json()["url"]).status_code == 200


@pytest.fixture
def lone_sessions() -> Iterator[ViewerSessions]:
    held = ViewerSessions()
    yield held
    held.stop()


def test_a_track_that_cannot_be_read_is_refused_with_the_reason(lone_sessions, tmp_path) -> None:
    from server.viewer.link import ViewerUnavailableError

    with pytest.raises(ViewerUnavailableError, match="sequence"):
        lone_sessions.open(uuid.uuid4(), tmp_path, tmp_path, None, {})


def test_the_viewer_process_ends_with_the_studio(lone_sessions, tmp_path) -> None:
    from server.viewer.link import ViewerUnavailableError

    with pytest.raises(ViewerUnavailableError):
        lone_sessions.open(uuid.uuid4(), tmp_path, tmp_path, None, {})
    process = lone_sessions._link._process
    assert process is not None
    lone_sessions.stop()
    assert process.poll() is not None
