"""No port without a login: every address of the API, the viewer, the streams and the files, walked over."""

from __future__ import annotations

import re
import threading
import time
import uuid
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import httpx
import pytest
import uvicorn
from fastapi import FastAPI
from fastapi.routing import APIRoute, APIWebSocketRoute
from fastapi.testclient import TestClient
from sqlalchemy import delete
from starlette.routing import BaseRoute
from starlette.websockets import WebSocketDisconnect

from server.access.models import ROLES, LoginRow, Role
from server.app import authentication, create_app
from server.app.app import API
from server.app.authentication import CLOSED_PREFIXES, OPEN
from server.app.parts import PAGE_ROUTERS, ROUTERS
from server.app.requests_page import find_role
from server.settings import Settings
from tests.server.access.conftest import Lab, lab
from tests.server.conftest import BASE_URL

__all__ = ["lab"]

NONE = "00000000-0000-4000-8000-000000000009"
SECURITY = Path(__file__).parents[3] / "docs" / "operating.md"
REQUESTS = Path(__file__).parents[3] / "web" / "src" / "api" / "requests.md"


@pytest.fixture
def settings(sqlite_settings: Settings) -> Settings:
    """One database will do: the queries behind the authentication are tested on both beside the accounts."""
    return sqlite_settings


def list_routes(app: FastAPI) -> list[tuple[str, BaseRoute]]:
    """Every route with its address, also those that are in no document."""
    own = [("", route) for route in app.router.routes if hasattr(route, "path")]
    ours = [(API, route) for router in ROUTERS for route in router.routes]
    pages = [("", route) for router in PAGE_ROUTERS for route in router.routes]
    found = own + ours + pages
    assert all(hasattr(route, "path") for _, route in found), "routers are not nested"
    return [(prefix + route.path, route) for prefix, route in found]  # type: ignore[attr-defined]


def fill(path: str) -> str:
    """An address of a route."""
    return re.sub(r"\{[^}]+\}", NONE, path)


def list_requests(app: FastAPI) -> list[tuple[str, str]]:
    """Method and address of everything that answers HTTP: of the routes and of the OpenAPI document."""
    routes = {(method, path) for path, route in list_routes(app) for method in getattr(route, "methods", None) or ()}
    documented = {(method.upper(), path) for path, item in app.openapi()["paths"].items() for method in item}
    return sorted((method, fill(path)) for method, path in routes | documented)


def test_every_address_asks_for_a_login_but_those_that_are_listed(lab: Lab) -> None:
    requests = list_requests(lab.app)
    assert len(requests) > 60
    for method, path in requests:
        answer = lab.nobody.request(method, path)
        if (method, path) in OPEN:
            assert answer.status_code in (200, 422), path
            continue
        assert answer.status_code == 401, (method, path)
        assert answer.headers["x-content-type-options"] == "nosniff"
        if method != "HEAD":
            assert answer.json()["error"] == "LoginNeededError"
        for headers in ({"Authorization": "Bearer handloom_wrong"}, {"Cookie": "handloom_login_8000=wrong"}):
            assert lab.nobody.request(method, path, headers=headers).status_code == 401, (method, path)


def test_what_is_open_is_what_the_documentation_says(lab: Lab) -> None:
    text = SECURITY.read_text().partition("## Open to all")[2].partition("\n## ")[0]
    assert {tuple(line) for line in re.findall(r"^- `(\w+) (\S+)`", text, re.MULTILINE)} == OPEN


def test_no_route_lies_beside_the_closed_addresses(lab: Lab) -> None:
    for path, _ in list_routes(lab.app):
        assert path.startswith(CLOSED_PREFIXES), path


def test_other_spellings_of_an_address_open_nothing(lab: Lab) -> None:
    """What is not matched as it stands is a page of the browser app, or not there; never data."""
    for path in (
        "/api/v1/sequences/",
        "/api/v1//sequences",
        "//api/v1/sequences",
        "/API/v1/sequences",
        "/api/v1/health/../sequences",
        "/api/v1/health%2f..%2fsequences",
        "/%61pi/v1/sequences",
        "/api/v1/login/../sequences",
        "/assets/../api/v1/sequences",
        "/..%2f..%2fetc/passwd",
        "/static/..%5c..%5cetc/passwd",
    ):
        answer = lab.nobody.get(path)
        assert "next_cursor" not in answer.text and "root:" not in answer.text, path


def test_sockets_ask_for_a_login_too(lab: Lab) -> None:
    sockets = [path for path, route in list_routes(lab.app) if isinstance(route, APIWebSocketRoute)]
    assert sockets
    for path in sockets:
        url = f"ws://127.0.0.1:8000{fill(path)}"
        with pytest.raises(WebSocketDisconnect) as refused, lab.nobody.websocket_connect(url):
            pass
        assert (refused.value.code, refused.value.reason) == (1008, "log in first")
        person = lab.person("annotator", f"somebody {uuid.uuid4().hex[:6]}")
        with pytest.raises(WebSocketDisconnect) as found, person.websocket_connect(url):
            pass
        assert found.value.reason == "no such view"
        foreign = {"Origin": "http://evil.example"}
        with pytest.raises(WebSocketDisconnect) as stranger, person.websocket_connect(url, headers=foreign):
            pass
        assert stranger.value.reason == "forbidden"


