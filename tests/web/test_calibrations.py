"""From films of a board to calibrated cameras and a recording that takes them, in a real browser."""

from __future__ import annotations

import re

import numpy as np
import pytest

from tests.server.calibrations.films import OFFSET_S, render_films
from tests.web.test_accessibility import find_faults
from tests.web.test_pages import NOTHING_LOADS

pytestmark = [pytest.mark.browser, pytest.mark.timeout(420)]


def files(*names: str) -> list[dict[str, object]]:
    films = render_films()
    return [{"name": name, "mimeType": "video/x-msvideo", "buffer": films[name]} for name in names]


@pytest.mark.slow
def test_a_board_is_chosen_films_are_sent_checked_and_calibrated_and_a_recording_takes_the_cameras(
    studio, open_page, screenshots
):
    from playwright.sync_api import expect

    page = open_page()
    page.goto("/recordings")
    page.get_by_role("link", name=re.compile("Cameras|calibrate them from a filmed board")).first.click()
    page.get_by_role("link", name="Calibrate cameras").click()
    board = page.get_by_role("region", name="The board")
    expect(board.get_by_role("img", name="The board: 5 by 7")).to_be_visible()
    with page.expect_download() as downloaded:
        board.get_by_role("link", name="Print (PDF)").click()
    assert downloaded.value.path().read_bytes().startswith(b"%PDF")
    board.get_by_label("Squares down").fill("4")
    board.get_by_label("Square, mm").fill("60")
    board.get_by_label("Marker, mm").fill("70")
    expect(board.get_by_role("alert")).to_contain_text("a marker measures 70 mm; needed less than the 60 mm")

    page.get_by_label("Films of the cameras").set_input_files(files("cam1.avi"))
    problems = page.get_by_role("region", name="Before the films can be sent")
    expect(problems).to_contain_text("1 camera; needed 2 to 16")
    expect(page.get_by_role("button", name="Send and check")).to_be_disabled()
    page.get_by_label("Films of the cameras").set_input_files(files("cam0.avi"))
    page.get_by_label("Name of the camera of cam1.avi").fill("cam0")
    expect(problems).to_contain_text("cam0: two cameras have this name")
    page.get_by_label("Name of the camera of cam1.avi").fill("cam1")
    expect(problems).to_have_count(0)
    page.get_by_label("Largest offset, s").fill("1")
    page.get_by_label("Name of the calibration").fill("Rig of the test")
    assert not find_faults(page)
    screenshots.take(page, "70-new-calibration")
    page.get_by_role("button", name="Send and check").click()

    page.wait_for_url(re.compile(r"/calibrations/[0-9a-f-]{36}$"))
    calibration = page.url.rsplit("/", 1)[1]
    refusal = page.get_by_role("region", name="One thing must be fixed")
    expect(refusal).to_contain_text("a marker measures 70 mm")
    expect(page.get_by_role("button", name="Calibrate", exact=True)).to_be_disabled()
    board.get_by_label("Marker, mm").fill("45")
    board.get_by_role("combobox", name="Markers").click()
    page.get_by_role("option", name="4X4_50", exact=True).click()
    page.get_by_role("button", name="Check again").click()
    expect(refusal).to_have_count(0)
    expect(page.get_by_role("region", name="Films").get_by_role("row")).to_have_count(3)
    assert not find_faults(page)
    screenshots.take(page, "71-films-checked")
    page.get_by_role("button", name="Calibrate", exact=True).click()
    expect(page.get_by_role("region", name="The job")).to_be_visible()

    table = page.get_by_role("region", name="Cameras")
    expect(table.get_by_role("row", name=re.compile("cam1"))).to_be_visible(timeout=120_000)
    result = studio.get(f"/calibrations/{calibration}")["result"]
    offset = result["cameras"][1]["time_offset"]
    assert abs(offset["seconds"] - OFFSET_S) < 0.01
    expect(table.get_by_role("row", name=re.compile("cam1"))).to_contain_text(f"{1000 * offset['seconds']:.1f}")
    expect(page.get_by_role("region", name=re.compile("to look at"))).to_contain_text("cam1: is out of step")
    space = page.get_by_role("group", name=re.compile("2 cameras and [0-9]+ places of the board in space"))
    expect(space).to_have_attribute("data-ready", "true")
    page.get_by_role("button", name="Above").click()
    coverage = page.get_by_role("img", name="Where cam1 saw the board")
    coverage.scroll_into_view_if_needed()
    page.wait_for_function("(picture) => picture.naturalWidth === 960", arg=coverage.element_handle())
    assert not find_faults(page)
    screenshots.take(page, "72-calibrated")
    page.get_by_role("button", name="Download").click()
    with page.expect_download() as downloaded:
        page.get_by_role("menuitem", name="Anipose (.toml)").click()
    assert b'name = "cam1"' in downloaded.value.path().read_bytes()
    page.keyboard.press("Escape")

    page.goto("/recordings")
    page.wait_for_function(NOTHING_LOADS)  # until then the page has another button to import by
    page.get_by_test_id("choose-files").set_input_files(files("cam0.avi", "cam1.avi"))
    page.wait_for_url(re.compile(r"/imports/[0-9a-f-]{36}$"), timeout=90_000)
    expect(page.get_by_text("2 videos and no calibration")).to_be_visible()
    cameras = page.get_by_role("region", name="Cameras of these videos")
    cameras.get_by_role("combobox").click()
    page.get_by_role("option", name=re.compile("Rig of the test: 2 cameras")).click()
    store = page.get_by_role("button", name="Store the recording")
    expect(store).to_be_enabled()
    expect(page.get_by_label(re.compile("Unit of the calibration"))).to_have_count(0)
    screenshots.take(page, "73-import-with-calibration")
    store.click()
    page.wait_for_url(re.compile(r"/recordings/[0-9a-f-]{36}$"))
    recording = studio.get(f"/sequences/{page.url.rsplit('/', 1)[1]}")
    assert [camera["id"] for camera in recording["cameras"]] == ["cam0", "cam1"]
    places = (side["cameras"][1]["T_world_camera"] for side in (recording, result))
    np.testing.assert_allclose(*places, atol=1e-9)
