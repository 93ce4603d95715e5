"""What is changed belongs to the picture on the screen: over a slow network, without one, and while frames go by."""

from __future__ import annotations

import re
import uuid
from collections import Counter
from typing import Any

import httpx
import pytest

from tests.web.conftest import HeldBack

pytestmark = [pytest.mark.browser, pytest.mark.timeout(240)]

PICTURE = re.compile(r"/frames/(\d+)/(color\.jpg|depth\.bin)")
FROM_NINE = re.compile(r"/frames/(9|1\d)/color\.jpg")
"""More than is loaded in advance at frame 0."""


def frame_of(url: str) -> int:
    found = PICTURE.search(url)
    assert found
    return int(found[1])


def history_of(studio, recording, frame, hand="right", camera="cam0") -> list[dict[str, Any]]:
    """Newest first; empty where nobody has marked anything."""
    answer = studio.send("GET", f"/sequences/{recording['id']}/annotations/{camera}/{frame}/{hand}/history")
    return answer.json()["items"] if answer.is_success else []


def put(studio, recording, points, frame=0) -> None:
    path = f"/sequences/{recording['id']}/annotations/cam0/{frame}/right"
    body = {"points": points, "operation_id": str(uuid.uuid4())}
    studio.send("PUT", path, json=body, headers={"If-None-Match": "*"}).raise_for_status()


def places(item: dict[str, Any]) -> list[list[int]]:
    return [[round(x), round(y), v] for x, y, v in item["points"]]


def note_of(page):
    return page.locator("[data-picture-note]")


THREE = [[200, 200, 2], [240, 200, 2], [280, 200, 1]] + [[0, 0, 0]] * 18

KEYS = [
    "Enter",
    "Shift+ArrowRight",
    "Alt+Shift+ArrowDown",
    "q",
    "o",
    "Shift+o",
    "x",
    "Shift+Delete",
    "b",
    "Control+b",
    "Alt+t",
    "a",
    "Shift+a",
    "Shift+t",
    "k",
    "Shift+k",
    "Control+z",
    "Control+y",
]
"""Every key that changes labels."""


COUNT_OBSERVERS = """
  window.observed = 0;
  const observe = ResizeObserver.prototype.observe;
  ResizeObserver.prototype.observe = function (element, options) {
    if (element.matches("[data-picture]")) window.observed += 1;
    return observe.call(this, element, options);
  };
"""


def test_the_pane_is_in_reach_at_every_drawing_so_that_no_picture_stays_unnoted(
    studio, recording, open_page, picture_of
):
    page = open_page()
    page.add_init_script(COUNT_OBSERVERS)
    page.goto(f"/recordings/{recording['id']}/annotate")
    picture = picture_of(page)
    picture.wait()
    picture.element.focus()
    for _ in range(4):
        page.keyboard.press("f")
        picture.wait()
    assert page.evaluate("observed") == 1, "the pane was let go and taken hold of again between two frames"


def test_nothing_is_changed_in_a_picture_that_is_not_on_the_screen(
    studio, recording, open_page, picture_of, screenshots
):
    from playwright.sync_api import expect

    put(studio, recording, THREE)
    page = open_page()
    page.goto(f"/recordings/{recording['id']}/annotate")
    slow = HeldBack(page, FROM_NINE)
    picture = picture_of(page)
    picture.wait()
    picture.drag((240, 200), (250, 220))  # there is something to undo
    picture.wait_until_saved()
    before = history_of(studio, recording, 0)

    page.keyboard.press("v")
    picture.click(400, 300)
    expect(page.get_by_label("Frame", exact=True)).to_have_value("10")
    assert picture.element.get_attribute("data-drawn") == "0", "the picture of frame 10 has not come"
    expect(note_of(page)).to_contain_text("Waiting for the picture of frame 10")
    expect(note_of(page)).to_contain_text("That had no effect")
    expect(page.get_by_test_id("next-click")).to_contain_text("No effect: the picture of frame 10 is on its way")
    screenshots.take(page, "stale-picture")
    picture.click(200, 200, button="right")
    picture.drag((250, 220), (300, 300))
    page.keyboard.down("Alt")
    picture.drag((400, 300), (420, 310))
    page.mouse.wheel(0, 300)
    page.keyboard.up("Alt")
    page.mouse.dblclick(*picture.at(200, 200))
    for key in KEYS:
        page.keyboard.press(key)
        expect(page.get_by_label("Frame", exact=True)).to_have_value("10")
    for tool in ("Outside the image", "Undo"):
        page.get_by_role("button", name=tool).click()
    picture.element.focus()

    slow.release()
    picture.wait()
    expect(note_of(page)).to_be_hidden()
    expect(page.get_by_test_id("next-click")).to_have_text("Next click places the right wrist")
    picture.click(410, 310)
    picture.wait_until_saved()
    [only] = history_of(studio, recording, 10)
    assert places(only)[:2] == [[410, 310, 2], [0, 0, 0]], "one joint, by the one click on the picture itself"
    assert history_of(studio, recording, 0) == before
    marked = {
        (item["frame"], item["hand"]) for item in studio.get(f"/sequences/{recording['id']}/annotations")["items"]
    }
    assert marked == {(0, "right"), (10, "right")}
    assert studio.get(f"/sequences/{recording['id']}/key-frames")["items"] == []


