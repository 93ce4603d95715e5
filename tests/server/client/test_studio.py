"""A studio seen from a script: recordings by name, archives in, tracks out, refusals in words."""

from __future__ import annotations

import shutil
import uuid
from pathlib import Path

import pytest

from server.client import Studio as Remote
from server.client import StudioRefusal, StudioUnreachable
from tests.server.conftest import MakeRecording, Tracked


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


def test_an_archive_becomes_a_recording_that_is_found_by_name_and_by_id(
    remote: Remote, make_recording: MakeRecording, tmp_path: Path
) -> None:
    archive = shutil.make_archive(str(tmp_path / "waving"), "zip", make_recording("waving"))
    first = remote.import_archive(archive, name="Ada waves")
    second = remote.import_archive(Path(archive))
    assert first["name"] == "Ada waves" and second["name"] == "waving"
    assert remote.recording("Ada waves")["id"] == remote.recording(first["id"])["id"] == first["id"]
    assert [item["id"] for item in remote.recordings()] == [second["id"], first["id"]]
    assert [item["id"] for item in remote.recordings(search="ADA")] == [first["id"]]
    remote.import_archive(archive)
    with pytest.raises(LookupError, match=r"2 recordings are called 'waving'; needed one\. Give the id instead"):
        remote.recording("waving")


def test_an_archive_that_is_no_recording_is_refused_with_what_the_report_says(remote: Remote, tmp_path: Path) -> None:
    folder = tmp_path / "notes"
    folder.mkdir()
    (folder / "a.txt").write_text("x")
    archive = shutil.make_archive(str(tmp_path / "notes"), "zip", folder)
    with pytest.raises(ValueError, match=r"^notes\.zip is refused: \w+"):
        remote.import_archive(archive)
    assert list(remote.recordings()) == [] and remote.account()["name"] == "local"
