"""A change of an annotation is done once, at the revision it was made for, or not at all."""

from __future__ import annotations

import uuid
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest
from sqlalchemy import select

from server.access.places import Place
from server.annotations.changes import (
    Change,
    Found,
    Marked,
    StaleAnnotationError,
    add_imported_annotations,
    change_annotation,
    look_up,
)
from server.annotations.models import AnnotationRevisionRow, AnnotationRow
from server.database import Database, utc_now
from server.errors import ForbiddenError, InvalidError, NotFoundError
from server.sequences.models import SequenceRow
from tests.server.exchange.labels import make_points
from tests.server.rows import keep, make_person, make_recording
from tracker import Annotation, Annotations
from tracker.capture import JointSource


@pytest.fixture
def database_kind() -> str:
    return "sqlite"


@dataclass
class Desk:
    """A recording, one place in it and somebody who marks it."""

    database: Database
    recording: SequenceRow
    place: Place
    account_id: uuid.UUID

    def change(self, points: Any, expected: int | None = None, act: Any = "put", **more: Any) -> Change:
        return Change(act, points, expected, uuid.uuid4(), self.account_id, **more)

    def do(self, change: Change, place: Place | None = None, check: Any = None) -> Marked:
        with self.database.writing() as session:
            return change_annotation(session, place or self.place, change, check)

    def look(self, operation_id: uuid.UUID | None = None) -> Found:
        with self.database.reading() as session:
            return look_up(session, self.place, operation_id)

    def history(self) -> list[tuple[int, str]]:
        with self.database.reading() as session:
            lines = select(AnnotationRevisionRow).order_by(AnnotationRevisionRow.revision)
            return [(line.revision, line.act) for line in session.scalars(lines)]


@pytest.fixture
def desk(database: Database) -> Desk:
    recording, ann = make_recording(), make_person("ann")
    keep(database, recording, ann)
    return Desk(database, recording, Place(recording.id, "cam0", 4, "right"), ann.id)


def test_what_was_done_is_found_with_its_author_and_by_its_operation(desk: Desk) -> None:
    assert desk.look() == Found(desk.look().recording, None, None, None)
    change = desk.change(make_points())
    made = desk.do(change)
    found = desk.look(change.operation_id)
    assert found.now == found.done == replace(made, author="ann") and found.act == "put"
    assert (made.revision, made.points, made.sources) == (1, make_points(), [None] * 21)
    assert (found.recording.name, found.recording.frame_count) == ("waving", 12)


def test_every_change_counts_on_and_leaves_its_line_in_the_history(desk: Desk) -> None:
    desk.do(desk.change(make_points()))
    desk.do(desk.change(make_points(5.0), 1))
    gone = desk.do(desk.change(None, 2, "delete"))
    assert (gone.points, gone.sources, gone.revision) == (None, None, 3)
    again = desk.do(desk.change(make_points()))
    assert again.revision == 4 and again.annotation_id == gone.annotation_id
    assert desk.history() == [(1, "put"), (2, "put"), (3, "delete"), (4, "put")]


@pytest.mark.parametrize("expected", [None, 1, 3])
def test_who_is_late_is_told_how_it_is_now_and_changes_nothing(desk: Desk, expected: int | None) -> None:
    desk.do(desk.change(make_points()))
    desk.do(desk.change(make_points(7.0), 1))
    with pytest.raises(StaleAnnotationError, match=r"in frame 4 of cam0 .*; it is at revision 2\. Yours was not"):
        desk.do(desk.change(make_points(9.0), expected))
    now = desk.look().now
    assert now is not None and (now.revision, now.points) == (2, make_points(7.0))


def test_a_change_of_what_was_never_made_is_told_that_there_is_none(desk: Desk) -> None:
    with pytest.raises(StaleAnnotationError, match="there is none now") as late:
        desk.do(desk.change(make_points(), 1))
    assert late.value.now is None and late.value.status_code == 409 and desk.history() == []


