"""Every page in a real browser, dark and light, small and large: it fits, it can be read out, it says what to do."""

from __future__ import annotations

import json
import re
import time
import uuid
import zipfile

import pytest

from tests.web.conftest import Fingers, HeldBack, wait_for_held
from tests.web.test_accessibility import PAGES

pytestmark = [pytest.mark.browser, pytest.mark.timeout(420)]

LOOKS = [
    (1280, 720, "dark"),
    pytest.param(1280, 720, "light", marks=pytest.mark.slow),
    pytest.param(1920, 1080, "dark", marks=pytest.mark.slow),
    pytest.param(1920, 1080, "light", marks=pytest.mark.slow),
]

NAMELESS = """() => [...document.querySelectorAll("button, a[href], input, select, textarea, [role=slider], iframe")]
  .filter((element) => element.offsetParent !== null || element.tagName === "IFRAME")
  .filter((element) => {
    const labels = element.labels ? [...element.labels].map((label) => label.innerText).join("") : "";
    const pointed = (element.getAttribute("aria-labelledby") ?? "").split(" ")
      .map((id) => document.getElementById(id)?.innerText ?? "").join("");
    const name = element.getAttribute("aria-label") || element.title || element.innerText || labels || pointed;
    return !name?.trim();
  })
  .map((element) => element.outerHTML.slice(0, 200))"""

TOO_WIDE = """() =>
  [document.scrollingElement, document.querySelector("main")].some((element) => element.scrollWidth > innerWidth)"""


REDRAWN = """() => new Promise((seen) => requestAnimationFrame(() => requestAnimationFrame(() => seen())))"""

# Choices whose words are cut off, as a long name beside them may do.
CUT_CHOICES = """() => [...document.querySelectorAll("main .mantine-SegmentedControl-root")]
  .filter((element) => element.scrollWidth > element.clientWidth + 1)
  .map((element) => element.innerText)"""

LONG_NAME = ("Opening hand, seen by one camera, " * 4)[:120].strip()
"""As people name recordings when they say everything in the name."""

NOTHING_LOADS = "() => !document.querySelector('main .mantine-Skeleton-root, main [aria-busy=true]')"


QUICK = {"last_frame": 8, "calibrate": False, "terms": "LO"}
"""Parameters: the pages show any track alike."""


@pytest.fixture(scope="module")
def track(studio, synthesized):
    """A tracked recording with an annotation, made through the API."""
    with synthesized.archive.open("rb") as file:
        made = studio.send("POST", "/imports", files={"files": ("opening-hand.zip", file)}).json()
    recording = studio.send("POST", f"/imports/{made['id']}/confirm", json={"name": LONG_NAME}).json()
    points = [[x, y, 2] for x, y in synthesized.joints]
    studio.send(
        "PUT",
        f"/sequences/{recording['id']}/annotations/cam0/0/right",
        json={"points": points, "operation_id": "6a1c1f0e-3a3b-4f0a-9d55-6f1f3b6f0a11"},
        headers={"If-None-Match": "*"},
    ).raise_for_status()
    job = studio.send("POST", "/jobs", json={"kind": "track", "sequence_id": recording["id"], "params": QUICK}).json()
    deadline = time.monotonic() + 300
    while job["state"] in ("queued", "running") and time.monotonic() < deadline:
        time.sleep(0.1)
        job = studio.get(f"/jobs/{job['id']}")
    assert job["state"] == "succeeded", job
    return studio.get(f"/tracks/{job['track_id']}")


