"""Judging registrations in a real browser: fast, by keys alone, and without ever losing a decision."""

from __future__ import annotations

import logging
import re
import uuid
from typing import Any

import numpy as np
import pytest

from tests.web.conftest import Fingers, HeldBack, lose_answers, wait_until_unheard
from tests.web.hands import Hands, fill_studio
from tests.web.test_accessibility import find_faults_dark_and_light

pytestmark = [pytest.mark.browser, pytest.mark.timeout(240)]

HANDS = 9
BAR_MS = 150
TURN = "Shift+ArrowLeft"

# From the key going down to the hand being on the screen: drawn to the end by whatever draws, and composed.
WATCH = """() => {
  const view = document.querySelector('[data-hand-view]');
  const gl = view.querySelector('canvas').getContext('webgl2');
  const pixel = new Uint8Array(4);
  window.waits = [];
  let pressed = null;
  window.addEventListener('keydown', (event) => { pressed = event.timeStamp; }, true);
  new MutationObserver(() => {
    if (pressed === null || !view.dataset.drawn) return;
    const from = pressed;
    pressed = null;
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
    requestAnimationFrame(() => setTimeout(() => window.waits.push(performance.now() - from)));
  }).observe(view, { attributes: true, attributeFilter: ['data-drawn'] });
}"""


@pytest.fixture(scope="module")
def hands(studio: Any, tmp_path_factory: pytest.TempPathFactory) -> Hands:
    return fill_studio(studio, tmp_path_factory.mktemp("hands"), HANDS, "curation")


@pytest.fixture
def fresh(studio: Any, hands: Hands) -> Hands:
    """Nobody has decided about anything."""
    _take_all_back(studio)
    return hands


def _take_all_back(studio: Any) -> None:
    for item in _registrations(studio):
        while item["my_decision_id"]:
            path = f"/decisions/{item['my_decision_id']}/undo"
            answer = studio.send("POST", path, json={"operation_id": _new_id()})
            answer.raise_for_status()
            item = answer.json()["registration"]


def _new_id() -> str:
    return str(uuid.uuid4())


def _registrations(studio: Any) -> list[dict[str, Any]]:
    return studio.get("/registrations?collection=curation&order=likely_failures&limit=100")["items"]


def decided(studio: Any) -> list[str | None]:
    return [item["my_decision"] for item in _registrations(studio)]


def history(studio: Any, registration: str) -> list[dict[str, Any]]:
    """Oldest first."""
    return list(reversed(studio.get(f"/registrations/{registration}/decisions")["items"]))


def open_queue(open_page: Any, **options: Any) -> Any:
    page = open_page(**options)
    page.goto("/curate?collection=curation")
    wait_for_hand(page)
    return page


def wait_for_hand(page: Any, registration: str | None = None) -> None:
    page.wait_for_function(
        """(id) => { const drawn = document.querySelector('[data-hand-view]')?.dataset.drawn;
                     return id ? drawn === id : Boolean(drawn); }""",
        arg=registration,
    )


def wait_until_saved(page: Any) -> None:
    from playwright.sync_api import expect

    expect(page.get_by_test_id("save-state")).to_have_text(re.compile("^saved$"))


@pytest.mark.slow
def test_a_phone_curates_by_taps_alone(studio, fresh, open_page, screenshots):
    from playwright.sync_api import expect

    page = open_queue(open_page, width=390, height=844, is_phone=True)
    first, second, third = fresh.registrations[:3]
    wait_for_hand(page, first)
    panel = page.get_by_role("complementary", name="The registration and the decision")
    screenshots.take(page, "curate-phone")
    for name in ("Accept", "Reject", "Unsure", "Undo"):
        box = panel.get_by_role("button", name=name, exact=True).bounding_box()
        assert box["height"] >= 40 and box["y"] > 844 * 2 / 3, f"{name} is in reach of the thumb"
        assert box["y"] + box["height"] <= 844
    # One finger turns the hand, two bring it nearer: what is drawn changes, and nothing is decided.
    view = page.locator("[data-hand-view]")
    box = view.bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    pictures = [view.screenshot()]
    for paths in ([((x, y), (x + 80, y))], [((x - 20, y), (x - 60, y)), ((x + 20, y), (x + 60, y))]):
        Fingers(page).draw(*paths)
        pictures.append(view.screenshot())
    assert len(set(pictures)) == 3
    assert decided(studio)[:3] == [None, None, None]

    panel.get_by_role("button", name="Accept", exact=True).tap()
    wait_for_hand(page, second)
    panel.get_by_role("button", name="Wrist or palm off").tap()
    wait_for_hand(page, third)
    wait_until_saved(page)
    assert decided(studio)[:3] == ["accept", "reject", None]
    assert history(studio, second)[0]["reasons"], "with its reason"
    panel.get_by_role("button", name="Undo").tap()
    wait_for_hand(page, second)
    panel.get_by_role("button", name="Unsure", exact=True).tap()
    wait_for_hand(page, third)
    wait_until_saved(page)
    assert decided(studio)[:3] == ["accept", "unsure", None]

    page.goto("/curate?collection=nobody%27s")
    empty = page.get_by_role("heading", name=re.compile("^Nothing "))
    expect(empty).to_be_visible()
    box = empty.bounding_box()
    assert box["x"] >= 0 and box["width"] > 120 and box["height"] < 64, "it has the screen, not the column of the tools"
    expect(page.get_by_role("button", name="Menu")).to_be_visible()
    assert page.evaluate("document.scrollingElement.scrollWidth <= innerWidth")


