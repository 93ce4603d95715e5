"""A client of a studio over a real socket, and answers that get lost on it."""

from __future__ import annotations

import socket
import threading
from collections.abc import Iterator

import httpx
import pytest
import uvicorn

from server.client import Studio as Remote
from tests.server.conftest import Studio


@pytest.fixture
def remote(studio: Studio) -> Iterator[Remote]:
    """A client of the studio over a real socket."""
    with socket.socket() as sock:
        sock.bind(("127.0.0.1", 0))
        config = uvicorn.Config(studio.app, lifespan="off", log_config=None)  # the fixture has started it already
        server = uvicorn.Server(config)
        thread = threading.Thread(target=server.run, kwargs={"sockets": [sock]})
        thread.start()
        try:
            with Remote(f"http://127.0.0.1:{sock.getsockname()[1]}") as client:
                client.link.send("GET", "/health")
                yield client
        finally:
            server.should_exit = True
            thread.join()


def lose_first_answers(remote: Remote, monkeypatch: pytest.MonkeyPatch, count: int) -> None:
    """Have the first answers get lost after the studio has given them."""
    request, lost = remote.link._client.request, iter([True] * count)

    def lose_answers(*arguments: object, **options: object) -> httpx.Response:
        answer = request(*arguments, **options)
        if next(lost, False):
            raise httpx.ReadError("cut")
        return answer

    monkeypatch.setattr(remote.link._client, "request", lose_answers)
