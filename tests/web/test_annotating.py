"""The annotator in a real browser: nothing is lost, nothing is overwritten, nothing needs a mouse."""

from __future__ import annotations

import re
import uuid

import pytest

pytestmark = [pytest.mark.browser, pytest.mark.timeout(180)]

EMPTY = [[0, 0, 0]] * 21


def annotate_elsewhere(studio, recording, points, headers):
    """What a colleague does at the same place."""
    path = f"/sequences/{recording['id']}/annotations/cam0/0/right"
    answer = studio.send("PUT", path, json={"points": points, "operation_id": str(uuid.uuid4())}, headers=headers)
    answer.raise_for_status()
    return answer.json()


def find_annotations(studio, recording):
    return studio.get(f"/sequences/{recording['id']}/annotations")["items"]


def test_what_the_server_did_not_get_waits_and_survives_a_reload(studio, recording, open_page, picture_of):
    from playwright.sync_api import expect

    page = open_page()
    page.goto(f"/recordings/{recording['id']}/annotate")
    picture = picture_of(page)
    picture.wait()
    page.route(re.compile("/annotations/cam0/"), lambda route: route.abort())
    picture.click(320, 350)
    picture.click(336, 335)
    expect(page.get_by_test_id("save-state")).to_have_text("offline, 1 waiting")
    assert find_annotations(studio, recording) == []

    page.unroute_all()
    page.reload()
    picture.wait()
    expect(page.get_by_role("tab", name="right 2/21")).to_be_visible()
    picture.wait_until_saved()
    [stored] = find_annotations(studio, recording)
    assert [round(value) for value in stored["points"][0]] == [320, 350, 2]
    assert [round(value) for value in stored["points"][1]] == [336, 335, 2]


def test_a_colleagues_change_is_never_overwritten_silently(studio, recording, open_page, picture_of, screenshots):
    from playwright.sync_api import expect

    first = annotate_elsewhere(studio, recording, [[300, 340, 2], *EMPTY[1:]], {"If-None-Match": "*"})
    page = open_page()
    page.goto(f"/recordings/{recording['id']}/annotate")
    picture = picture_of(page)
    picture.wait()
    theirs = [[310, 330, 2], [330, 320, 2], *EMPTY[2:]]
    second = annotate_elsewhere(studio, recording, theirs, {"If-Match": f'"{first["revision"]}"'})

    picture.click(360, 300)
    card = page.get_by_role("group", name="Two versions")
    expect(card).to_be_visible()
    expect(page.get_by_test_id("save-state")).to_have_text("1 change to settle")
    screenshots.take(page, "09-conflict")
    [stored] = find_annotations(studio, recording)
    assert stored["revision"] == second["revision"]

    card.get_by_role("button", name="By joint …").click()
    card.get_by_role("radiogroup", name="wrist").get_by_text("theirs").click()
    card.get_by_role("button", name="Keep this choice").click()
    expect(card).to_be_hidden()
    picture.wait_until_saved()
    [stored] = find_annotations(studio, recording)
    assert stored["points"][0] == [310, 330, 2]
    assert [round(value) for value in stored["points"][1]] == [360, 300, 2]


def test_gestures_and_keys_do_what_the_map_says(studio, recording, open_page, picture_of):
    from playwright.sync_api import expect

    page = open_page()
    page.goto(f"/recordings/{recording['id']}/annotate")
    picture = picture_of(page)
    picture.wait()

    def points(hand="right", frame=0):
        picture.wait_until_saved()
        items = find_annotations(studio, recording)
        found = [item["points"] for item in items if (item["hand"], item["frame"]) == (hand, frame)]
        return [[round(x), round(y), v] for x, y, v in found[0]] if found else None

    for x in (200, 220, 240):
        picture.click(x, 200)
    picture.drag((220, 200), (230, 260))
    assert points()[:3] == [[200, 200, 2], [230, 260, 2], [240, 200, 2]]
    page.keyboard.press("Control+z")
    assert points()[1] == [220, 200, 2]
    page.keyboard.press("Control+y")
    assert points()[1] == [230, 260, 2]

    page.keyboard.down("Alt")
    picture.drag((400, 300), (410, 290))
    page.keyboard.up("Alt")
    assert points()[:3] == [[210, 190, 2], [240, 250, 2], [250, 190, 2]]

    picture.click(240, 250, button="right")
    assert points()[1] == [240, 250, 1]
    page.keyboard.press("o")
    assert points()[1] == [240, 250, 0]
    page.keyboard.press("o")
    page.keyboard.press("x")
    assert points()[1] == [0, 0, 0]

    page.keyboard.press("g")
    expect(page.get_by_role("tab", name="left 0/21")).to_have_attribute("aria-selected", "true")
    picture.click(100, 100)
    assert points("left")[0] == [100, 100, 2]
    page.keyboard.press("g")

    for _ in range(3):
        page.keyboard.press("f")
    expect(page.get_by_label("Frame", exact=True)).to_have_value("3")
    page.keyboard.press("b")
    assert points(frame=3)[0] == [210, 190, 2]
    page.keyboard.press("Shift+Delete")
    assert points(frame=3) is None
    page.keyboard.press("Control+z")
    assert points(frame=3)[0] == [210, 190, 2]
    expect(page).to_have_url(re.compile("frame=3"))

    fitted = picture.element.get_attribute("data-view")
    before = picture.at(100, 100)
    page.mouse.move(*before)
    page.mouse.wheel(0, -400)
    page.wait_for_timeout(200)
    assert picture.at(100, 100) == pytest.approx(before, abs=1.0), "zooming keeps what is under the cursor"
    assert picture.at(110, 100)[0] - before[0] > 11
    page.keyboard.press("Control+=")
    page.wait_for_timeout(100)
    assert picture.element.get_attribute("data-view") == fitted


def test_a_joint_can_be_marked_without_a_mouse(studio, recording, open_page, picture_of):
    page = open_page()
    page.goto(f"/recordings/{recording['id']}/annotate")
    picture = picture_of(page)
    picture.wait()
    page.keyboard.press("Enter")
    for _ in range(4):
        page.keyboard.press("Shift+ArrowRight")
    page.keyboard.press("Alt+Shift+ArrowDown")
    page.keyboard.press("q")
    picture.wait_until_saved()
    [stored] = find_annotations(studio, recording)
    assert stored["points"][0] == [322, 245, 1]
    page.keyboard.press("Escape")
    assert page.evaluate("document.activeElement.getAttribute('aria-label')") == "Undo"
