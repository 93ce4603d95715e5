"""Many annotations are changed at once: each with its line in the history, or none of them."""

from __future__ import annotations

from typing import Any

import pytest
from sqlalchemy import select

from server.access.places import Place
from server.annotations.bulk import BulkChange, change_annotations, find_annotations
from server.annotations.models import AnnotationRevisionRow, AnnotationRow
from server.database import Database
from server.errors import ConflictError
from tests.server.exchange.labels import make_points
from tests.server.rows import keep, make_annotation, make_person, make_recording

FIT = {"kind": "fit", "label": "a fit"}


@pytest.fixture
def database_kind() -> str:
    return "sqlite"


def test_annotations_are_found_by_their_place_deleted_ones_too_and_blind_ones_not(database: Database) -> None:
    recording, other = make_recording(), make_recording("other")
    there = make_annotation(recording, 2, make_points())
    gone = make_annotation(recording, 1, None, "left")
    blind = make_annotation(recording, 0, make_points(), replica="blind")
    keep(database, recording, other, there, gone, blind, make_annotation(other, 0, make_points()))
    for hold in (False, True):
        with database.writing() as session:
            found = find_annotations(session, recording.id, hold=hold)
            assert {key: row.id for key, row in found.items()} == {
                (2, "cam0", "right"): there.id,
                (1, "cam0", "left"): gone.id,
            }


def test_new_changed_and_deleted_ones_are_stored_with_their_history(database: Database) -> None:
    recording, ann = make_recording(), make_person("ann")
    old = make_annotation(recording, 1, make_points(), sources=[FIT] * 21, revision=4)
    dropped = make_annotation(recording, 2, make_points(), sources=[FIT] * 21)
    keep(database, recording, ann, old, dropped)
    moved: list[Any] = make_points()
    moved[0] = [0.0, 0.0, 0]
    changes = [
        BulkChange(Place(recording.id, "cam0", 0, "right"), "import", make_points(), [FIT] * 21),
        BulkChange(Place(recording.id, "cam0", 1, "right"), "restore", moved),
        BulkChange(Place(recording.id, "cam0", 2, "right"), "delete", None),
    ]
    with database.writing() as session:
        change_annotations(session, find_annotations(session, recording.id, hold=True), changes, ann.id)
    with database.reading() as session:
        new, changed, deleted = session.scalars(select(AnnotationRow).order_by(AnnotationRow.frame))
        lines = session.scalars(select(AnnotationRevisionRow)).all()
    assert (new.revision, new.points, new.sources, new.decided) == (1, make_points(), [FIT] * 21, 21)
    assert (changed.revision, changed.points, changed.decided) == (5, moved, 20)
    assert changed.sources == [None] + [FIT] * 20, "what stays keeps its source"
    assert (deleted.revision, deleted.points, deleted.sources, deleted.decided) == (2, None, None, 0)
    assert {row.author_id for row in (new, changed, deleted)} == {line.author_id for line in lines} == {ann.id}
    assert {(line.annotation_id, line.revision, line.act) for line in lines} == {
        (new.id, 1, "import"),
        (old.id, 5, "restore"),
        (dropped.id, 2, "delete"),
    }
    assert len({line.operation_id for line in lines}) == 3


def test_a_place_that_somebody_annotated_since_we_looked_refuses_all(database: Database) -> None:
    recording, ann = make_recording(), make_person("ann")
    keep(database, recording, ann)
    with database.reading() as session:
        seen = find_annotations(session, recording.id)
    theirs = make_annotation(recording, 3, make_points(7.0))
    keep(database, theirs)
    changes = [BulkChange(Place(recording.id, "cam0", frame, "right"), "import", make_points()) for frame in (2, 3)]
    with (
        pytest.raises(ConflictError, match=r"annotated one of these places meanwhile; nothing was stored\. Try again"),
        database.writing() as session,
    ):
        change_annotations(session, seen, changes, ann.id)
    with database.reading() as session:
        [row] = session.scalars(select(AnnotationRow))
        assert (row.id, row.points, row.revision) == (theirs.id, make_points(7.0), 1)
        assert session.scalars(select(AnnotationRevisionRow)).all() == []


def test_no_changes_change_nothing(database: Database) -> None:
    recording, ann = make_recording(), make_person("ann")
    keep(database, recording, ann, make_annotation(recording, 1, make_points()))
    with database.writing() as session:
        change_annotations(session, find_annotations(session, recording.id), [], ann.id)
    with database.reading() as session:
        assert [row.revision for row in find_annotations(session, recording.id).values()] == [1]
