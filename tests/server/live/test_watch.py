"""What changed in a recording is looked up once for all who listen, in the order in which it changed."""

from __future__ import annotations

import json
import uuid
from typing import Any

import pytest

from server.access.models import LOCAL_ACCOUNT_ID
from server.access.places import Place
from server.access.project_models import CommentRow
from server.annotations.changes import Change, change_annotation
from server.annotations.models import KeyFrameRow
from server.database import Database, utc_now
from server.jobs.service import create_job
from server.live import watch as watching
from server.live.watch import RecordingWatch, Watches, load_since
from server.sequences.models import SequenceRow
from tests.server.teams.rows import Work


@pytest.fixture
def database_kind() -> str:
    """One will do: the feed is heard on both."""
    return "sqlite"


@pytest.fixture(autouse=True)
def _no_pause(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(watching, "LOOK_SECONDS", 0.0)


@pytest.fixture
def sequence_id(database: Database) -> uuid.UUID:
    with database.writing() as session:
        return Work(session).sequence.id


@pytest.fixture
def watch(sequence_id: uuid.UUID) -> RecordingWatch:
    return RecordingWatch(sequence_id)


def mark(database: Database, sequence_id: uuid.UUID, frame: int, x: float = 1.0, revision: int | None = None) -> None:
    place = Place(sequence_id, "cam0", frame, "right")
    change = Change("put", [[x, 2.0, 2]] * 21, revision, uuid.uuid4(), LOCAL_ACCOUNT_ID)
    with database.writing() as session:
        change_annotation(session, place, change)


def frames(changes: Any) -> list[tuple[int, int]]:
    return [(changed.place.frame, changed.revision) for changed in changes]


def test_each_change_is_given_behind_the_number_that_was_heard_last(database, watch, sequence_id) -> None:
    mark(database, sequence_id, 3)
    mark(database, sequence_id, 1)
    first = watch.look(database, 0)
    assert (first.number, frames(first.changes)) == (2, [(3, 1), (1, 1)])
    assert frames(watch.look(database, 1).changes) == [(1, 1)] and watch.look(database, 2).changes == []
    mark(database, sequence_id, 3, 5.0, revision=1)
    again = watch.look(database, 2)
    assert (again.number, frames(again.changes)) == (3, [(3, 2)])
    assert frames(watch.look(database, 0).changes) == [(1, 1), (3, 2)], "of each label the newest, where it changed"


def test_a_change_is_written_out_as_the_browser_hears_it(database, watch, sequence_id) -> None:
    mark(database, sequence_id, 3, 7.0)
    [changed] = watch.look(database, 0).changes
    told = json.loads(changed.text)
    assert (told["frame"], told["camera"], told["hand"], told["revision"]) == (3, "cam0", "right", 1)
    assert told["points"] == [[7.0, 2.0, 2]] * 21 and told["author"]


def test_who_asks_for_more_than_is_remembered_is_told_to_look_it_up(database, watch, sequence_id, monkeypatch) -> None:
    monkeypatch.setattr(watching, "KEPT_CHANGES", 2)
    for frame in range(4):
        mark(database, sequence_id, frame)
    assert watch.look(database, 0).changes is None and watch.look(database, 1).changes is None
    assert frames(watch.look(database, 2).changes) == [(2, 1), (3, 1)]


def test_labels_of_another_recording_are_not_heard_of(database, watch) -> None:
    with database.writing() as session:
        other = Work(session).sequence.id
    mark(database, other, 3)
    assert watch.look(database, 0).changes == []
    with database.reading() as session:
        assert frames(load_since(session, other, utc_now())) == [(3, 1)]
        assert load_since(session, watch.sequence_id, utc_now()) == []


def test_each_kind_of_change_shows_in_its_own_place_and_nothing_changes_by_itself(database, watch, sequence_id) -> None:
    def look() -> tuple[Any, Any, Any]:
        found = watch.look(database, 0)
        return found.work, found.keys, found.jobs

    work, keys, jobs = look()
    state = watch.state
    assert look() == (work, keys, jobs) and watch.state is state
    with database.writing() as session:
        session.add(KeyFrameRow(sequence_id=sequence_id, camera="cam0", frame=3, hand="right"))
    assert look()[0] == work and look()[1] != keys and look()[2] == jobs
    assert watch.state is not state
    keys = look()[1]
    with database.writing() as session:
        create_job(session, "track", sequence_id, {})
    assert look()[:2] == (work, keys) and look()[2] != jobs


def test_an_assignment_a_comment_and_its_answer_each_change_the_work(database, watch, sequence_id) -> None:
    seen = [watch.look(database, 0).work]
    with database.writing() as session:
        desk = Work(session)
        desk.sequence = session.get_one(SequenceRow, sequence_id)
        ann = desk.join("ann")
        row = desk.assign(ann)
    seen.append(watch.look(database, 0).work)
    with database.writing() as session:
        session.add(comment := CommentRow(assignment_id=row.id, account_id=ann.id, text="here"))
    seen.append(watch.look(database, 0).work)
    with database.writing() as session:
        session.get_one(CommentRow, comment.id).resolved_at = utc_now()
    seen.append(watch.look(database, 0).work)
    assert len(set(seen)) == 4


def test_a_recording_that_is_hidden_is_gone_and_comes_back(database, watch, sequence_id) -> None:
    assert not watch.look(database, 0).is_gone
    for deleted_at, is_gone in ((utc_now(), True), (None, False)):
        with database.writing() as session:
            session.get_one(SequenceRow, sequence_id).deleted_at = deleted_at
        assert watch.look(database, 0).is_gone == is_gone


def test_who_has_heard_everything_need_not_look_again_at_once(database, watch, sequence_id, monkeypatch) -> None:
    assert not watch.is_quiet(None), "nobody has looked yet"
    monkeypatch.setattr(watching, "LOOK_SECONDS", 60.0)
    heard = watch.look(database, 0).state
    mark(database, sequence_id, 3)
    assert watch.is_quiet(heard) and not watch.is_quiet(object())
    assert watch.look(database, 0).changes == [], "the database is not asked so soon again"
    monkeypatch.setattr(watching, "LOOK_SECONDS", 0.0)
    assert not watch.is_quiet(heard) and len(watch.look(database, 0).changes or ()) == 1


def test_all_who_listen_to_a_recording_share_its_watch_until_nobody_asks(monkeypatch) -> None:
    watches, one, other = Watches(), uuid.uuid4(), uuid.uuid4()
    shared = watches.of(one)
    assert watches.of(one) is shared and watches.of(other) is not shared
    monkeypatch.setattr(watching, "IDLE_SECONDS", -1.0)
    assert watches.of(one) is not shared
