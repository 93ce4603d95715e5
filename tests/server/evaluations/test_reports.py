"""A comparison as a file says what it is of, what was left out, and the numbers of the comparison."""

from __future__ import annotations

import csv
import io
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from server.access.models import LOCAL_ACCOUNT_ID, Account
from server.database import Database
from server.errors import InvalidError
from server.evaluations.reports import write_report
from server.evaluations.schemas import EvaluationQuery
from tests.server.conftest import MakeRecording
from tests.server.evaluations.known_tracks import Known, store_known

LOCAL = Account(id=LOCAL_ACCOUNT_ID, name="local", role="admin")


@pytest.fixture
def database_kind() -> str:
    return "sqlite"


@pytest.fixture
def two(database: Database, tmp_path: Path, make_recording: MakeRecording) -> tuple[Known, Known]:
    """A track of each of two recordings, 5 and 2 px off in every frame."""
    made = [store_known(database, tmp_path / "files", make_recording, name) for name in ("waving", "pointing")]
    for known, shift in zip(made, ((3.0, 4.0), (0.0, 2.0)), strict=True):
        for frame in range(3):
            known.mark(frame, shift)
    return made[0], made[1]


def report(known: Known, kind: Any, **asked: Any) -> str:
    return write_report(known.context, kind, EvaluationQuery(**asked), LOCAL)[1]


def test_the_table_has_a_line_for_every_joint_with_its_error(two: tuple[Known, Known]) -> None:
    first, second = two
    rows = list(csv.DictReader(io.StringIO(report(first, "csv", track=[first.track.id, second.track.id]))))
    assert len(rows) == 2 * 3 * 21
    for known, error in ((first, 5.0), (second, 2.0)):
        found = [float(row["error_px"]) for row in rows if row["track_id"] == str(known.track.id)]
        np.testing.assert_allclose(found, np.full(63, error), atol=1e-3)


def test_the_numbers_are_those_of_the_comparison(two: tuple[Known, Known]) -> None:
    first, second = two
    query = EvaluationQuery(track=[first.track.id, second.track.id])
    comparison, text = write_report(first.context, "json", query, LOCAL)
    assert json.loads(text) == comparison.model_dump(mode="json")
    assert [track["error"]["mean"] for track in json.loads(text)["tracks"]] == pytest.approx([5.0, 2.0])


def test_the_page_is_named_after_its_track_or_what_the_tracks_are_of(two: tuple[Known, Known]) -> None:
    first, second = two
    alone = report(first, "html", track=[first.track.id])
    assert "<title>Track 1 of waving</title>" in alone and alone.count("data:image/jpeg;base64,") == 3
    both = report(first, "html", track=[first.track.id, second.track.id])
    assert "<title>2 tracks of 2 recordings</title>" in both and both.count("data:image/jpeg;base64,") == 6


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        (
            {
                "camera": "cam0",
                "hand": "right",
                "visibility": "visible",
                "without_start": True,
                "source": ["hand", "fit"],
            },
            "Only camera cam0, the right hand, joints marked visible. The frame that a track began at is left out. "
            "Joints that count: hand, fit.",
        ),
        ({"hand": "left"}, "Only the left hand."),
        ({"source": ["all"]}, "Joints that count: all."),
    ],
)
def test_the_page_says_what_was_chosen(two: tuple[Known, Known], asked: dict[str, Any], said: str) -> None:
    first, _ = two
    assert said in report(first, "html", track=[first.track.id], **asked)
    assert said not in report(first, "html", track=[first.track.id])


@pytest.mark.parametrize("kind", ["html", "csv", "json"])
def test_a_report_of_nothing_is_refused_with_what_to_give(
    database: Database, tmp_path: Path, make_recording: MakeRecording, kind: str
) -> None:
    known = store_known(database, tmp_path / "files", make_recording)
    with pytest.raises(InvalidError, match="A report needs at least one track: give `track`, `sequence` or `project`"):
        report(known, kind)