def test_a_repeated_operation_gives_what_it_made_though_the_work_is_locked_by_now(desk: Desk) -> None:
    first = desk.change(make_points())
    made = desk.do(first)
    desk.do(desk.change(make_points(5.0), 1))

    def refuse() -> None:
        raise ForbiddenError("The work was handed in.")

    assert desk.do(first, check=refuse) == replace(made, author="ann")
    with pytest.raises(ForbiddenError, match="handed in"):
        desk.do(desk.change(make_points(6.0), 2), check=refuse)
    assert desk.history() == [(1, "put"), (2, "put")]


@pytest.mark.parametrize("other", ["points", "act", "place"])
def test_an_operation_that_means_something_else_is_refused_with_its_id(desk: Desk, other: str) -> None:
    first = desk.change(make_points())
    desk.do(first)
    place = replace(desk.place, frame=5) if other == "place" else desk.place
    second = replace(first, **{"points": {"points": make_points(8.0)}, "act": {"act": "restore"}}.get(other, {}))
    with pytest.raises(InvalidError, match=f"{first.operation_id} belongs to another change; .* was left as it is"):
        desk.do(second, place)
    assert desk.history() == [(1, "put")]


def test_what_is_not_there_cannot_be_deleted(desk: Desk) -> None:
    with pytest.raises(NotFoundError, match="There is no annotation of the right hand in frame 4 of cam0"):
        desk.do(desk.change(None, None, "delete"))
    desk.do(desk.change(make_points()))
    desk.do(desk.change(None, 1, "delete"))
    with pytest.raises(NotFoundError, match="There is no annotation"):
        desk.do(desk.change(None, 2, "delete"))


def test_joints_that_stay_keep_their_source_and_those_that_move_are_of_a_hand(desk: Desk) -> None:
    track = {"kind": "track", "label": "Track 1"}
    desk.do(desk.change(make_points(), sources=[track] * 21))
    moved = make_points()
    moved[3][0] += 1.0
    moved[4][2] = 1
    made = desk.do(desk.change(moved, 1))
    assert made.sources == [track] * 3 + [None] + [track] * 17


def test_a_recording_that_is_gone_says_what_became_of_it(desk: Desk) -> None:
    with desk.database.writing() as session:
        session.get_one(SequenceRow, desk.recording.id).deleted_at = utc_now()
    with pytest.raises(NotFoundError, match="was deleted; it can be restored"):
        desk.look()
    unknown = uuid.uuid4()
    with pytest.raises(NotFoundError, match=f"{unknown} does not exist"):
        desk.do(desk.change(make_points()), replace(desk.place, sequence_id=unknown))


def test_annotations_that_came_along_are_first_revisions_which_say_where_they_are_from(desk: Desk) -> None:
    points = np.array(make_points())
    absent = points.copy()
    absent[20] = 0
    said = tuple([JointSource("fit", "a fit")] + [None] * 20)
    brought = Annotations((Annotation(0, "cam0", "right", absent), Annotation(1, "cam0", "left", points, said)))
    with desk.database.writing() as session:
        assert add_imported_annotations(session, desk.recording, brought, desk.account_id) == 2
    with desk.database.reading() as session:
        first, second = session.scalars(select(AnnotationRow).order_by(AnnotationRow.frame))
    told = {"kind": "import", "label": "the recording's own annotations"}
    assert first.sources == [told] * 20 + [None] and (first.revision, first.decided) == (1, 20)
    assert second.sources == [{"kind": "fit", "label": "a fit"}] + [None] * 20 and second.author_id == desk.account_id
    assert desk.history() == [(1, "import"), (1, "import")]


def test_one_brought_annotation_of_no_frame_of_the_recording_refuses_all(desk: Desk) -> None:
    points = np.array(make_points())
    brought = Annotations((Annotation(0, "cam0", "right", points), Annotation(12, "cam0", "right", points)))
    with (
        pytest.raises(NotFoundError, match="no frame 12; they go from 0 to 11"),
        desk.database.writing() as session,
    ):
        add_imported_annotations(session, desk.recording, brought, desk.account_id)
    assert desk.history() == []