def test_marks_are_drawn_on_the_picture_they_belong_to_and_a_drag_ends_where_it_began(
    studio, recording, open_page, picture_of
):
    put(studio, recording, THREE)
    page = open_page()
    page.goto(f"/recordings/{recording['id']}/annotate")
    slow = HeldBack(page, FROM_NINE)
    picture = picture_of(page)
    picture.wait()

    def is_marked(x, y):
        """Whether the layer of marks has anything at an image pixel."""
        box = picture.element.bounding_box()
        left, top = picture.at(x, y)
        return page.evaluate(
            """([x, y]) => {
              const canvas = document.querySelectorAll('[data-picture] canvas')[1];
              const ratio = canvas.width / canvas.clientWidth;
              return canvas.getContext('2d').getImageData(ratio * x, ratio * y, 1, 1).data[3] > 60;
            }""",
            [left - box["x"], top - box["y"]],
        )

    assert is_marked(200, 200)
    page.keyboard.press("v")
    page.wait_for_function("() => document.querySelector('[data-picture]').dataset.frame === '10'")
    page.wait_for_timeout(100)  # the layer is drawn at the next refresh, or never
    assert is_marked(200, 200), "the picture is still that of frame 0, and so are the marks"
    slow.release()
    picture.wait()
    page.wait_for_function("() => document.querySelector('[data-picture]').dataset.drawn === '10'")
    assert not is_marked(200, 200)
    page.keyboard.press("c")
    picture.wait()

    before = history_of(studio, recording, 0)
    page.mouse.move(*picture.at(240, 200))
    page.mouse.down()
    page.mouse.move(*picture.at(250, 230), steps=3)
    page.keyboard.press("f")
    picture.wait()
    page.mouse.move(*picture.at(300, 300), steps=3)
    page.mouse.up()
    page.mouse.move(*picture.at(420, 320))
    page.mouse.down()
    page.keyboard.press("f")
    picture.wait()
    page.mouse.up()
    page.keyboard.press("d")
    picture.wait()
    page.mouse.move(*picture.at(300, 120))
    picture.click(420, 120)
    picture.wait_until_saved()
    assert history_of(studio, recording, 0) == before, "a drag that another picture came into is called off"
    assert history_of(studio, recording, 2) == [], "a press on one picture is no click on another"
    [only] = history_of(studio, recording, 1)
    assert places(only)[:2] == [[420, 120, 2], [0, 0, 0]]


