"""The list of all requests, with who may make them: what the routes say of themselves, as a page."""

from __future__ import annotations

import re
from collections import defaultdict
from typing import Any

from fastapi.dependencies.models import Dependant
from fastapi.routing import APIRoute

from server.access.models import ROLES, Role
from server.access.service import RequireRole
from server.app.app import API
from server.app.authentication import OPEN
from server.app.parts import ROUTERS

HEAD = """# All requests

Below `/api/v1`. `from` is the lowest role that may make a request: annotator (everybody who is logged in), reviewer,
lead, admin; `all` needs no login. `make api` writes this page.
"""


def find_role(route: APIRoute) -> Role:
    """The role that a route asks for: the highest of its dependencies."""
    needed: list[Role] = ["annotator"]

    def walk(dependant: Dependant) -> None:
        if isinstance(dependant.call, RequireRole):
            needed.append(dependant.call.role)
        for inner in dependant.dependencies:
            walk(inner)

    walk(route.dependant)
    return max(needed, key=ROLES.index)


def find_roles() -> dict[tuple[str, str], Role]:
    """The role that each method of each address below `/api/v1` asks for."""
    routes = (route for router in ROUTERS for route in router.routes if isinstance(route, APIRoute))
    return {(method, API + route.path): find_role(route) for route in routes for method in route.methods or ()}


def write_requests_page(document: dict[str, Any]) -> str:
    """Markdown with a table for each tag of an OpenAPI document."""
    roles, tables = find_roles(), defaultdict(list)
    for path, item in document["paths"].items():
        for name, operation in item.items():
            method = name.upper()
            role = "all" if (method, path) in OPEN else roles[method, path]
            says = re.sub(r"\s+", " ", operation["description"].partition("\n\n")[0]).replace("|", "\\|")
            tables[operation["tags"][0]].append(f"| `{method} {path.removeprefix(API)}` | {role} | {says} |")
    parts = [
        "\n".join([f"## {tag[0].upper()}{tag[1:]}", "", "| request | from | does |", "|---|---|---|", *rows])
        for tag, rows in sorted(tables.items())
    ]
    return "\n\n".join([HEAD.strip(), *parts]) + "\n"