@pytest.mark.parametrize(("width", "height", "scheme"), LOOKS)
def test_every_page_fits_and_every_control_has_a_name(studio, track, open_page, screenshots, width, height, scheme):
    """As it is opened, and when the window is made as large or small as on another screen."""
    page = open_page(width, height, scheme)
    recording = track["sequence_id"]
    addresses = {
        "recordings": "/recordings",
        "recording": f"/recordings/{recording}",
        "annotate": f"/recordings/{recording}/annotate?frame=0",
        "tracks": "/tracks",
        "jobs": "/jobs",
        "job": f"/jobs/{track['job_id']}",
        "track": f"/tracks/{track['id']}?frame=3",
        "missing": "/no-such-page",
    }
    for name, address in addresses.items():
        page.goto(address)
        page.locator("main h1, main h2, [data-picture] canvas").first.wait_for()
        page.wait_for_function(NOTHING_LOADS)
        page.wait_for_timeout(6000 if name == "track" and screenshots.folder else 100)
        screenshots.take(page, f"{name}-{width}-{scheme}")
        assert page.evaluate(NAMELESS) == [], f"{name} has controls without a name"
        assert page.get_by_role("heading", level=1).count() == (name != "missing"), f"{name} has one heading of level 1"
        for size in ((width, height), (1040, 720), (1280, 720), (1920, 1080)):
            page.set_viewport_size({"width": size[0], "height": size[1]})
            page.evaluate(REDRAWN)
            assert not page.evaluate(TOO_WIDE), f"{name} scrolls sideways at {size[0]} px"
            assert page.evaluate(CUT_CHOICES) == [], f"{name} has choices that are cut off at {size[0]} px"
        page.set_viewport_size({"width": width, "height": height})


EMPTY = {
    "/recordings": ("Recordings", "No recordings yet"),
    "/calibrations": ("Calibrated cameras", "No cameras are calibrated yet"),
    "/tracks": ("Tracks", "No tracks yet"),
    "/scans": ("Scans", "No scans yet"),
    "/scans/moving": ("Scans", "No moving scans yet"),
}


def test_a_list_without_anything_in_it_keeps_its_heading_and_says_what_to_do(open_page, screenshots):
    from playwright.sync_api import expect

    page = open_page()
    lists = re.compile(r"/api/v1/(sequences|calibrations|tracks|scans|moving-scans)(\?.*)?$")
    page.route(lists, lambda route: route.fulfill(json={"items": [], "next_cursor": None}))
    for address, (heading, told) in EMPTY.items():
        page.goto(address)
        expect(page.get_by_role("heading", level=2)).to_have_text(told)
        expect(page.get_by_role("heading", level=1)).to_have_text(heading)
        screenshots.take(page, f"empty{address.replace('/', '-')}")


# What of the header is cut off, or not to be hit by a finger.
CUT_HEADER = """() => [...document.querySelectorAll("header :is(a, button)")]
  .map((element) => [element.getAttribute("aria-label") ?? element.innerText, element.getBoundingClientRect()])
  .filter(([, box]) => box.width > 0)
  .filter(([, box]) => box.left < 0 || box.right > innerWidth || box.top < 0 || box.bottom > innerHeight)
  .map(([name]) => name)"""
