"""The page of all requests says what the routes do and who may make them."""

from __future__ import annotations

import re
from pathlib import Path

from server.app.requests_page import find_roles, write_requests_page
from tests.server.api_document import read_document

PAGE = Path(__file__).parents[3] / "web" / "src" / "api" / "requests.md"


def test_the_committed_page_is_what_the_routes_say() -> None:
    """After a route, a role or its words changed: `make api`."""
    assert PAGE.read_text() == write_requests_page(read_document())


def test_every_request_of_the_api_is_listed_once_and_no_other() -> None:
    offered = {
        f"{method.upper()} {path.removeprefix('/api/v1')}"
        for path, item in read_document()["paths"].items()
        for method in item
    }
    listed = re.findall(r"^\| `([A-Z]+ /\S*)` \| \w+ \| .+ \|$", PAGE.read_text(), re.MULTILINE)
    assert len(listed) == len(set(listed))
    assert set(listed) == offered


def test_a_role_is_the_highest_that_a_route_asks_for() -> None:
    roles = find_roles()
    assert roles["GET", "/api/v1/sequences"] == "annotator"
    assert roles["POST", "/api/v1/jobs"] == "reviewer"
    assert roles["POST", "/api/v1/accounts"] == "lead"
