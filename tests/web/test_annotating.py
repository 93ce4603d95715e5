"""The annotator in a real browser: nothing is lost, nothing is overwritten, nothing needs a mouse."""

from __future__ import annotations

import json
import re
import uuid

import numpy as np
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
    page.route(re.compile(r"/sequences/[^/]+/live"), lambda route: route.abort())  # no news comes before the gesture
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
    page.set_viewport_size({"width": 1280, "height": 340})
    choice = card.get_by_role("radiogroup", name="wrist")
    choice.scroll_into_view_if_needed()
    box, timeline = choice.bounding_box(), page.get_by_role("button", name="Zoom the timeline in").bounding_box()
    assert box["y"] + box["height"] <= timeline["y"], "cards too high for the picture scroll; they cover no timeline"
    middle = [box["x"] + box["width"] / 2, box["y"] + box["height"] / 2]
    assert choice.evaluate("(choice, at) => choice.contains(document.elementFromPoint(...at))", middle)
    choice.get_by_text("theirs").click()
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

    # Fingertips of a fist lie close together: a click beside a joint is not taken for one that chooses it.
    page.keyboard.press("f")
    picture.wait()
    assert 6 < 8 * json.loads(fitted)["scale"] < 10
    picture.click(100, 100)
    picture.click(108, 100)
    assert points(frame=4)[:3] == [[100, 100, 2], [108, 100, 2], [0, 0, 0]]
    next_click = page.get_by_test_id("next-click")
    expect(next_click).to_have_text("Next click places the right thumb mcp")
    page.mouse.move(*picture.at(109, 101))
    expect(next_click).to_have_text("Next click chooses the right thumb cmc; with Shift it places the right thumb mcp")
    page.keyboard.down("Shift")
    picture.click(109, 101)
    page.keyboard.up("Shift")
    assert points(frame=4)[:4] == [[100, 100, 2], [108, 100, 2], [109, 101, 2], [0, 0, 0]]
    picture.click(100, 100)
    expect(page.get_by_role("button", name=re.compile("^wrist"))).to_have_attribute("aria-current", "step")
    page.mouse.move(*picture.at(300, 100))
    expect(next_click).to_have_text("Next click moves the right wrist here")
    picture.drag((107, 99), (150, 150))
    assert points(frame=4)[1] == [150, 150, 2], "a drag still takes hold from farther off"


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


def test_a_hand_of_21_joints_takes_at_most_45_actions(studio, recording, synthesized, open_page, picture_of):
    page = open_page()
    page.goto(f"/recordings/{recording['id']}/annotate")
    picture = picture_of(page)
    picture.wait()
    actions = 0
    for joint, (x, y) in enumerate(synthesized.joints):
        # Joints that lie on others are placed from the keyboard, because a click there would choose the other one.
        near = any(np.hypot(x - a, y - b) < 12 for a, b in synthesized.joints[:joint])
        if near:
            page.keyboard.press("Enter")
            page.keyboard.press("Tab")
            actions += 2
        else:
            picture.click(x, y)
            actions += 1
    page.keyboard.press("0")
    page.keyboard.press("q")
    actions += 2
    picture.wait_until_saved()
    [stored] = find_annotations(studio, recording)
    assert all(v in (1, 2) for _, _, v in stored["points"]), "all 21 joints have a place"
    assert stored["points"][0][2] == 1
    assert actions <= 45, f"{actions} clicks and keys"