SMALL_TARGETS = """() => [...document.querySelectorAll("button, select, input, [role=tab]")]
  .filter((element) => !element.matches("[type=checkbox], [type=radio], .mantine-MultiSelect-inputField"))
  .filter((element) => element.offsetParent !== null && getComputedStyle(element).visibility === "visible")
  .filter((element) => element.getBoundingClientRect().height < 39.5)
  .map((element) => element.outerHTML.slice(0, 160))"""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("width", "height", "is_phone"), [(390, 844, True), (1040, 720, False)]
)
def test_every_page_fits_a_phone_and_a_narrow_window(studio, track, open_page, screenshots, width, height, is_phone):
    from playwright.sync_api import expect

    page = open_page(width, height, is_phone=is_phone)
    recording = track["sequence_id"]
    addresses = {name: address.format(recording=recording) for name, address, _ in PAGES}
    addresses |= {
        "job": f"/jobs/{track['job_id']}",
        "track": f"/tracks/{track['id']}?frame=3",
        "judged": f"/evaluations?recordings={recording}",
    }
    wide, away, cut, small = [], [], {}, {}
    for name, address in addresses.items():
        page.goto(address)
        page.locator("main h1, main h2, [data-picture] canvas").first.wait_for()
        page.wait_for_function(NOTHING_LOADS)
        if name == "job":
            page.get_by_label("Log of the job").get_by_text("writing the track").wait_for()
        if page.evaluate("Math.max(document.scrollingElement.scrollTop, document.querySelector('main').scrollTop)"):
            away.append(name)
        screenshots.take(page, f"{name}-{width}")
        if page.evaluate(TOO_WIDE):
            wide.append(name)
        if found := page.evaluate(CUT_HEADER):
            cut[name] = found
        if is_phone and (found := page.evaluate(SMALL_TARGETS)):
            small[name] = found
    assert not wide, f"these scroll sideways at {width} px"
    assert not away, "these open somewhere below their top"
    assert not cut, "parts of the header are cut off"
    assert not small, "a finger misses these"
    for room in ("Recordings", "Annotate", "Projects", "Tracks", "Scans", "Curate", "Models", "Evaluations", "Jobs"):
        page.get_by_role("button", name="Menu").click()
        page.get_by_role("navigation", name="Rooms").get_by_role("link", name=room, exact=True).click()
        expect(page).to_have_url(re.compile(f"/{room.lower()}"))
        expect(page.get_by_role("dialog")).to_have_count(0)
    page.get_by_role("button", name="Search").click()
    expect(page.get_by_placeholder("Search recordings, tracks and pages")).to_be_visible()


# Names and figures of which no word is left, because something else in their line takes the place.
CUT_WORDS = """() => [...document.querySelectorAll("main :is(.one-line, .mantine-Badge-label)")]
  .filter(({ clientWidth: seen, scrollWidth: whole }) => seen > 0 && seen < 48 && whole > seen + 1)
  .map((element) => element.innerText)"""
HIGH_ROWS = """() => [...document.querySelectorAll("main tbody tr")]
  .map((row) => [row.innerText, row.getBoundingClientRect().height])
  .filter(([, height]) => height > 100)"""


def test_rows_on_a_phone_are_no_higher_than_their_words_and_cut_none(studio, track, open_page, screenshots):
    """Of batches, people, tokens, the audit trail and what the label check looked at."""
    sequence, name = track["sequence_id"], f"Ann {uuid.uuid4().hex[:6]}"
    batch = {"kind": "track", "sequence_ids": [sequence]}
    studio.send("POST", "/jobs/batch", json=batch).raise_for_status()
    for job in studio.get("/jobs")["items"]:
        if job["state"] in ("queued", "running"):
            studio.send("POST", f"/jobs/{job['id']}/cancel").raise_for_status()
    person = studio.send("POST", "/accounts", json={"name": name, "role": "annotator"}).json()["person"]
    studio.send("POST", "/account/tokens", json={"name": "nightly", "may_write": True}).raise_for_status()
    project = studio.send("POST", "/projects", json={"name": name}).json()["id"]
    studio.send("PUT", f"/projects/{project}/sequences/{sequence}").raise_for_status()
    asked = {"sequence_id": sequence, "frame_first": 0, "frame_last": 1, "account_id": person["id"]}
    studio.send("POST", f"/projects/{project}/assignments", json=asked).raise_for_status()
    page = open_page(390, 844, is_phone=True)
    places = {"people": "/people", "audit": "/audit", "account": "/account", "jobs": "/jobs"}
    cut, high = {}, {}
    for place, address in places.items():
        page.goto(address)
        page.locator("main h1, main h2").first.wait_for()
        page.wait_for_function(NOTHING_LOADS)
        screenshots.take(page, f"rows-{place}-390")
        if found := page.evaluate(CUT_WORDS):
            cut[place] = found
        if place != "account" and (found := page.evaluate(HIGH_ROWS)):
            high[place] = found
        if place == "audit":
            given = page.locator("tr", has_text="assignment · create").first
            assert f"given to {name}" in given.inner_text() and "frames 0 to 1" in given.inner_text()
        assert not page.evaluate(TOO_WIDE), place
    assert not cut, "words are cut off"
    assert not high, "rows are far higher than their words"
    page.goto(f"/recordings/{sequence}/check")
    checked = page.get_by_role("region", name="What was checked")
    checked.wait_for()
    assert checked.evaluate("(card) => card.scrollWidth <= card.clientWidth"), "what is missing runs out of the card"


