"""A page of flags: the worst first, each once, without what whoever asks must not read."""

from __future__ import annotations

from typing import Any

import pytest

from server.access.models import LOCAL_ACCOUNT_ID
from server.access.places import HiddenPlaces
from server.quality.flag_page import FlagQuestion, make_flag_page
from server.quality.schemas import FlagPage
from server.quality.service import dismiss
from tests.server.quality.desk import Desk


@pytest.fixture
def spoilt(desk: Desk) -> Desk:
    """Each frame worse than the one before, by a joint outside the image."""
    for frame in range(4):
        desk.spoil(frame, 20.0 + 40.0 * frame)
    return desk


def ask(desk: Desk, **asked: Any) -> FlagPage:
    wanted = {"hidden": (), "kind": "outside", "dismissed": False, "cursor": None, "limit": 100} | asked
    return FlagPage.model_validate_json(make_flag_page(desk.context, FlagQuestion(desk.sequence_id, **wanted)))


def frames(page: FlagPage) -> list[int]:
    return [flag.frame for flag in page.items]


def test_flags_come_worst_first_with_what_they_are_about(spoilt: Desk) -> None:
    page = ask(spoilt)
    assert frames(page) == [3, 2, 1, 0] and page.next_cursor is None
    first = page.items[0]
    assert (first.kind, first.camera, first.hand, first.joints, first.revision) == ("outside", "cam0", "right", [8], 1)
    assert first.score == pytest.approx(1.0 + 140.0 / 20.0, abs=0.05) and not first.is_dismissed
    assert (first.points[8][0], first.points[8][2]) == (-140.0, 2)


@pytest.mark.parametrize("limit", [1, 3])
def test_pages_give_each_flag_once(spoilt: Desk, limit: int) -> None:
    seen, cursor, pages = [], None, 0
    while pages == 0 or cursor is not None:
        page = ask(spoilt, limit=limit, cursor=cursor)
        seen, cursor, pages = seen + frames(page), page.next_cursor, pages + 1
    assert (seen, pages) == ([3, 2, 1, 0], -(-4 // limit))


def test_what_was_put_away_is_counted_and_shown_where_it_is_asked_for(spoilt: Desk) -> None:
    with spoilt.context.database.writing() as session:
        dismiss(session, spoilt.place(3), "outside", 1, LOCAL_ACCOUNT_ID)
    page, away = ask(spoilt), ask(spoilt, dismissed=True)
    assert (frames(page), page.counts["outside"], page.dismissed) == ([2, 1, 0], 3, 1)
    assert frames(away) == [3] and away.items[0].is_dismissed
    spoilt.spoil(3, 150.0, revision=1)
    assert frames(ask(spoilt)) == [3, 2, 1, 0], "another revision is looked at anew"


def test_places_that_must_not_be_read_are_neither_shown_nor_counted(spoilt: Desk) -> None:
    hidden = HiddenPlaces(frozenset({2, 3}), frozenset({"cam0"}), frozenset({"right"}))
    page = ask(spoilt, hidden=[hidden], kind=None)
    assert set(frames(page)) <= {0, 1} and page.counts["outside"] == 2
    assert (page.checked.labels, page.checked.frames) == (2, 2)
    assert max(check.labels for check in page.checked.checks) == 2


def test_another_kind_is_left_out_but_counted(spoilt: Desk) -> None:
    page = ask(spoilt, kind="reprojection")
    assert page.items == [] and page.counts["outside"] == 4
    told = {check.kind: check.missing for check in page.checked.checks}
    assert (told["reprojection"], told["residual"]) == ("this recording has one camera", "there is no track")
    assert page.checked.track is None and not page.checked.is_behind