@pytest.mark.slow
def test_the_next_hand_is_on_the_screen_within_150_ms_of_the_key_or_twice_what_drawing_takes(
    studio, fresh, open_page, record_property, screenshots
):
    page = open_queue(open_page)
    wait_for_hand(page, fresh.registrations[0])
    screenshots.take(page, "curate-dark-1280")
    page.wait_for_load_state("networkidle")  # somebody looks at the first one
    page.evaluate(WATCH)
    for number in range(1, HANDS):
        for key in (TURN, "aru"[number % 3]):
            page.keyboard.press(key)
            page.wait_for_function("(count) => window.waits.length === count", arg=2 * number - (key == TURN))
            page.wait_for_timeout(250)
        wait_for_hand(page, fresh.registrations[number])
    turns, waits = np.reshape(page.evaluate("window.waits"), (-1, 2)).T
    report = (
        f"key to next hand, ms: median {np.median(waits):.0f}, longest {max(waits):.0f} of {len(waits)}; "
        f"key to the same hand turned: median {np.median(turns):.0f}"
    )
    record_property("curation", report)
    logging.getLogger(__name__).info(report)
    assert len(waits) == HANDS - 1
    assert np.median(waits) <= max(BAR_MS, 2 * np.median(turns)), report
    wait_until_saved(page)
    assert decided(studio) == [{"a": "accept", "r": "reject", "u": "unsure"}["aru"[n % 3]] for n in range(1, HANDS)] + [
        None
    ]


def test_what_is_judged_is_on_the_screen_and_a_held_key_judges_once(studio, fresh, open_page, screenshots):
    from playwright.sync_api import expect

    page = open_page()
    first, second, third = fresh.registrations[:3]
    slow = HeldBack(page, re.compile(f"/registrations/({second}|{third})/geometry"))
    page.goto("/curate?collection=curation")
    wait_for_hand(page, first)
    accept = page.get_by_role("button", name=re.compile("^Accept"))
    page.keyboard.press("a")
    expect(page.get_by_text("Loading the hand")).to_be_visible()
    expect(accept).to_be_disabled()
    page.keyboard.press("a")
    screenshots.take(page, "curate-waits")
    slow.release()
    wait_for_hand(page, second)
    expect(accept).to_be_enabled()
    for _ in range(3):
        page.keyboard.down("r")  # held: the second and the third are repetitions
    page.keyboard.up("r")
    wait_for_hand(page, third)
    wait_until_saved(page)
    assert decided(studio)[:3] == ["accept", "reject", None]


def test_decisions_reasons_and_undo_by_keys_alone(studio, fresh, open_page):
    from playwright.sync_api import expect

    page = open_queue(open_page)
    first, second, third = fresh.registrations[:3]
    page.keyboard.press("5")
    wait_for_hand(page, second)
    page.keyboard.press("Space")
    wait_for_hand(page, third)
    page.keyboard.press("Shift+Space")
    wait_for_hand(page, second)
    page.keyboard.press("a")
    wait_for_hand(page, third)
    page.keyboard.press("z")
    wait_for_hand(page, second)
    page.keyboard.press("Backspace")
    wait_for_hand(page, first)
    page.keyboard.press("u")
    wait_for_hand(page, second)
    wait_until_saved(page)
    assert [(one["decision"], one["reasons"]) for one in history(studio, first)][-3:] == [
        ("reject", ["slid"]),
        ("undo", []),
        ("unsure", []),
    ]
    assert [one["decision"] for one in history(studio, second)][-2:] == ["accept", "undo"]
    assert decided(studio)[:3] == ["unsure", None, None]
    one = history(studio, first)[-3]
    assert one["model_id"] == fresh.model_id
    assert one["author_name"]
    assert one["seconds"] > 0
    expect(page.get_by_test_id("curation-progress")).to_contain_text(f"1 of {HANDS} decided")


