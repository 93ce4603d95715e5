"""A page of the queue: hands to look at, without hidden ones, and what could not be asked."""

from __future__ import annotations

from typing import Any

import pytest

from server.access.models import LOCAL_ACCOUNT_ID
from server.access.places import HiddenPlaces
from server.database.paging import read_cursor
from server.quality.queue_page import QueueQuestion, make_queue_page
from server.quality.queue_schemas import QueuePage
from server.quality.service import dismiss
from tests.server.quality.desk import Desk

ALONE = [
    "There is no track: what it would suggest is not looked at.",
    "The hand detector has not looked through this recording.",
    "This recording has one camera: no other one can disagree.",
]


def ask(desk: Desk, **asked: Any) -> QueuePage:
    wanted = {"hidden": (), "cursor": None, "limit": 100} | asked
    return QueuePage.model_validate_json(make_queue_page(desk.context, QueueQuestion(desk.sequence_id, **wanted)))


@pytest.fixture
def spoilt(desk: Desk) -> Desk:
    for frame in range(4):
        desk.spoil(frame, 20.0 + 40.0 * frame)
    return desk


def test_without_labels_track_and_detector_nothing_is_to_be_looked_at_and_it_says_why(desk: Desk) -> None:
    page = ask(desk)
    assert (page.items, page.next_cursor, page.hands, page.doubtful) == ([], None, 0, 0)
    assert (page.track, page.missing, page.is_behind) == (None, ALONE, False)


def test_hands_come_worst_first_with_their_label_and_the_flags_that_speak_against_it(spoilt: Desk) -> None:
    page = ask(spoilt)
    assert [one.frame for one in page.items] == [3, 2, 1, 0] and page.hands == page.doubtful == 4
    first = page.items[0]
    assert (first.hand, first.camera, first.shows) == ("right", "cam0", "label")
    assert (first.points[8][0], first.points[8][2], len(first.points)) == (-140.0, 2, 21)
    assert "outside" in {doubt.flag for doubt in first.doubts} and first.score >= max(one.score for one in first.doubts)


def test_a_page_goes_on_where_the_one_before_ended(spoilt: Desk) -> None:
    everything = ask(spoilt).items
    first = ask(spoilt, limit=3)
    assert first.items == everything[:3] and first.next_cursor is not None
    assert read_cursor(first.next_cursor, int, int, str)[1:] == [1, "right"]
    last = ask(spoilt, limit=3, cursor=first.next_cursor)
    assert (last.items, last.next_cursor, last.hands) == (everything[3:], None, 4)


def test_a_hand_that_must_not_be_read_is_neither_shown_nor_counted(spoilt: Desk) -> None:
    hidden = HiddenPlaces(frozenset({3}), frozenset({"cam0"}), frozenset({"right"}))
    page = ask(spoilt, hidden=[hidden])
    assert [one.frame for one in page.items] == [2, 1, 0] and page.hands == page.doubtful == 3
    elsewhere = HiddenPlaces(frozenset({3}), frozenset({"cam9"}), frozenset({"right"}))
    assert len(ask(spoilt, hidden=[elsewhere]).items) == 4


def test_a_hand_whose_flags_were_all_put_away_is_settled(spoilt: Desk) -> None:
    with spoilt.context.database.writing() as session:
        for flag in [doubt.flag for doubt in ask(spoilt).items[0].doubts if doubt.flag]:
            dismiss(session, spoilt.place(3), flag, 1, LOCAL_ACCOUNT_ID)
    left = {one.frame: {doubt.flag for doubt in one.doubts} for one in ask(spoilt).items}
    assert "outside" not in left.get(3, set()) and set(left) >= {0, 1, 2}