@pytest.mark.slow
def test_a_track_is_looked_at_by_fingers(studio, track, open_page, picture_of, screenshots):
    from playwright.sync_api import expect

    page = open_page(390, 844, is_phone=True)
    page.goto(f"/tracks/{track['id']}?frame=3")
    picture, fingers, frame = picture_of(page), Fingers(page), page.get_by_test_id("frame")
    picture.wait()
    box = picture.element.bounding_box()
    middle = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    fingers.draw(((middle[0] + 60, middle[1]), (middle[0] - 60, middle[1])))
    expect(frame).to_have_text("frame 4")
    fingers.draw(((middle[0] - 60, middle[1]), (middle[0] + 60, middle[1])))
    expect(frame).to_have_text("frame 3")
    scale = json.loads(picture.element.get_attribute("data-view"))["scale"]
    spread = [((middle[0] + by, middle[1]), (middle[0] + 3 * by, middle[1])) for by in (-30, 30)]
    fingers.draw(*spread)
    page.wait_for_function(
        "(scale) => JSON.parse(document.querySelector('[data-picture]').dataset.view).scale > 2.5 * scale", arg=scale
    )
    expect(frame).to_have_text("frame 3")
    # Zoomed, a finger moves the picture instead.
    fingers.draw(((middle[0] + 60, middle[1]), (middle[0] - 60, middle[1])))
    expect(frame).to_have_text("frame 3")

    over = page.get_by_role("figure", name="Error by frame", exact=True).locator(".u-over").bounding_box()
    y = over["y"] + over["height"] / 2
    fingers.draw(((over["x"] + 2, y), (over["x"] + over["width"] - 2, y)))
    expect(frame).to_have_text(f"frame {track['frame_count'] - 1}")
    page.get_by_text("3D view", exact=True).click()
    expect(page.get_by_role("group", name="Layers of the 3D view")).to_be_visible()
    expect(picture.element).to_be_hidden()

    names = {"/bin": "Bin", "/people": "People", "/account": "Account", "/audit": "Audit trail", "/docs/api": "API"}
    for address, name in names.items():
        page.goto(address)
        expect(page.get_by_role("banner")).to_contain_text(name)
        assert not page.evaluate(TOO_WIDE), address


def test_a_job_tells_the_error_that_the_page_of_its_track_tells(studio, track, synthesized, open_page):
    """The labels have changed since the track was made, and nobody has opened it."""
    from playwright.sync_api import expect

    page = open_page()
    shift = 0.0
    for frame in (4, 8):
        shift += 30.0
        studio.send(
            "PUT",
            f"/sequences/{track['sequence_id']}/annotations/cam0/{frame}/right",
            json={"points": [[x + shift, y, 2] for x, y in synthesized.joints], "operation_id": str(uuid.uuid4())},
            headers={"If-None-Match": "*"},
        ).raise_for_status()
        page.goto(f"/jobs/{track['job_id']}")
        result = page.get_by_role("region", name="Result")
        expect(result.get_by_text("Error, px")).to_be_visible()
        page.wait_for_load_state("networkidle")
        shown = result.inner_text()
        mean = studio.get(f"/tracks/{track['id']}/evaluation")["joint_error_px"]["mean"]
        assert f"{mean:.2f}" in shown, shown


