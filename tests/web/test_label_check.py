"""The label check in a real browser: a mistake is found, walked to, mended or found right."""

from __future__ import annotations

import re
import uuid

import numpy as np
import pytest

from tests.web.conftest import HeldBack

pytestmark = [pytest.mark.browser, pytest.mark.timeout(180)]


@pytest.fixture
def labelled(studio, recording, synthesized):
    """Five labelled frames, in one of which the index tip is off."""
    points = np.array([[x, y, 2.0] for x, y in synthesized.joints])
    for frame in range(5):
        here = points.copy()
        if frame == 2:
            here[8, :2] += (30, 60)
        body = {"points": [[x, y, int(v)] for x, y, v in here.tolist()], "operation_id": str(uuid.uuid4())}
        path = f"/sequences/{recording['id']}/annotations/cam0/{frame}/right"
        studio.send("PUT", path, json=body, headers={"If-None-Match": "*"}).raise_for_status()
    return recording


def test_the_worst_label_comes_first_and_can_be_found_right(studio, labelled, open_page, screenshots):
    from playwright.sync_api import expect

    page = open_page()
    page.goto(f"/recordings/{labelled['id']}/check")
    items = page.get_by_role("list", name="Flagged labels").get_by_role("listitem")
    expect(items.first).to_contain_text("frame 2")
    expect(items.first).to_contain_text("index tip")
    checked = page.get_by_role("region", name="What was checked")
    expect(checked).to_contain_text("Checked: 5 hands in 5 frames, against no track")
    expect(checked.get_by_role("row", name=re.compile("^Finger order"))).to_contain_text("all")
    expect(checked.get_by_role("row", name=re.compile("^Far from the track"))).to_contain_text("there is no track")
    page.wait_for_load_state("networkidle")
    screenshots.take(page, "42-label-check")
    light = open_page(1920, 1080, "light")
    light.goto(f"/recordings/{labelled['id']}/check")
    light.get_by_role("list", name="Flagged labels").wait_for()
    light.wait_for_load_state("networkidle")
    screenshots.take(light, "43-label-check-light")

    before = items.count()
    items.first.get_by_role("button", name="It is right").click()
    expect(items).to_have_count(before - 1)
    page.get_by_text(re.compile(r"^Found right \(1\)")).click()
    expect(page).to_have_url(re.compile("show=right"))
    expect(items).to_have_count(1)
    items.first.get_by_role("button", name="Restore").click()
    expect(page.get_by_role("heading", name="Nothing was dismissed")).to_be_visible()


def test_keys_walk_to_the_mistake_and_mending_it_clears_the_flag(
    studio, labelled, synthesized, open_page, picture_of, screenshots
):
    from playwright.sync_api import expect

    page = open_page()
    page.goto(f"/recordings/{labelled['id']}/annotate?camera=cam0&frame=0&hand=right")
    picture = picture_of(page)
    picture.wait()
    card = page.get_by_role("group", name=re.compile("^Label check: "))
    page.wait_for_timeout(500)
    page.wait_for_load_state("networkidle")
    page.keyboard.press("n")
    expect(page.get_by_label("Frame", exact=True)).to_have_value("2")
    expect(card.first).to_contain_text("index tip")
    picture.wait()
    screenshots.take(page, "44-flag-card")
    x, y = synthesized.joints[8]
    picture.drag((x + 30, y + 60), (x, y))
    picture.wait_until_saved()
    expect(card).to_have_count(0)
    assert all(f["frame"] != 2 for f in studio.get(f"/sequences/{labelled['id']}/flags")["items"])


def test_a_flag_is_put_away_by_a_key(studio, labelled, open_page, picture_of):
    from playwright.sync_api import expect

    page = open_page()
    page.goto(f"/recordings/{labelled['id']}/annotate?camera=cam0&frame=2&hand=right")
    picture_of(page).wait()
    card = page.get_by_role("group", name=re.compile("^Label check: "))
    expect(card.first).to_be_visible()
    count = card.count()
    page.keyboard.press("Shift+I")
    expect(card).to_have_count(count - 1)
    assert studio.get(f"/sequences/{labelled['id']}/flags")["dismissed"] == 1


