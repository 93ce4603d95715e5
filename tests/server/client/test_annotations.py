"""Annotations by the client: stored once however often they are sent, and never over somebody else's."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from server.client import StaleError, StudioRefusal
from server.client import Studio as Remote
from tests.server.client.conftest import lose_first_answers

POINTS = [[10.0 + n, 20.0, 2] for n in range(21)]


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


def test_numbers_of_any_kind_are_sent_as_the_studio_takes_them(remote: Remote, add_recording) -> None:
    annotations = remote.annotations(add_recording()["id"])
    points = np.array(POINTS)
    stored = annotations.put("cam0", 2, "left", points.tolist())
    assert stored["points"] == POINTS
    assert annotations.put("cam0", 2, "left", np.round(points).astype(int), revision=1)["points"] == POINTS
    kept = annotations.get("cam0", 2, "left")
    assert kept is not None and (kept["revision"], kept["points"]) == (2, POINTS)


def test_what_is_not_in_the_recording_is_refused_and_not_taken_for_an_empty_hand(remote: Remote, add_recording) -> None:
    recording = add_recording()["id"]
    assert list(remote.annotations(recording)) == []
    with pytest.raises(StudioRefusal, match="has no camera 'cam7'; it has") as refusal:
        remote.annotations(recording).put("cam7", 0, "right", POINTS)
    assert refusal.value.status == 404
    with pytest.raises(StudioRefusal) as stale:
        remote.annotations(recording).put("cam0", 0, "right", POINTS, revision=3)
    assert isinstance(stale.value, StaleError) and stale.value.theirs is None