def test_what_is_still_loading_is_not_said_to_be_nothing(studio, track, open_page, screenshots):
    from playwright.sync_api import expect

    page = open_page()
    late = HeldBack(page, re.compile(r"/api/v1/(tracks\?|jobs\?|registrations/counts|tracks/[^/]+/evaluation)"))
    page.goto(f"/recordings/{track['sequence_id']}")
    expect(page.get_by_role("heading", name="Tracks")).to_be_visible()
    wait_for_held(page, late.held, 2)
    expect(page.get_by_text("Not tracked yet")).to_have_count(0)
    screenshots.take(page, "loading-recording")
    late.release()
    expect(page.get_by_role("link", name=track["name"])).to_be_visible()

    late.is_open = False
    page.goto(f"/jobs/{track['job_id']}")
    result = page.get_by_role("region", name="Result")
    expect(result.get_by_text("Error, px")).to_be_visible()
    wait_for_held(page, late.held, 1)
    assert "–" not in result.inner_text(), result.inner_text()
    screenshots.take(page, "loading-job")
    late.release()
    error = studio.get(f"/tracks/{track['id']}/evaluation")["joint_error_px"]["mean"]
    expect(result.get_by_text(f"{error:.2f}", exact=True)).to_be_visible()

    late.is_open = False
    page.goto("/curate")
    expect(page.get_by_role("combobox", name="Queue")).to_be_visible()
    wait_for_held(page, late.held, 1)
    expect(page.get_by_text("0 of 0 decided")).to_have_count(0)
    late.release()


def test_a_part_of_a_page_that_does_not_come_says_so_and_can_be_asked_for_again(studio, track, open_page, screenshots):
    """The page itself is there, one of its lists is not."""
    from playwright.sync_api import expect

    project = studio.send("POST", "/projects", json={"name": "Everything_in_one_word_" * 4}).raise_for_status().json()
    page = open_page()
    parts = re.compile(
        r"/api/v1/(assignments|projects/[^/?]+/(sequences|replica-sets)|sequences/[^/?]+/annotations)([?]|$)"
    )
    page.route(parts, lambda route: route.fulfill(status=500, json={"detail": "Not now."}))
    missing = page.get_by_role("alert").filter(has_text="could not be loaded: Not now.")
    places = {f"/recordings/{track['sequence_id']}": 1, f"/projects/{project['id']}": 3, "/projects": 1}
    for address, count in places.items():
        page.goto(address)
        expect(missing).to_have_count(count)
        # A name that has no end takes no room from what can be pressed.
        labels = page.locator("main .mantine-Button-label")
        assert all(labels.evaluate_all("(all) => all.map((one) => one.scrollWidth <= one.clientWidth + 1)")), address
    screenshots.take(page, "missing-work")
    page.unroute_all()
    missing.get_by_role("button", name="Try again").click()
    expect(missing).to_have_count(0)
    expect(page.get_by_text("Nothing waits for your review", exact=False)).to_be_visible()


def test_files_that_cannot_be_imported_get_a_report_that_says_what_to_do(studio, open_page, screenshots, tmp_path):
    from playwright.sync_api import expect

    archive = tmp_path / "holiday.zip"
    with zipfile.ZipFile(archive, "w") as file:
        file.writestr("holiday/readme.txt", "nothing to see")
    before = len(studio.get("/sequences")["items"])
    page = open_page()
    page.goto("/recordings")
    page.wait_for_function(NOTHING_LOADS)
    page.locator("main h1, main h2").first.wait_for()
    page.get_by_test_id("choose-files").first.set_input_files(str(archive))
    expect(page.get_by_role("heading", name="Import report")).to_be_visible()
    expect(page.get_by_text(re.compile("must be fixed"))).to_be_visible()
    expect(page.get_by_text("found 1 file (txt)")).to_be_visible()
    expect(page.get_by_role("button", name="Store the recording")).to_have_count(0)
    screenshots.take(page, "10-refused")
    page.get_by_role("button", name="Discard").click()
    expect(page).to_have_url(re.compile("/recordings$"))
    assert len(studio.get("/sequences")["items"]) == before


