"""Tabs die, networks go, clocks jump: nothing acknowledged is lost, nothing is stored twice."""

from __future__ import annotations

import re
from typing import Any

import pytest

from tests.web.conftest import lose_answers, wait_until_unheard

pytestmark = [pytest.mark.browser, pytest.mark.timeout(240)]

SAVES = re.compile("/annotations/cam0/0/right")


def annotator(page: Any, picture_of: Any, recording: dict[str, Any]) -> Any:
    page.goto(f"/recordings/{recording['id']}/annotate")
    picture = picture_of(page)
    picture.wait()
    return picture


def history_of(studio: Any, recording: dict[str, Any]) -> list[dict[str, Any]]:
    """Oldest first."""
    answer = studio.send("GET", f"/sequences/{recording['id']}/annotations/cam0/0/right/history")
    return list(reversed(answer.json()["items"])) if answer.is_success else []


def wrist(item: dict[str, Any]) -> list[int]:
    return [round(value) for value in item["points"][0]]


def test_a_tab_killed_before_the_answer_came_loses_nothing_and_stores_nothing_twice(
    studio, recording, open_page, picture_of
):
    page = open_page()
    picture = annotator(page, picture_of, recording)

    lose_answers(page, "PUT", SAVES.pattern)
    picture.click(320, 350)
    wait_until_unheard(page)
    picture.click(336, 335)  # waits behind the first, in the browser only
    assert len(history_of(studio, recording)) == 1
    page.close(run_before_unload=False)

    again = page.context.new_page()
    picture = annotator(again, picture_of, recording)
    picture.wait_until_saved()
    history = history_of(studio, recording)
    assert [item["revision"] for item in history] == [1, 2]
    assert wrist(history[0]) == wrist(history[1]) == [320, 350, 2]
    assert [round(value) for value in history[1]["points"][1]] == [336, 335, 2]
    assert len({item["operation_id"] for item in history}) == 2


def test_a_network_that_is_away_for_a_minute_takes_nothing_with_it(studio, recording, open_page, picture_of):
    from playwright.sync_api import expect

    page = open_page()
    page.clock.install()
    picture = annotator(page, picture_of, recording)
    picture.click(320, 350)
    picture.wait_until_saved()
    page.context.set_offline(True)
    picture.click(336, 335)
    expect(page.get_by_test_id("save-state")).to_have_text("offline, 1 waiting")
    page.clock.fast_forward("01:00")
    for key, frame in (("f", "1"), ("d", "0")):
        page.keyboard.press(key)
        expect(page.get_by_label("Frame", exact=True)).to_have_value(frame)
    picture.click(350, 320)
    expect(page.get_by_test_id("save-state")).to_have_text("offline, 1 waiting")
    assert len(history_of(studio, recording)) == 1
    page.context.set_offline(False)
    page.clock.fast_forward("00:20")
    picture.wait_until_saved()
    newest = history_of(studio, recording)[-1]
    assert [point[2] for point in newest["points"][:4]] == [2, 2, 2, 0]


def test_a_studio_whose_disk_is_full_is_named_and_gets_the_gesture_when_there_is_room(
    studio, recording, open_page, picture_of, screenshots
):
    from playwright.sync_api import expect

    page = open_page()
    picture = annotator(page, picture_of, recording)
    full = {"error": "DiskFullError", "detail": "The disk of the studio is full; this was not stored."}
    page.route(
        SAVES,
        lambda route: route.fulfill(status=507, json=full) if route.request.method == "PUT" else route.continue_(),
    )
    picture.click(320, 350)
    state = page.get_by_test_id("save-state")
    expect(state).to_have_text("held back, 1 waiting")
    expect(page.get_by_text("The disk of the studio is full")).to_be_visible()
    screenshots.take(page, "disk-full")
    page.unroute_all()
    page.keyboard.press("Control+s")
    picture.wait_until_saved()
    assert wrist(history_of(studio, recording)[-1]) == [320, 350, 2]


def test_a_clock_that_jumps_back_changes_nothing_about_what_is_saved(studio, recording, open_page, picture_of):
    page = open_page()
    picture = annotator(page, picture_of, recording)
    picture.click(320, 350)
    picture.wait_until_saved()
    page.clock.set_system_time("1999-01-01T00:00:00Z")
    picture.click(336, 335)
    picture.wait_until_saved()
    history = history_of(studio, recording)
    assert [item["revision"] for item in history] == [1, 2]
    assert [point[2] for point in history[-1]["points"][:3]] == [2, 2, 0]
