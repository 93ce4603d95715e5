"""Which tracks a question is about: in the order asked for, each once, with the labels that judge it."""

from __future__ import annotations

import uuid
from collections.abc import Callable
from datetime import timedelta
from typing import Any

import pytest

from server.access.project_models import ProjectRow, ProjectSequenceRow
from server.annotations.snapshot_models import SnapshotRow
from server.database import Database, utc_now
from server.errors import InvalidError, NotFoundError
from server.evaluations.choice import Chosen, choose_tracks
from server.evaluations.schemas import MAX_TRACKS, EvaluationQuery
from server.jobs.models import JobRow
from server.sequences.models import SequenceRow
from tests.server.exchange.labels import make_points
from tests.server.rows import keep, make_annotation, make_recording, make_track

Choose = Callable[..., list[Chosen]]
NOW = utc_now()


@pytest.fixture
def database_kind() -> str:
    return "sqlite"


@pytest.fixture
def choose(database: Database) -> Choose:
    def ask(**asked: Any) -> list[Chosen]:
        with database.reading() as session:
            return choose_tracks(session, EvaluationQuery(**asked))

    return ask


def names(chosen: list[Chosen]) -> list[str]:
    return [one.track.name for one in chosen]


def make_aged(recording: SequenceRow, name: str, minutes: int, **columns: Any) -> Any:
    return make_track(recording, name, created_at=NOW - timedelta(minutes=minutes), **columns)


def test_named_tracks_come_first_then_those_of_recordings_the_newest_first_each_once(
    database: Database, choose: Choose
) -> None:
    first, second = make_recording("first"), make_recording("second")
    a, b, c = make_aged(first, "a", 3), make_aged(first, "b", 2), make_aged(second, "c", 9)
    gone = make_aged(first, "gone", 1, deleted_at=NOW)
    keep(database, first, second, a, b, c, gone)
    assert names(choose(track=[c.id, a.id])) == ["c", "a"]
    assert names(choose(sequence=[first.id, second.id])) == ["b", "a", "c"]
    assert names(choose(track=[a.id, a.id], sequence=[second.id, first.id])) == ["a", "c", "b"]
    assert [one.sequence.name for one in choose(track=[c.id, a.id])] == ["second", "first"]
    assert choose() == []


def test_a_project_gives_of_each_recording_the_newest_track_of_every_method(database: Database, choose: Choose) -> None:
    first, second, deleted = make_recording("first"), make_recording("second"), make_recording("x", deleted_at=NOW)
    project = ProjectRow(id=uuid.uuid4(), name="Hands")
    places = [
        ProjectSequenceRow(project_id=project.id, sequence_id=row.id, added_at=NOW + timedelta(minutes=n))
        for n, row in enumerate((second, deleted, first))
    ]
    quick, same, slow = (
        JobRow(id=uuid.uuid4(), kind="track", params=params)
        for params in ({"terms": "LO", "iterations": 5}, {"iterations": 5, "terms": "LO"}, {"terms": "SC"})
    )
    tracks = [
        make_aged(first, "old quick", 9, job_id=quick.id),
        make_aged(first, "new quick", 5, job_id=same.id),
        make_aged(first, "slow", 7, job_id=slow.id),
        make_aged(first, "old import", 8),
        make_aged(first, "new import", 6),
        make_aged(second, "quick of second", 20, job_id=quick.id),
        make_aged(deleted, "of a deleted recording", 1),
    ]
    keep(database, first, second, deleted, project, *places, quick, same, slow, *tracks)
    assert names(choose(project=project.id)) == ["quick of second", "new quick", "new import", "slow"]


def test_a_track_of_a_deleted_recording_is_judged_when_it_is_named_itself(database: Database, choose: Choose) -> None:
    gone = make_recording("gone", deleted_at=NOW)
    track = make_track(gone)
    keep(database, gone, track)
    [one] = choose(track=[track.id])
    assert (one.track.id, one.sequence.name) == (track.id, "gone")
    with pytest.raises(NotFoundError, match="was deleted; it can be restored"):
        choose(sequence=[gone.id])


def test_a_snapshot_judges_the_tracks_of_its_recording_and_labels_of_now_the_others(
    database: Database, choose: Choose
) -> None:
    first, second = make_recording("first"), make_recording("second")
    a, b = make_track(first, "a"), make_track(second, "b")
    snapshot = SnapshotRow(id=uuid.uuid4(), sequence_id=first.id, version=1, name="was", content_hash="0" * 64)
    snapshot.item_count = snapshot.joint_count = 0
    keep(database, first, second, a, b, snapshot, make_annotation(second, 0, make_points(), revision=4))
    found = choose(track=[a.id, b.id], snapshot=[snapshot.id])
    assert [one.labels.key for one in found] == [f"snapshot-{snapshot.id}", "now-4"]
    assert [one.labels.key for one in choose(track=[a.id, b.id])] == ["now-0", "now-4"]
    unknown = uuid.uuid4()
    with pytest.raises(NotFoundError, match=f"There is no snapshot {unknown}"):
        choose(track=[a.id], snapshot=[snapshot.id, unknown])


def test_the_reference_is_one_of_them(database: Database, choose: Choose) -> None:
    recording = make_recording()
    a, b = make_track(recording, "a"), make_track(recording, "b")
    keep(database, recording, a, b)
    assert names(choose(track=[a.id, b.id], reference=b.id)) == ["a", "b"]
    with pytest.raises(NotFoundError, match=f"The reference {b.id} is none of the 1 tracks that are compared"):
        choose(track=[a.id], reference=b.id)


@pytest.mark.parametrize("more", [0, 1])
def test_more_than_the_page_compares_is_refused_with_the_number(database: Database, choose: Choose, more: int) -> None:
    recording = make_recording()
    keep(database, recording, *(make_track(recording, f"{n}") for n in range(MAX_TRACKS + more)))
    if more:
        with pytest.raises(InvalidError, match=f"These are {MAX_TRACKS + 1} tracks; at most {MAX_TRACKS} can be"):
            choose(sequence=[recording.id])
    else:
        assert len(choose(sequence=[recording.id])) == MAX_TRACKS


@pytest.mark.parametrize(
    ("asked", "said"),
    [("track", "There is no track"), ("sequence", "The recording"), ("project", "There is no project")],
)
def test_what_there_is_not_is_named(choose: Choose, asked: str, said: str) -> None:
    unknown = uuid.uuid4()
    with pytest.raises(NotFoundError, match=f"{said} {unknown}"):
        choose(**{asked: unknown if asked == "project" else [unknown]})