def test_what_is_gone_is_said_with_a_way_on(open_page, screenshots):
    from playwright.sync_api import expect

    nobody = "00000000-0000-4000-8000-000000000000"
    page = open_page()
    for address in (
        f"/recordings/{nobody}",
        f"/recordings/{nobody}/annotate",
        f"/tracks/{nobody}",
        f"/jobs/{nobody}",
        f"/imports/{nobody}",
    ):
        page.goto(address)
        expect(page.get_by_role("alert")).to_contain_text("could not be")
        expect(page.get_by_role("button", name="Try again")).to_be_visible()
        expect(page.get_by_role("alert").get_by_role("link", name=re.compile("^To the "))).to_be_visible()
    screenshots.take(page, "11-gone")
    for cut_off in (f"/recordings/{nobody[:-3]}", "/jobs/abc", f"/models/{nobody[:8]}", f"/scans/{nobody}0"):
        page.goto(cut_off)
        expect(page.get_by_role("heading", name="There is no page at this address")).to_be_visible()
        expect(page.get_by_text("The link may be cut off")).to_be_visible()


def test_a_deleted_recording_comes_back(studio, recording, open_page):
    from playwright.sync_api import expect

    page = open_page()
    page.goto(f"/recordings/{recording['id']}")
    page.get_by_role("button", name="More").click()
    page.get_by_role("menuitem", name="Delete").click()
    expect(page.get_by_text("moved to the bin")).to_be_visible()
    assert studio.send("GET", f"/sequences/{recording['id']}").status_code == 404
    page.get_by_role("button", name="Undo").click()
    expect(page.get_by_role("main").locator(f'a[href="/recordings/{recording["id"]}"]')).to_be_visible()
    assert studio.get(f"/sequences/{recording['id']}")["name"] == recording["name"]


def test_the_page_of_a_thing_that_is_not_there_leads_back_to_its_list(open_page):
    page, gone = open_page(), "00000000-0000-4000-8000-000000000000"
    rooms = ("recordings", "tracks", "scans", "scans/moving", "models", "jobs", "projects", "calibrations")
    for room in rooms:
        for part in ("", "/labels", "/annotate", "/check") if room == "recordings" else ("",):
            page.goto(f"/{room}/{gone}{part}")
            page.get_by_role("alert").get_by_role("link").click()
            page.wait_for_url(f"**/{room}")


@pytest.mark.slow
def test_a_page_whose_thing_was_deleted_does_not_ask_for_it_again(studio, track, recording, open_page):
    """It is left at once; asked again, what is gone would be answered by 404, with a notice or without."""
    from playwright.sync_api import expect

    page = open_page()
    refused: list[str] = []
    page.on("response", lambda answer: refused.append(answer.url) if answer.status == 404 else None)
    for room, thing in (("tracks", track), ("recordings", recording)):
        address = f"/{room}/{thing['id']}"
        page.goto(address)
        page.wait_for_load_state("networkidle")
        page.get_by_role("button", name="More").click()
        page.get_by_role("menuitem", name="Delete").click()
        expect(page).to_have_url(re.compile(f"/{room}$"))
        page.get_by_role("button", name="Undo").click()
        expect(page.get_by_role("main").locator(f'a[href="{address}"]').first).to_be_visible()
        assert refused == []


def test_search_and_help_open_by_key_and_lead_somewhere(recording, open_page, screenshots):
    from playwright.sync_api import expect

    page = open_page()
    page.goto("/jobs")
    page.locator("main h1, main h2").first.wait_for()
    page.keyboard.press("?")
    expect(page.get_by_role("dialog")).to_contain_text("Next annotated frame")
    screenshots.take(page, "12-keyboard-map")
    page.keyboard.press("Escape")
    expect(page.get_by_role("dialog")).to_have_count(0)
    page.keyboard.press("Control+k")
    page.get_by_placeholder("Search recordings, tracks and pages").fill("Annotate opening hand")
    page.wait_for_timeout(400)
    screenshots.take(page, "13-search")
    page.keyboard.press("ArrowDown")
    page.keyboard.press("Enter")
    expect(page).to_have_url(re.compile("/annotate"))
