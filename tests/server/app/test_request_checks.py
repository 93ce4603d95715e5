"""Who may talk to the studio: hosts, origins, headers."""

from __future__ import annotations

import pytest
from fastapi.testclient import TestClient
from starlette.types import Receive, Scope, Send
from starlette.websockets import WebSocket, WebSocketDisconnect

from server.access.same_origin import parse_host
from server.app import create_app
from server.app.request_checks import RequestChecks
from server.settings import Settings
from tests.server.conftest import BASE_URL

SOCKET = "ws://127.0.0.1:8000/viewer/x"
WRITE = ("POST", "/api/v1/sequences/00000000-0000-4000-8000-000000000009/restore")


@pytest.fixture
def settings(sqlite_settings: Settings) -> Settings:
    """One database will do: nothing here depends on it."""
    return sqlite_settings


@pytest.mark.parametrize(
    "host", ["127.0.0.1:8000", "localhost:8000", "LOCALHOST", "[::1]:8000", "127.0.0.1", "localhost:1"]
)
def test_the_studio_answers_on_loopback_at_any_port(client: TestClient, host: str) -> None:
    assert client.get("/api/v1/health", headers={"Host": host}).status_code == 200


@pytest.mark.parametrize(
    "host",
    [
        "evil.example",
        "evil.example:8000",
        "localhost.evil.example",
        "127.0.0.1.evil.example",
        "127.0.0.1:8000@evil.example",
        "evil.example#127.0.0.1",
        "localhost:99999",
        "localhost:port",
        "",
        "0.0.0.0:8000",
        "[::1",
    ],
)
def test_a_foreign_name_that_points_here_is_refused(client: TestClient, host: str) -> None:
    for path in ("/api/v1/health", "/", "/viewer/x/"):
        answer = client.get(path, headers={"Host": host})
        assert (answer.status_code, answer.json()["error"]) == (403, "ForbiddenError")


@pytest.mark.parametrize("origin", ["http://127.0.0.1:8000", "HTTP://127.0.0.1:8000", None])
def test_our_own_pages_and_scripts_may_write(client: TestClient, origin: str | None) -> None:
    assert client.request(*WRITE, headers={"Origin": origin} if origin else {}).status_code == 404


@pytest.mark.parametrize(
    "headers",
    [
        {"Origin": "http://evil.example"},
        {"Origin": "null"},
        {"Origin": "http://127.0.0.1:9000"},
        {"Origin": "http://localhost:8000"},
        {"Origin": "http://127.0.0.1:8000.evil.example"},
        {"Origin": ""},
        {"Sec-Fetch-Site": "cross-site"},
        {"Sec-Fetch-Site": "same-site"},
    ],
)
def test_foreign_pages_may_not_write(client: TestClient, headers: dict[str, str]) -> None:
    answer = client.request(*WRITE, headers=headers)
    assert (answer.status_code, set(answer.json())) == (403, {"error", "detail"})
    assert client.get("/api/v1/health", headers=headers).status_code == 200


def test_more_hosts_and_origins_can_be_allowed(settings: Settings) -> None:
    more = {"allowed_hosts": ("studio.lab",), "allowed_origins": ("http://localhost:5173",)}
    app = create_app(settings.model_copy(update=more))
    with TestClient(app, base_url="http://studio.lab", raise_server_exceptions=False) as client:
        assert client.get("/api/v1/health").status_code == 200
        assert client.request(*WRITE, headers={"Origin": "http://localhost:5173"}).status_code == 401
        assert client.request(*WRITE, headers={"Origin": "http://localhost:5174"}).status_code == 403


def test_every_answer_carries_the_headers(client: TestClient) -> None:
    answers = [
        client.get("/api/v1/health"),
        client.get("/"),
        client.get("/api/v1/nothing"),
        client.get("/", headers={"Host": "evil.example"}),
    ]
    for answer in answers:
        assert answer.headers["x-content-type-options"] == "nosniff"
        assert answer.headers["referrer-policy"] == "same-origin"
        assert answer.headers["cross-origin-resource-policy"] == "same-origin"
        assert "access-control-allow-origin" not in answer.headers
    policy = answers[0].headers["content-security-policy"]
    assert "frame-ancestors 'self'" in policy
    assert "script-src 'self';" in policy


def test_sockets_are_for_our_own_pages_and_hosts(settings: Settings) -> None:
    async def echo(scope: Scope, receive: Receive, send: Send) -> None:
        socket = WebSocket(scope, receive, send)
        await socket.accept()
        await socket.send_text("open")
        await socket.close()

    client = TestClient(RequestChecks(echo, settings), base_url=BASE_URL)
    for headers in ({}, {"Origin": BASE_URL}):
        with client.websocket_connect(SOCKET, headers=headers) as socket:
            assert socket.receive_text() == "open"
    for headers in ({"Origin": "http://evil.example"}, {"Origin": "null"}, {"Host": "evil.example"}):
        with pytest.raises(WebSocketDisconnect), client.websocket_connect(SOCKET, headers=headers):
            pass


def test_pages_cannot_be_made_to_load_code_from_elsewhere() -> None:
    with TestClient(create_app(Settings(database_url="sqlite://")), base_url=BASE_URL) as client:
        for path in ("/docs", "/redoc"):
            assert "cdn" not in client.get(path).text


@pytest.mark.parametrize(
    ("host", "name"),
    [("LocalHost:80", "localhost"), ("[::1]:8000", "::1"), ("a/b", None), ("u@h", None), ("h:-1", None), ("", None)],
)
def test_the_name_in_a_host_header(host: str, name: str | None) -> None:
    assert parse_host(host) == name