def test_the_hand_is_turned_swapped_and_carried_on_one_step_of_undo_each(studio, recording, open_page, picture_of):
    from playwright.sync_api import expect

    page = open_page()
    page.goto(f"/recordings/{recording['id']}/annotate")
    picture = picture_of(page)
    picture.wait()

    def points(hand="right", frame=0):
        picture.wait_until_saved()
        found = [i["points"] for i in find_annotations(studio, recording) if (i["hand"], i["frame"]) == (hand, frame)]
        return [[round(x), round(y), v] for x, y, v in found[0]] if found else None

    picture.click(200, 200)
    picture.click(300, 200)
    page.mouse.move(*picture.at(200, 200))
    page.keyboard.down("Alt")
    for _ in range(9):
        page.mouse.wheel(0, 500)
    page.keyboard.up("Alt")
    expect(page.get_by_role("button", name="Undo")).to_be_visible()
    page.keyboard.press("Tab")
    assert points()[:2] == [[200, 200, 2], [200, 300, 2]], "nine times ten degrees about the cursor"
    page.keyboard.press("Control+z")
    assert points()[1] == [300, 200, 2], "one step for the whole turn"

    page.keyboard.press("Alt+t")
    assert points() is None
    assert points("left")[1] == [300, 200, 2]
    page.keyboard.press("Control+z")
    assert points("left") is None
    assert points()[1] == [300, 200, 2]

    page.keyboard.press("Control+b")
    expect(page.get_by_label("Frame", exact=True)).to_have_value("1")
    assert points(frame=1)[:2] == points()[:2]
    page.get_by_role("button", name="Copy the pose to the next frames").click()
    page.get_by_role("textbox", name="Up to frame").fill("5")
    page.get_by_role("button", name="Copy to 4 frames").click()
    assert [points(frame=frame) is not None for frame in range(7)] == [True] * 6 + [False]
    page.get_by_role("button", name="Undo").click()
    assert [points(frame=frame) is not None for frame in range(3)] == [True, True, False]


def test_between_key_frames_positions_are_proposed_until_accepted(
    studio, recording, open_page, picture_of, screenshots
):
    from playwright.sync_api import expect

    page = open_page()
    page.goto(f"/recordings/{recording['id']}/annotate")
    picture = picture_of(page)
    picture.wait()
    timeline = page.get_by_role("slider", name="Timeline")

    def go(frame):
        page.get_by_label("Frame", exact=True).fill(str(frame))
        page.keyboard.press("Enter")
        picture.element.focus()
        picture.wait()

    for frame, x in ((0, 200), (4, 240)):
        go(frame)
        picture.click(x, 200)
        page.keyboard.press("k")
    go(2)
    expect(timeline).to_have_attribute("aria-valuetext", re.compile("right: not marked, suggested"))
    expect(page.get_by_test_id("suggested-by")).to_contain_text("key frames 0 and 4")
    screenshots.take(page, "12-key-frames")
    picture.wait_until_saved()
    assert {item["frame"] for item in find_annotations(studio, recording)} == {0, 4}, "a proposal is no label"
    page.keyboard.press("Shift+K")
    expect(timeline).to_have_attribute("aria-valuetext", re.compile("right: 1 of 21[;,]"))
    picture.wait_until_saved()
    stored = {item["frame"]: round(item["points"][0][0]) for item in find_annotations(studio, recording)}
    assert stored == {0: 200, 1: 210, 2: 220, 3: 230, 4: 240}
    page.keyboard.press("Control+z")
    expect(timeline).to_have_attribute("aria-valuetext", re.compile("right: not marked, suggested"))
    picture.wait_until_saved()
    assert {item["frame"] for item in find_annotations(studio, recording)} == {0, 4}

    other = open_page()
    other.goto(f"/recordings/{recording['id']}/annotate?frame=2")
    picture_of(other).wait()
    theirs = other.get_by_role("slider", name="Timeline")
    expect(other.get_by_test_id("suggested-by")).to_contain_text("key frames 0 and 4")
    other.keyboard.press("Shift+K")
    expect(theirs).to_have_attribute("aria-valuetext", re.compile("right: 1 of 21[;,]"))
    other.get_by_role("tab", name="History").click()
    versions = other.get_by_role("list", name="Versions, newest first")
    expect(versions.get_by_role("listitem").first).to_contain_text("1 between key frames 0 and 4")
    picture_of(other).wait_until_saved()
    source = next(item for item in find_annotations(studio, recording) if item["frame"] == 2)["sources"][0]
    assert (source["kind"], source["label"]) == ("interpolation", "key frames 0 and 4")