@pytest.mark.slow
def test_without_a_network_each_picture_is_asked_for_seldom_and_comes_by_itself_once_it_is_back(
    studio, recording, open_page, picture_of, screenshots
):
    from playwright.sync_api import expect

    page = open_page()
    page.goto(f"/recordings/{recording['id']}/annotate")
    picture = picture_of(page)
    picture.wait()
    page.wait_for_load_state("networkidle")
    asked: Counter[int] = Counter()
    page.on("request", lambda request: PICTURE.search(request.url) and asked.update([frame_of(request.url)]))
    page.context.set_offline(True)
    page.keyboard.press("v")
    page.keyboard.press("v")
    expect(note_of(page)).to_contain_text("The picture of frame 15 could not be loaded")
    expect(note_of(page)).to_contain_text("The studio does not answer. Check this computer's network")
    expect(note_of(page)).to_contain_text("It is asked for again by itself")
    page.wait_for_timeout(4000)  # so many seconds without a network
    screenshots.take(page, "no-network")
    assert asked.total() <= 20, asked
    assert max(asked.values()) <= 4, "at once, after 1 s, after 2 s more, and not more than that"
    picture.click(400, 300)
    page.context.set_offline(False)
    picture.wait()
    expect(note_of(page)).to_be_hidden()
    picture.click(410, 310)
    picture.wait_until_saved()
    [only] = history_of(studio, recording, 15)
    assert places(only)[:2] == [[410, 310, 2], [0, 0, 0]]

    # What the server does not have is asked for once, and again when somebody comes to it anew.
    missing = {"error": "NotFoundError", "detail": "Frame 3 has no such picture."}
    page.route(re.compile("/frames/3/"), lambda route: route.fulfill(status=404, json=missing))
    page.goto(f"/recordings/{recording['id']}/annotate?frame=3")
    note = note_of(page)
    expect(note).to_contain_text("The picture of frame 3 could not be loaded")
    expect(note).to_contain_text("Frame 3 has no such picture.")
    asked.clear()
    page.wait_for_timeout(2000)
    assert asked[3] == 0
    picture.element.focus()
    page.keyboard.press("f")
    picture.wait()
    expect(note).to_be_hidden()
    page.unroute_all()
    page.keyboard.press("d")
    picture.wait()
    assert asked[3] == 1
    page.route(re.compile("/frames/14/"), lambda route: route.fulfill(status=404, json=missing))
    page.get_by_label("Frame", exact=True).fill("14")
    note.get_by_role("button", name="Try now").wait_for()
    page.unroute_all()
    note.get_by_role("button", name="Try now").click()
    picture.wait()


def test_a_stray_click_moves_no_joint_of_a_finished_hand_and_an_outside_joint_can_be_fetched_back(
    studio, recording, open_page, picture_of, screenshots
):
    from playwright.sync_api import expect

    put(studio, recording, [[100 + 20 * joint, 200, 2] for joint in range(21)])
    page = open_page()
    page.goto(f"/recordings/{recording['id']}/annotate")
    picture = picture_of(page)
    picture.wait()
    next_click = page.get_by_test_id("next-click")

    def stored():
        picture.wait_until_saved()
        return places(history_of(studio, recording, 0)[0])

    before = stored()
    expect(next_click).to_have_text(
        "Next click changes nothing: all joints of the right hand are marked. Drag a joint, or select it first"
    )
    picture.click(300, 350)
    page.keyboard.press("Tab")
    expect(next_click).to_have_text("Next click moves the right thumb cmc here")
    picture.click(300, 360)
    assert stored() == [before[0], [300, 360, 2], *before[2:]], "only the joint that was chosen, by the second click"
    expect(next_click).to_contain_text("changes nothing")
    picture.click(310, 380)
    assert len(history_of(studio, recording, 0)) == 2

    seen = []
    for _ in range(4):
        picture.click(300, 360, button="right")
        seen.append(stored()[1])
        screenshots.take(page, f"right-click-{len(seen)}")
    assert seen == [[300, 360, 1], [300, 360, 0], [300, 360, 2], [300, 360, 1]]

    # One that was never placed is fetched back by its line.
    page.keyboard.press("x")
    page.keyboard.press("o")
    assert stored()[1] == [-1, -1, 0]
    page.get_by_role("button", name="thumb cmc").click(button="right")
    picture.element.focus()
    assert stored()[1] == [0, 0, 0]
    picture.click(305, 365)
    assert stored()[1] == [305, 365, 2]


def test_depth_is_fetched_only_where_it_is_seen(studio, recording, open_page, picture_of):
    from playwright.sync_api import expect

    page = open_page()
    asked: list[str] = []
    page.on("request", lambda request: asked.append(request.url))
    page.goto(f"/recordings/{recording['id']}/annotate")
    picture = picture_of(page)
    picture.wait()
    for frame in range(1, 6):
        page.keyboard.press("f")
        expect(page).to_have_url(re.compile(f"frame={frame}&"))
    page.wait_for_load_state("networkidle")
    assert not [url for url in asked if "depth" in url], "colour alone is shown"
    page.keyboard.press("i")
    picture.wait()
    page.mouse.move(*picture.at(320, 240))
    expect(page.get_by_text(re.compile(r"^\d\.\d{4} m$|^no depth$"))).to_be_visible()
    assert any("depth.bin" in url for url in asked)


def test_the_icon_is_not_asked_for_again_at_every_frame(studio):
    """A browser asks for it anew whenever the address changes, which it does at every frame, unless it may keep it."""
    link = re.search(r'<link rel="icon" href="([^"]+)"', httpx.get(studio.url).text)
    assert link
    assert "immutable" in httpx.get(studio.url + link[1]).headers["cache-control"]