def test_a_foreign_page_does_nothing_with_the_login_of_its_visitor(lab: Lab) -> None:
    """CSRF: every address that changes something, with a cookie that is right."""
    admin = lab.person("admin")
    for method, path in list_requests(lab.app):
        if method in ("GET", "HEAD", "OPTIONS"):
            continue
        for headers in ({"Origin": "http://evil.example"}, {"Origin": "null"}, {"Sec-Fetch-Site": "cross-site"}):
            answer = admin.request(method, path, headers=headers)
            assert (answer.status_code, answer.json()["error"]) == (403, "ForbiddenError"), (method, path)


def test_the_page_of_one_person_does_not_write_as_another(lab: Lab) -> None:
    anna, ben = lab.add("Anna"), lab.add("Ben")
    client = lab.browser(ben)
    put = {"url": "/api/v1/account/preferences", "json": {}}
    refused = client.put(**put, headers={"X-Handloom-Account": str(anna)})
    assert (refused.status_code, refused.json()["error"]) == (401, "OtherAccountError")
    assert client.put(**put, headers={"X-Handloom-Account": str(ben)}).status_code == 200


def test_without_a_login_only_this_machine_is_answered(tmp_path: Path) -> None:
    app = create_app(Settings(data_dir=tmp_path))
    for address, status in (("127.0.0.1", 200), ("::1", 200), ("192.168.1.7", 401), ("10.0.0.1", 401)):
        with TestClient(app, base_url=BASE_URL, client=(address, 50000)) as client:
            assert client.get("/api/v1/account").status_code == status, address


def test_where_people_log_in_the_studio_is_reached_by_its_address_but_by_no_foreign_name(tmp_path: Path) -> None:
    app = create_app(Settings(data_dir=tmp_path, host="0.0.0.0"))
    with TestClient(app, base_url="http://192.168.1.5:8000") as client:
        assert client.get("/api/v1/health").status_code == 200
        for host in ("evil.example", "192.168.1.6:8000", "192.168.1.5.evil.example"):
            assert client.get("/api/v1/health", headers={"Host": host}).status_code == 403


# Who may what


def list_writes(app: FastAPI) -> dict[str, Role]:
    """Every request that changes something, and who may."""
    return {
        f"{method} {path.removeprefix(API)}": find_role(route)
        for path, route in list_routes(app)
        if isinstance(route, APIRoute)
        for method in route.methods
        if method not in ("GET", "HEAD") and (method, path) not in OPEN
    }


def test_who_may_what_is_what_the_documentation_says(lab: Lab) -> None:
    rows = re.findall(r"^\| `([A-Z]+ /\S+)` \| (\w+) \|", REQUESTS.read_text(), re.MULTILINE)
    documented = {request: role for request, role in rows if not request.startswith("GET ") and role != "all"}
    assert documented == list_writes(lab.app)


def test_who_has_a_lower_role_is_refused_everywhere(lab: Lab) -> None:
    people = {role: lab.person(role) for role in ROLES}
    for request, role in list_writes(lab.app).items():
        method, _, path = request.partition(" ")
        for lower in ROLES[: ROLES.index(role)]:
            answer = people[lower].request(method, f"/api/v1{fill(path)}", json={})
            # an address or a body that makes no sense may be said first; nothing is done either way
            assert answer.status_code in (403, 422), (lower, request, answer.text)


# What stays open


@contextmanager
def served(app: FastAPI) -> Iterator[str]:
    """The app on a real port."""
    server = uvicorn.Server(uvicorn.Config(app, port=0, log_config=None, timeout_graceful_shutdown=1))
    thread = threading.Thread(target=server.run, daemon=True)
    thread.start()
    ends = time.monotonic() + 30
    while not server.started and time.monotonic() < ends:
        time.sleep(0.02)
    try:
        yield f"http://127.0.0.1:{server.servers[0].sockets[0].getsockname()[1]}"
    finally:
        app.state.is_stopping = True
        server.should_exit = True
        thread.join(10)


def test_a_stream_ends_with_the_login_it_was_opened_with(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(authentication, "RECHECK_SECONDS", 0.2)
    app = create_app(Settings(data_dir=tmp_path, login="required"))
    with served(app) as url:
        lab = Lab(app, app.state.settings, TestClient(app))
        cookies = {cookie.name: cookie.value for cookie in lab.person("annotator").cookies.jar}
        with httpx.stream("GET", f"{url}/api/v1/jobs/events", cookies=cookies, timeout=20) as stream:
            pieces = stream.iter_text()
            assert "retry" in next(pieces)
            with app.state.database.writing() as session:
                session.execute(delete(LoginRow))
            began = time.monotonic()
            for _ in pieces:
                pass
            assert time.monotonic() - began < 10
