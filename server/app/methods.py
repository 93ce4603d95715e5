"""What may be asked of an address: any other method is answered by 405, with all that there are in `Allow`.

FastAPI looks for a route of the method first. So it would take `GET /jobs/batch` for the job called `batch`, and of an
address with several methods its 405 names one alone.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, field

from fastapi import APIRouter
from fastapi.routing import APIRoute
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.types import ASGIApp, Receive, Scope, Send

from server.app.error_handler import answer_error

_HOLE = re.compile(r"\{[^}]*\}")


@dataclass
class _Segment:
    """A segment of addresses: what may stand behind it, and the methods of the address that ends here."""

    named: dict[str, _Segment] = field(default_factory=dict)
    patterns: dict[str, tuple[re.Pattern[str], _Segment]] = field(default_factory=dict)
    methods: set[str] = field(default_factory=set)

    def step(self, segment: str) -> _Segment:
        """The segment that follows here as a route writes it; made when it is new."""
        if not _HOLE.search(segment):
            return self.named.setdefault(segment, _Segment())
        pattern = "[^/]+".join(re.escape(part) for part in _HOLE.split(segment))
        return self.patterns.setdefault(pattern, (re.compile(pattern), _Segment()))[1]

    def find(self, segments: list[str]) -> set[str]:
        """Methods of the address whose segments follow: of those that fit, the one that says most in words."""
        if not segments:
            return self.methods
        head, *rest = segments
        if head in self.named and (found := self.named[head].find(rest)):
            return found
        for pattern in sorted(self.patterns, key=len, reverse=True):
            known, behind = self.patterns[pattern]
            if known.fullmatch(head) and (found := behind.find(rest)):
                return found
        return set()


def list_methods(prefix: str, routers: tuple[APIRouter, ...]) -> _Segment:
    """All addresses of these routers."""
    root = _Segment()
    for route in _find_routes(routers):
        place = root
        for segment in f"{prefix}{route.path_format}".strip("/").split("/"):
            place = place.step(segment)
        place.methods |= set(route.methods or ())
    return root


def _find_routes(routers: Iterable[APIRouter]) -> Iterable[APIRoute]:
    return (route for router in routers for route in router.routes if isinstance(route, APIRoute))


class Methods:
    """Stands before the routes and answers methods that an address does not offer."""

    def __init__(self, app: ASGIApp, prefix: str, routers: tuple[APIRouter, ...]) -> None:
        self.app = app
        self.addresses = list_methods(prefix, routers)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] == "http":
            methods = self.addresses.find(scope["path"].strip("/").split("/"))
            if methods and scope["method"] not in methods:
                refusal = HTTPException(405, headers={"Allow": ", ".join(sorted(methods))})
                await answer_error(Request(scope), refusal)(scope, receive, send)
                return
        await self.app(scope, receive, send)
