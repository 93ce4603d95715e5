"""The viewer's page and socket under the studio's address: nothing else of this machine, and no tunnel."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from http.server import BaseHTTPRequestHandler, HTTPServer

import msgspec.msgpack
import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient
from starlette.websockets import WebSocket, WebSocketDisconnect
from websockets.sync.server import ServerConnection, serve

from server.errors import NotFoundError
from server.viewer import proxy
from server.viewer.link import ViewerUnavailableError
from server.viewer.proxy import HIDDEN_PANEL, fetch_page, is_refused, relay

PAGE = b"<html><head><title>x</title></head><body></head></body></html>"
NOBODY = 9
"""A port where nothing listens."""


class Files(BaseHTTPRequestHandler):
    """A page, a picture and nothing else."""

    def do_GET(self) -> None:
        kinds = {"/": ("text/html; charset=utf-8", PAGE), "/a b.png": ("image/png", b"png")}
        kind, body = kinds.get(self.path.replace("%20", " "), ("text/plain", b"secret"))
        self.send_response(200 if body != b"secret" else 404)
        self.send_header("Content-Type", kind)
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, *words: object) -> None:
        pass


@pytest.fixture(scope="module")
def port() -> Iterator[int]:
    made = HTTPServer(("127.0.0.1", 0), Files)
    thread = threading.Thread(target=made.serve_forever, kwargs={"poll_interval": 0.01})
    thread.start()
    yield made.server_port
    made.shutdown()
    thread.join()
    made.server_close()


def test_the_page_hides_the_viewers_own_panel_once_and_may_talk_to_the_studio_alone(port: int) -> None:
    answer = fetch_page(port, "")
    assert answer.body == PAGE.replace(b"</head>", HIDDEN_PANEL.encode() + b"</head>", 1)
    policy = dict(part.split(" ", 1) for part in answer.headers["content-security-policy"].split("; "))
    assert policy["default-src"] == "'none'" and policy["connect-src"] == "'self' data: blob:"
    assert not any("http" in value or "*" in value for value in policy.values())


def test_another_file_comes_as_it_is(port: int) -> None:
    answer = fetch_page(port, "a b.png")
    assert (answer.body, answer.headers["content-type"]) == (b"png", "image/png")


@pytest.mark.parametrize("path", ["..", "a/../b", "..\\b", "a\\..\\b", "\0", "unknown.js"])
def test_what_is_no_file_of_the_viewer_is_not_found_and_tells_nothing(port: int, path: str) -> None:
    with pytest.raises(NotFoundError, match="There is no such file in the viewer"):
        fetch_page(port, path)


def test_a_name_with_two_dots_in_it_is_no_way_up(port: int) -> None:
    with pytest.raises(ViewerUnavailableError, match="The viewer does not answer"):
        fetch_page(NOBODY, "a..b")


@pytest.mark.parametrize(
    ("message", "refused"),
    [
        (msgspec.msgpack.encode({"type": "ViewerCameraMessage"}), False),
        (msgspec.msgpack.encode({"no": "type"}), False),
        (msgspec.msgpack.encode({"type": "ShareUrlRequest"}), True),
        (msgspec.msgpack.encode({"type": "ShareUrlDisconnect"}), True),
        (msgspec.msgpack.encode(["ShareUrlRequest"]), True),
        (b"\xc1", True),
        (b"", True),
    ],
)
def test_messages_that_open_tunnels_or_cannot_be_read_are_refused(message: bytes, refused: bool) -> None:
    assert is_refused(message) == refused


@pytest.fixture
def echo() -> Iterator[int]:
    """A socket that gives back what it gets, and ends at the message `end`."""

    def answer(connection: ServerConnection) -> None:
        for message in connection:
            if message == msgspec.msgpack.encode({"type": "end"}):
                connection.close(4001, "done")
                return
            connection.send(message)

    with serve(answer, "127.0.0.1", 0, subprotocols=["viser-v1.2"]) as server:  # type: ignore[list-item]
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        yield server.socket.getsockname()[1]
        server.shutdown()
        thread.join()


def browse(port: int) -> TestClient:
    app = FastAPI()

    @app.websocket("/")
    async def carry(socket: WebSocket) -> None:
        await relay(socket, port)

    return TestClient(app)


def say(**content: object) -> bytes:
    return msgspec.msgpack.encode(content)


def test_messages_go_both_ways_in_order_without_those_that_are_refused(echo: int, monkeypatch) -> None:
    monkeypatch.setattr(proxy, "MAX_MESSAGE", 100)
    with browse(echo).websocket_connect("/", subprotocols=["chat", "viser-v1.2"]) as socket:
        assert socket.accepted_subprotocol == "viser-v1.2", "a protocol of the viewer, no other"
        for message in (say(n=1), say(type="ShareUrlRequest"), b"\xc1", say(n="x" * 100), say(n=2)):
            socket.send_bytes(message)
        assert [socket.receive_bytes(), socket.receive_bytes()] == [say(n=1), say(n=2)]
        socket.send_bytes(say(type="end"))
        with pytest.raises(WebSocketDisconnect) as ended:
            socket.receive_bytes()
    assert (ended.value.code, ended.value.reason) == (4001, "done")


def test_where_no_viewer_listens_the_browser_is_told_to_try_later() -> None:
    with pytest.raises(WebSocketDisconnect) as refused, browse(NOBODY).websocket_connect("/"):
        pass
    assert refused.value.code == 1013