def test_an_earlier_version_is_looked_at_and_brought_back(studio, recording, open_page, picture_of, screenshots):
    from playwright.sync_api import expect

    page = open_page()
    page.goto(f"/recordings/{recording['id']}/annotate")
    picture = picture_of(page)
    picture.wait()
    page.get_by_role("tab", name="History").click()
    expect(page.get_by_text("Nobody has marked the right hand")).to_be_visible()
    for x in (200, 260, 320):
        picture.click(x, 200)
        picture.wait_until_saved()
    versions = page.get_by_role("list", name="Versions, newest first")
    expect(versions.get_by_role("listitem")).to_have_count(3)
    versions.get_by_role("button").nth(2).click()
    screenshots.take(page, "13-history")
    page.get_by_role("button", name="Restore revision 1").click()
    expect(versions.get_by_role("listitem")).to_have_count(4)
    expect(versions.get_by_role("listitem").first).to_contain_text("as in revision 1 again")
    [stored] = find_annotations(studio, recording)
    assert [point[2] for point in stored["points"][:3]] == [2, 0, 0]


def test_keys_are_put_elsewhere_everywhere_at_once_and_follow_the_account(
    studio, recording, open_page, picture_of, screenshots
):
    from playwright.sync_api import expect

    page = open_page()
    page.goto(f"/recordings/{recording['id']}/annotate")
    picture = picture_of(page)
    picture.wait()
    page.keyboard.press("F2")
    keys = page.get_by_role("dialog")
    keys.get_by_label("Look for an action or a key").fill("next frame")
    rebind = keys.get_by_role("button", name="Key: a new one for Next frame, Frames")
    rebind.click()
    page.keyboard.press("Control+l")
    expect(keys.get_by_role("alert")).to_contain_text("belongs to the browser")
    rebind.click()
    page.keyboard.press("q")
    expect(keys.get_by_role("alert")).to_contain_text("Occluded, or visible again")
    screenshots.take(page, "14-keys")
    keys.get_by_role("button", name="Move it here").click()
    keys.get_by_role("button", name="Remove F from Next frame, Frames").click()
    keys.get_by_role("button", name="Remove Right from Next frame, Frames").click()
    page.keyboard.press("Escape")
    expect(keys).to_be_hidden()

    try:
        picture.element.focus()
        page.keyboard.press("f")
        page.keyboard.press("q")
        expect(page.get_by_label("Frame", exact=True)).to_have_value("1")
        page.get_by_role("button", name="Next frame", exact=True).hover()
        expect(page.get_by_role("tooltip")).to_have_text("Next frame (Q)")
        page.keyboard.press("F1")
        expect(page.get_by_role("dialog")).to_contain_text("no key")
        page.wait_for_function("() => localStorage.getItem('handloom/keys-unsent') === null")
        assert studio.get("/account")["preferences"]["keys"]["frame.next"] == ["Q"]

        elsewhere = open_page()
        elsewhere.goto(f"/recordings/{recording['id']}/annotate")
        picture_of(elsewhere).wait()
        elsewhere.wait_for_function("() => (localStorage.getItem('handloom/keys') ?? '').includes('frame.next')")
        elsewhere.keyboard.press("q")
        expect(elsewhere.get_by_label("Frame", exact=True)).to_have_value("1")
        elsewhere.keyboard.press("F2")
        elsewhere.get_by_role("button", name="Restore defaults").click()
        elsewhere.wait_for_function("() => localStorage.getItem('handloom/keys-unsent') === null")
        assert studio.get("/account")["preferences"]["keys"] == {}
    finally:
        studio.send("PUT", "/account/preferences", json={})
