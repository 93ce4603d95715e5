"""What goes over the wire packed, and what does not."""

from __future__ import annotations

import gzip
import json
from collections.abc import AsyncIterator

import pytest
from fastapi.testclient import TestClient
from starlette.applications import Starlette
from starlette.datastructures import Headers
from starlette.responses import JSONResponse, Response, StreamingResponse
from starlette.routing import Route

from server.app.compression import LEAST_BYTES, Compression, find_codings
from server.settings import Settings


@pytest.fixture
def settings(sqlite_settings: Settings) -> Settings:
    """One database will do: nothing here depends on it."""
    return sqlite_settings


def test_a_long_answer_is_packed_for_those_who_take_it(client: TestClient) -> None:
    for accepted, coding in (("gzip", "gzip"), ("br, gzip;q=0.5", "gzip"), ("identity", None), ("gzip;q=0", None)):
        with client.stream("GET", "/api/v1/openapi.json", headers={"Accept-Encoding": accepted}) as answer:
            sent = b"".join(answer.iter_raw())
        assert answer.headers.get("content-encoding") == coding, accepted
        assert answer.headers["vary"] == "Accept-Encoding"
        assert int(answer.headers["content-length"]) == len(sent)
        assert json.loads(gzip.decompress(sent) if coding else sent)["info"]["title"] == "Handloom"
        assert coding is None or len(sent) < 100_000


def test_short_answers_pictures_and_streams_go_as_they_are() -> None:
    async def say(_: object) -> AsyncIterator[bytes]:
        yield b"data: 1\n\n"
        yield b"data: 2\n\n" * LEAST_BYTES

    text = "x" * LEAST_BYTES
    routes = [
        Route("/short", lambda _: JSONResponse("x")),
        Route("/picture", lambda _: Response(text, media_type="image/jpeg")),
        Route("/depth", lambda _: Response(text, media_type="application/octet-stream")),
        Route("/events", lambda request: StreamingResponse(say(request), media_type="text/event-stream")),
        Route("/pieces", lambda request: StreamingResponse(say(request), media_type="text/csv")),
        Route("/same", lambda _: Response(status_code=304, headers={"ETag": '"1"'})),
        Route("/packed", lambda _: Response(text, media_type="text/csv", headers={"Content-Encoding": "identity"})),
    ]
    client = TestClient(Compression(Starlette(routes=routes)))
    for route in routes:
        answer = client.get(route.path, headers={"Accept-Encoding": "gzip"})
        assert answer.headers.get("content-encoding", "identity") == "identity", route.path
        assert answer.is_success or answer.status_code == 304


def test_what_a_browser_takes() -> None:
    assert find_codings(Headers({"Accept-Encoding": "gzip, deflate;q=0.5, BR ;q=0"})) == {"gzip", "deflate"}
    assert find_codings(Headers({})) == set()
