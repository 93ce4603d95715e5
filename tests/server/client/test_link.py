"""What a client does when no answer comes: it asks again where that does no harm, and says so where it gives up."""

from __future__ import annotations

import json
import threading
from collections.abc import Callable, Iterator
from http.server import BaseHTTPRequestHandler, HTTPServer
from pathlib import Path

import pytest

import server.client.link as link_module
from server.client.answers import StudioRefusal, StudioUnreachable
from server.client.link import PAUSES, Link

Answer = tuple[int, bytes]
Serve = Callable[..., Link]


@pytest.fixture
def serve(monkeypatch: pytest.MonkeyPatch) -> Iterator[Serve]:
    """A link to a server that gives these answers in turn, the last one for ever; `link.asked` lists the requests."""
    monkeypatch.setattr(link_module, "PAUSES", (0.0,) * len(PAUSES))
    running: list[tuple[HTTPServer, threading.Thread, Link]] = []

    def start(*answers: Answer, promised: int = 0) -> Link:
        asked: list[str] = []

        class Handler(BaseHTTPRequestHandler):
            def do_GET(self) -> None:
                self.rfile.read(int(self.headers.get("Content-Length", 0)))
                status, body = answers[min(len(asked), len(answers) - 1)]
                asked.append(f"{self.command} {self.path}")
                self.send_response(status)
                self.send_header("Content-Length", str(promised or len(body)))
                self.end_headers()
                self.wfile.write(body)

            do_POST = do_GET

            def log_message(self, *words: object) -> None:
                pass

        made = HTTPServer(("127.0.0.1", 0), Handler)
        thread = threading.Thread(target=made.serve_forever, kwargs={"poll_interval": 0.01})
        thread.start()
        link = Link(f"http://127.0.0.1:{made.server_port}/", "secret", 5.0)
        link.asked = asked  # type: ignore[attr-defined]
        running.append((made, thread, link))
        return link

    yield start
    for made, thread, link in running:
        link.close()
        made.shutdown()
        thread.join()
        made.server_close()


AWAY, FINE = (503, b"{}"), (200, b'{"a": 1}')


def test_what_reads_is_asked_again_until_the_studio_is_back(serve: Serve) -> None:
    link = serve(AWAY, AWAY, FINE)
    assert link.get("/x", search="a", cursor=None) == {"a": 1}
    assert link.asked == ["GET /api/v1/x?search=a"] * 3


def test_what_changes_something_is_sent_once_unless_it_is_said_to_do_no_harm(serve: Serve) -> None:
    link = serve(AWAY, FINE)
    with pytest.raises(StudioRefusal):
        link.send("POST", "/x")
    assert len(link.asked) == 1
    again = serve(AWAY, FINE)
    assert again.send("POST", "/x", is_repeatable=True).json() == {"a": 1} and len(again.asked) == 2


def test_a_refusal_is_not_asked_again_and_says_what_the_studio_said(serve: Serve) -> None:
    link = serve((404, b'{"error": "NotFoundError", "detail": "There is no x."}'))
    with pytest.raises(StudioRefusal, match=r"NotFoundError \(404\): There is no x\."):
        link.get("/x")
    assert len(link.asked) == 1


def test_a_studio_that_stays_away_is_named_after_the_last_try(serve: Serve) -> None:
    link = serve(AWAY)
    with pytest.raises(StudioRefusal, match="503"):
        link.get("/x")
    assert len(link.asked) == len(PAUSES) + 1
    gone = Link("http://127.0.0.1:9", None, 1.0)
    with pytest.raises(StudioUnreachable, match=r"at http://127\.0\.0\.1:9 does not answer \(ConnectError"):
        gone.get("/x")
    gone.close()


def test_a_list_is_read_page_after_page(serve: Serve) -> None:
    pages = [{"items": [{"n": 0}, {"n": 1}], "next_cursor": "c"}, {"items": [{"n": 2}], "next_cursor": None}]
    link = serve(*((200, json.dumps(page).encode()) for page in pages))
    assert [item["n"] for item in link.pages("/x")] == [0, 1, 2]
    assert link.asked == ["GET /api/v1/x", "GET /api/v1/x?cursor=c"]


def test_a_download_has_its_name_only_when_it_is_whole(serve: Serve, tmp_path: Path) -> None:
    to = tmp_path / "deep" / "a.npz"
    assert serve((200, b"data")).download("/x", to).read_bytes() == b"data"
    to.unlink()
    with pytest.raises(StudioUnreachable, match="was interrupted"):
        serve((200, b"data"), promised=100).download("/x", to)
    with pytest.raises(StudioRefusal, match="404"):
        serve((404, b"{}")).download("/x", to)
    assert list(to.parent.iterdir()) == []
