"""The client against a real server: what it promises when answers are lost or somebody else was first."""

from __future__ import annotations

import socket
import threading
import uuid
from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest
import uvicorn

from server.client import JobFailed, StaleError, StudioRefusal, StudioUnreachable
from server.client import Studio as Remote
from server.jobs.models import JobRow
from tests.server.conftest import Studio, Tracked

POINTS = [[10.0 + n, 20.0, 2] for n in range(21)]


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


def test_annotations_are_stored_changed_and_never_overwritten(remote: Remote, add_recording, tmp_path: Path) -> None:
    annotations = remote.annotations(add_recording()["id"])
    assert annotations.get("cam0", 0, "right") is None
    assert annotations.put("cam0", 0, "right", POINTS)["revision"] == 1
    changed = annotations.put("cam0", 0, "right", [[1.0, 2.0, 1], *POINTS[1:]], revision=1)
    assert changed["revision"] == 2
    with pytest.raises(StaleError) as stale:
        annotations.put("cam0", 0, "right", POINTS, revision=1)
    assert stale.value.theirs["points"][0] == [1.0, 2.0, 1]
    assert [item["revision"] for item in annotations] == [2]
    assert '"items"' in annotations.export(tmp_path / "deep" / "annotations.json").read_text()


def test_an_answer_that_was_lost_is_asked_for_again_and_the_change_is_made_once(
    remote: Remote, add_recording, monkeypatch: pytest.MonkeyPatch
) -> None:
    annotations = remote.annotations(add_recording()["id"])
    lose_first_answers(remote, monkeypatch, 2)
    assert annotations.put("cam0", 0, "right", POINTS)["revision"] == 1
    assert annotations.put("cam0", 0, "right", POINTS, revision=1)["revision"] == 2


def lose_first_answers(remote: Remote, monkeypatch: pytest.MonkeyPatch, count: int) -> None:
    """Have the first answers get lost after the studio has given them."""
    request, lost = remote.link._client.request, iter([True] * count)

    def lose_answers(*arguments: object, **options: object) -> httpx.Response:
        answer = request(*arguments, **options)
        if next(lost, False):
            raise httpx.ReadError("cut")
        return answer

    monkeypatch.setattr(remote.link._client, "request", lose_answers)


def test_a_job_is_watched_to_its_end(remote: Remote, studio: Studio, add_recording) -> None:
    recording = add_recording("waving")
    [job] = remote.jobs.track_all([remote.recording("waving")["id"]], iterations=4)
    assert [found["id"] for found in remote.jobs.find(search="waving", state="queued")] == [job["id"]]
    heard: list[str] = []

    def hear(changed: dict) -> None:
        heard.append(changed["state"])
        with studio.database.writing() as session:
            row = session.get_one(JobRow, uuid.UUID(job["id"]))
            row.state, row.error, row.version = "failed", "no hand in sight", row.version + 1

    with pytest.raises(JobFailed, match="no hand in sight"):
        remote.jobs.wait(job["id"], hear)
    assert heard == ["queued", "failed"]
    assert "queued" in list(remote.jobs.log(job["id"]))
    assert remote.jobs.resume(job["id"])["attempt"] == 2
    with pytest.raises(TimeoutError, match="it is not finished"):
        remote.jobs.wait(job["id"], timeout=0.0)
    assert remote.jobs.cancel(job["id"])["state"] == "cancelled"
    assert job["sequence_id"] == recording["id"]


def test_tracks_are_downloaded_whole(remote: Remote, tracked: Tracked, tmp_path: Path) -> None:
    [track] = remote.tracks(str(tracked.sequence_id))
    folder = remote.download_track(track["id"], tmp_path / "track")
    assert sorted(path.name for path in folder.iterdir()) == ["summary.json", "track.npz"]
    assert remote.export_track(track["id"], "csv", tmp_path / "joints.csv").read_text().count("\n") > 12
    assert remote.evaluation(track["id"])["evaluated"] > 0
    with pytest.raises(StudioRefusal, match="There is no track"):
        remote.download_track(str(uuid.uuid4()), tmp_path / "none")
    assert not (tmp_path / "none" / "track.npz").exists()


def test_a_refusal_says_what_the_studio_said(remote: Remote, add_recording) -> None:
    with pytest.raises(StudioRefusal, match="iterations is 0") as refusal:
        remote.jobs.track(add_recording()["id"], iterations=0)
    assert refusal.value.status == 422
    assert "iterations is 0" in refusal.value.detail
    with pytest.raises(LookupError, match="0 recordings are called 'none'"):
        remote.recording("none")


def test_a_studio_that_is_not_there_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("server.client.link.PAUSES", (0.0,))
    with Remote("http://127.0.0.1:9") as nobody, pytest.raises(StudioUnreachable, match=r"http://127\.0\.0\.1:9"):
        nobody.account()


def test_a_token_is_sent_with_every_request() -> None:
    with Remote(token="secret") as remote:
        assert remote.link._client.headers["Authorization"] == "Bearer secret"
