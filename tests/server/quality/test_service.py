"""Flags are found once for labels that stay as they are, put away for one revision, and never of an older one."""

from __future__ import annotations

from typing import Any

import pytest

from server.access.models import LOCAL_ACCOUNT_ID
from server.errors import ConflictError, NotFoundError
from server.quality import service
from server.quality.service import FlagFinder, Flagged, dismiss, find_compared, find_dismissed, restore
from server.tracks.models import TrackRow
from tests.server.quality.desk import Desk


@pytest.fixture
def finder(desk: Desk) -> FlagFinder:
    return FlagFinder(desk.context.storage)


def find(desk: Desk, finder: FlagFinder, **more: Any) -> Flagged:
    return finder.find(desk.context.database, desk.sequence_id, "x", ["right"], None, **more)


def outside(flagged: Flagged) -> list[tuple[int, int]]:
    """Frames and revisions with a joint outside the image."""
    return sorted((one.label.frame, one.label.revision) for one in flagged.findings if one.kind == "outside")


def test_nothing_labelled_is_nothing_found(desk: Desk, finder: FlagFinder) -> None:
    found = find(desk, finder)
    assert (found.labels, found.findings, found.doubts, found.is_behind) == ([], [], [], False)
    assert found.setting.hands == ("right",) and not found.setting.has_depth


def test_labels_that_stayed_as_they_were_are_not_checked_again(desk: Desk, finder: FlagFinder) -> None:
    desk.mark(0)
    desk.spoil(1, 60.0)
    first = find(desk, finder)
    assert outside(first) == [(1, 1)]
    assert find(desk, finder).labels is first.labels
    desk.mark(1, revision=1)
    second = find(desk, finder)
    assert outside(second) == [] and second.labels is not first.labels
    assert second.labels[0] is first.labels[0], "what did not change is not read again"


def test_where_time_is_up_what_changed_since_is_left_out_and_said_to_be_behind(desk, finder, monkeypatch) -> None:
    for frame in range(2):
        desk.spoil(frame, 60.0)
    find(desk, finder)
    monkeypatch.setattr(service, "CREDIT_SECONDS", 0.0)
    desk.spoil(1, 70.0, revision=1)
    behind = find(desk, finder)
    assert (outside(behind), behind.is_behind) == ([(0, 1)], True)
    monkeypatch.setattr(service, "CREDIT_SECONDS", 3.0)
    caught_up = find(desk, finder)
    assert (outside(caught_up), caught_up.is_behind) == ([(0, 1), (1, 2)], False)


def test_doubts_are_found_only_where_they_are_asked_for_and_kept_then(desk: Desk, finder: FlagFinder) -> None:
    desk.mark(0)
    assert find(desk, finder).doubts == []
    asked = find(desk, finder, with_doubts=True)
    assert asked.doubts == find(desk, finder).doubts


def test_a_recording_asked_for_longest_ago_is_forgotten(desk: Desk, finder: FlagFinder, monkeypatch) -> None:
    monkeypatch.setattr(service, "KEPT", 1)
    desk.mark(0)
    first = find(desk, finder)
    finder.find(desk.context.database, desk.sequence_id, "other files", ["right"], None)
    again = find(desk, finder)
    assert again.labels is not first.labels and len(again.labels) == 1


def test_a_flag_is_put_away_for_the_revision_that_somebody_looked_at(desk: Desk) -> None:
    desk.spoil(1, 60.0)
    with desk.context.database.writing() as session:
        for _ in range(2):
            dismiss(session, desk.place(1), "outside", 1, LOCAL_ACCOUNT_ID)
        [(_, revision, kind)] = find_dismissed(session, desk.sequence_id)
        assert (revision, kind) == (1, "outside")
        restore(session, desk.place(1), "jump", 1)
        restore(session, desk.place(1), "outside", 2)
        assert len(find_dismissed(session, desk.sequence_id)) == 1, "another kind, another revision"
        for _ in range(2):
            restore(session, desk.place(1), "outside", 1)
        assert find_dismissed(session, desk.sequence_id) == set()


def test_who_looked_at_an_older_revision_puts_nothing_away(desk: Desk) -> None:
    desk.spoil(1, 60.0)
    desk.spoil(1, 70.0, revision=1)
    with desk.context.database.writing() as session:
        told = "You looked at revision 1 of the right hand in frame 1 of cam0; it is at 2 now. Look at it again."
        with pytest.raises(ConflictError, match=told):
            dismiss(session, desk.place(1), "outside", 1, LOCAL_ACCOUNT_ID)
        with pytest.raises(NotFoundError):
            dismiss(session, desk.place(3), "outside", 1, LOCAL_ACCOUNT_ID)
        assert find_dismissed(session, desk.sequence_id) == set()


def test_labels_are_compared_with_the_best_track_where_there_is_one(desk: Desk) -> None:
    with desk.context.database.writing() as session:
        assert find_compared(session, desk.sequence_id) is None
        facts: dict[str, Any] = {"frame_first": 0, "hands": ["right"], "summary": {"lost": 0}, "job_id": None}
        about = {"sequence_id": desk.sequence_id} | facts
        rows = [TrackRow(name=f"Track {count}", frame_count=count, **about) for count in (2, 4)]
        session.add_all(rows)
        session.flush()
        found = find_compared(session, desk.sequence_id)
        assert found is not None and (found.id, found.name) == (rows[1].id, "Track 4")