def test_no_decision_is_lost_or_doubled_when_the_tab_dies(studio, fresh, open_page):
    before = [len(history(studio, one)) for one in fresh.registrations[:4]]
    page = open_queue(open_page)
    wait_for_hand(page, fresh.registrations[0])
    wait_until_saved(page)

    lose_answers(page, "POST", "/decisions$")  # the tab dies before any comes
    page.keyboard.press("a")
    wait_until_unheard(page)
    for number, key in enumerate("ru1", start=1):  # wait behind the first, in the browser only
        wait_for_hand(page, fresh.registrations[number])
        page.keyboard.press(key)
    wait_for_hand(page, fresh.registrations[4])
    page.keyboard.press("z")
    wait_for_hand(page, fresh.registrations[3])
    assert decided(studio)[1:4] == [None, None, None]
    page.close(run_before_unload=False)

    again = page.context.new_page()
    again.goto("/recordings")  # any page sends what waits
    again.wait_for_function("() => !Object.keys(localStorage).some((name) => name.startsWith('handloom/decisions/'))")
    assert decided(studio)[:4] == ["accept", "reject", "unsure", None]
    made = [
        [one["decision"] for one in history(studio, one)][n:]
        for one, n in zip(fresh.registrations, before, strict=False)
    ]
    assert made == [["accept"], ["reject"], ["unsure"], ["reject", "undo"]]


def test_decisions_made_without_a_network_arrive_when_it_is_back(studio, fresh, open_page, screenshots):
    from playwright.sync_api import expect

    page = open_queue(open_page)
    page.wait_for_load_state("networkidle")  # the next ones are there
    page.context.set_offline(True)
    for number, key in enumerate("aar", start=1):
        page.keyboard.press(key)
        wait_for_hand(page, fresh.registrations[number])
    expect(page.get_by_test_id("save-state")).to_have_text("offline, 3 waiting")
    screenshots.take(page, "curate-offline")
    page.context.set_offline(False)
    page.keyboard.press("Control+s")
    wait_until_saved(page)
    assert decided(studio)[:4] == ["accept", "accept", "reject", None]


def test_how_a_hand_is_drawn_follows_the_keys_and_stays_after_a_reload(studio, fresh, open_page, screenshots):
    page = open_queue(open_page, width=1920, height=1080, scheme="light")
    before = page.screenshot()
    page.keyboard.press("e")
    page.get_by_text("mm and more between scan and mesh").wait_for()
    for key in ("w", "c", "Tab", "b", "Shift+ArrowLeft", "+"):
        page.keyboard.press(key)
    page.wait_for_timeout(300)
    screenshots.take(page, "curate-errors-light-1920")
    assert page.screenshot() != before
    page.reload()
    wait_for_hand(page)
    page.get_by_text("mm and more between scan and mesh").wait_for()
    page.keyboard.press("Escape")
    assert page.evaluate("document.activeElement.closest('[role=toolbar]') !== null"), "the tools can be reached"


def test_the_agreement_page_says_what_there_is_to_do(studio, fresh, open_page, screenshots):
    page = open_page()
    page.goto("/curate/agreement")
    page.get_by_role("button", name="Ask for second reviews …").click()
    page.get_by_role("dialog").get_by_label("Share of them").fill("100")
    page.get_by_role("dialog").get_by_label("Only of those").uncheck()
    page.get_by_role("dialog").get_by_role("button", name="Ask").click()
    page.get_by_text("now wait for a second person").wait_for()
    screenshots.take(page, "agreement")


@pytest.mark.slow
def test_pages_with_hands_on_them_have_no_serious_fault(studio, fresh, open_page):
    page = open_page()
    for address, sign in (
        ("/curate?collection=curation", "[data-hand-view][data-drawn]"),
        (f"/scans/{fresh.scans[0]['id']}", "[data-hand-view][data-drawn]"),
        ("/scans?collection=curation", "tbody tr"),
        (f"/models/{fresh.model_id}", "section[aria-label='The model'] canvas"),
    ):
        page.goto(address)
        page.locator(sign).first.wait_for()
        assert find_faults_dark_and_light(page) == [], address
