"""A page of annotations, written without the API's models, is what those models write."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from server.access.places import HiddenPlaces
from server.annotations.annotation_page import AnnotationQuestion, make_annotation_page
from server.annotations.schemas import AnnotationOut
from server.compute import ComputeContext
from server.database import Database
from server.database.paging import Page
from server.sequences.models import SequenceRow
from server.storage import Storage
from tests.server.exchange.labels import make_points
from tests.server.rows import keep, make_annotation, make_person, make_recording

TRACK = {"kind": "track", "label": "Track 1", "track_id": "00000000-0000-4000-8000-000000000007"}


@pytest.fixture
def database_kind() -> str:
    return "sqlite"


@pytest.fixture
def context(database: Database, tmp_path: Path) -> ComputeContext:
    return ComputeContext(database, Storage(tmp_path / "files"))


@pytest.fixture
def recording(database: Database) -> SequenceRow:
    """Frames 0 to 3 of a right hand: the first by Ann, from a track in part; nobody knows of whom the others are."""
    recording, ann = make_recording(), make_person("Ann")
    first = make_annotation(recording, 0, make_points(), author_id=ann.id, sources=[TRACK] + [None] * 20, revision=3)
    keep(database, recording, ann, first, *(make_annotation(recording, n, make_points(float(n))) for n in (1, 2, 3)))
    return recording


def ask(recording: SequenceRow, **more: object) -> AnnotationQuestion:
    asked = {"hidden": (), "replica": "", "camera": None, "frames": (None, None), "cursor": None, "limit": 100}
    return AnnotationQuestion(recording.id, **(asked | more))  # type: ignore[arg-type]


def test_a_page_is_what_the_schema_would_write(context: ComputeContext, recording: SequenceRow) -> None:
    page = make_annotation_page(context, ask(recording))
    checked = Page[AnnotationOut].model_validate_json(page)
    assert json.loads(page) == checked.model_dump(mode="json")
    first = checked.items[0]
    assert (first.author, first.revision, first.frame) == ("Ann", 3, 0)
    assert first.sources is not None and first.sources[0] is not None and first.sources[0].is_independent is False
    assert [item.author for item in checked.items[1:]] == [None] * 3 and checked.items[1].sources is None


def test_pages_follow_each_other_and_the_last_one_says_so(context: ComputeContext, recording: SequenceRow) -> None:
    frames, cursor = [], None
    for _ in range(2):
        page = json.loads(make_annotation_page(context, ask(recording, limit=2, cursor=cursor)))
        frames.append([item["frame"] for item in page["items"]])
        cursor = page["next_cursor"]
    assert frames == [[0, 1], [2, 3]] and cursor is None


def test_what_was_not_asked_for_and_what_is_hidden_is_left_out(context: ComputeContext, recording: SequenceRow) -> None:
    hidden = [HiddenPlaces(frozenset({2}), frozenset({"cam0"}), frozenset({"right"}))]
    page = json.loads(make_annotation_page(context, ask(recording, frames=(1, 3), hidden=hidden)))
    assert [item["frame"] for item in page["items"]] == [1, 3]
    for nothing in ({"camera": "cam1"}, {"replica": "blind"}, {"frames": (4, None)}):
        assert make_annotation_page(context, ask(recording, **nothing)) == b'{"items":[],"next_cursor":null}'