def test_on_a_phone_a_flag_stands_below_the_picture(labelled, open_page, picture_of, screenshots):
    from playwright.sync_api import expect

    phone = open_page(390, 844, is_phone=True)
    phone.goto(f"/recordings/{labelled['id']}/annotate?camera=cam0&frame=2&hand=right")
    picture = picture_of(phone)
    picture.wait()
    line = phone.get_by_role("button", name=re.compile("^Label check: "))
    expect(line).to_be_visible()
    for name in ("folded", "opened"):
        card = line if name == "folded" else phone.get_by_role("group", name=re.compile("^Label check: ")).first
        expect(card).to_be_visible()
        frame, box = picture.element.bounding_box(), card.bounding_box()
        assert box["y"] >= frame["y"] + frame["height"], f"the {name} card covers the picture"
        assert frame["height"] > 200
        screenshots.take(phone, f"45-flag-on-a-phone-{name}")
        if name == "folded":
            line.tap()
    expect(card).to_contain_text("index tip")
    phone.get_by_role("button", name="Fold the label check").tap()
    expect(line).to_be_visible()


def test_a_label_is_found_right_only_once_its_picture_is_there(labelled, open_page):
    from playwright.sync_api import expect

    page = open_page()
    slow = HeldBack(page, re.compile(r"/color\.jpg"))
    page.goto(f"/recordings/{labelled['id']}/check")
    button = page.get_by_role("button", name="It is right").first
    expect(button).to_be_disabled()
    slow.release()
    expect(button).to_be_enabled()


def test_the_frames_that_need_a_person_stand_in_a_queue_that_leads_to_the_annotator(
    labelled, open_page, picture_of, screenshots
):
    from playwright.sync_api import expect

    page = open_page()
    page.goto(f"/recordings/{labelled['id']}/check")
    page.get_by_text("Frames to look at", exact=True).click()
    expect(page).to_have_url(re.compile("show=frames"))
    items = page.get_by_role("list", name="Frames to look at").locator(":scope > li")
    expect(items).to_have_count(1)
    expect(items.first).to_contain_text("frame 2")
    expect(items.first.get_by_role("list", name="Reasons")).to_contain_text("index tip")
    expect(items.first).to_contain_text("The label is shown.")
    expect(page.get_by_text("The hand detector has not looked through this recording.")).to_be_visible()
    page.wait_for_load_state("networkidle")
    screenshots.take(page, "46-frames-to-look-at")
    items.first.get_by_role("link", name="Look at frame 2, right hand").click()
    picture_of(page).wait()
    expect(page.get_by_label("Frame", exact=True)).to_have_value("2")


def test_the_queue_shows_that_it_is_looked_for_while_the_recording_is_on_its_way(labelled, open_page):
    from playwright.sync_api import expect

    page = open_page()
    slow = HeldBack(page, re.compile(f"/sequences/{labelled['id']}$"))
    page.goto(f"/recordings/{labelled['id']}/check?show=frames")
    expect(page.get_by_role("status", name="Looking for frames that need a person")).to_be_visible()
    slow.release()
    expect(page.get_by_role("list", name="Frames to look at")).to_be_visible()


def test_without_anything_to_go_by_the_queue_says_what_to_do(recording, open_page):
    from playwright.sync_api import expect

    page = open_page()
    page.goto(f"/recordings/{recording['id']}/check?show=frames")
    expect(page.get_by_role("heading", name="The queue is empty")).to_be_visible()
    expect(page.get_by_text("The hand detector has not looked through this recording.")).to_be_visible()
    page.get_by_role("link", name="Track it, or find its hands").click()
    expect(page).to_have_url(re.compile(f"/recordings/{recording['id']}$"))


def test_a_queue_that_does_not_come_can_be_asked_for_again(labelled, open_page):
    from playwright.sync_api import expect

    page = open_page()
    page.route("**/frames-to-look-at*", lambda route: route.abort())
    page.goto(f"/recordings/{labelled['id']}/check?show=frames")
    heading = page.get_by_role("heading", name="The frames to look at could not be loaded")
    expect(heading).to_be_visible(timeout=30_000)
    page.unroute("**/frames-to-look-at*")
    page.get_by_role("button", name="Try again").click()
    expect(page.get_by_role("list", name="Frames to look at").locator(":scope > li")).to_have_count(1)
