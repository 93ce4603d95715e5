"""A lab's own fingertip detector, from its file to the track that tells of it, in a real browser."""

from __future__ import annotations

import re
import time

import pytest

from tests.web.conftest import import_copy
from tracker.detection.default_detector import DATA as DETECTOR

pytestmark = [pytest.mark.browser, pytest.mark.timeout(600)]


@pytest.mark.slow
def test_a_detector_is_added_chosen_for_a_job_and_told_by_its_track(
    studio, synthesized, open_page, screenshots, tmp_path
):
    from playwright.sync_api import expect

    recording = import_copy(studio, synthesized)
    page = open_page()
    page.goto("/models")
    section = page.get_by_role("region", name="Fingertip detectors")
    file = section.locator("input[type=file]")
    bad = tmp_path / "hand.npz"
    bad.write_bytes(b"\x08\x07\x12\x07pytorch" * 9)
    file.set_input_files(bad)
    refusal = page.get_by_role("alert").filter(has_text="Not added")
    expect(refusal).to_contain_text("hand.npz: found 99 bytes that are no .npz archive; needed a fingertip detector as")
    refusal.get_by_role("button").click()
    file.set_input_files({"name": "Our tips.npz", "mimeType": "", "buffer": DETECTOR.read_bytes()})
    row = section.get_by_role("row", name=re.compile("Our tips"))
    expect(row).to_contain_text("depth")
    [made] = studio.get("/detectors")["items"]
    expect(row).to_contain_text(made["digest"][:12])
    screenshots.take(page, "60-detectors")
    row.get_by_role("button", name="Delete Our tips").click()
    expect(row).to_have_count(0)
    page.get_by_role("button", name="Undo").click()
    expect(row).to_be_visible()

    page.goto(f"/recordings/{recording['id']}")
    page.get_by_role("button", name="Track …").first.click()
    dialog = page.get_by_role("dialog")
    dialog.get_by_role("combobox", name="Fingertip detector").click()
    page.get_by_role("option", name="Our tips").click()
    dialog.get_by_role("radio", name="Fast").click()  # without fingertips
    expect(dialog.get_by_text("use no fingertips")).to_be_visible()
    dialog.get_by_role("radio", name="Balanced").click()
    expect(dialog.get_by_text("use no fingertips")).to_have_count(0)
    dialog.get_by_label("Last frame").fill("2")
    screenshots.take(page, "61-detector-chosen")
    dialog.get_by_role("button", name="Start tracking").click()
    page.wait_for_url(re.compile(r"/jobs/[0-9a-f-]{36}$"))
    expect(page.get_by_text("Our tips")).to_be_visible()
    address = f"/jobs/{page.url.rsplit('/', 1)[1]}"
    assert studio.get(address)["params"]["detector_id"] == made["id"]
    deadline = time.monotonic() + 300
    while (job := studio.get(address))["state"] in ("queued", "running") and time.monotonic() < deadline:
        time.sleep(0.5)
    assert job["state"] == "succeeded", job

    page.goto(f"/tracks/{job['track_id']}?frame=1&layers=mesh,detections,unknown")
    badge = page.get_by_label("Fingertip detector Our tips")
    badge.hover()
    expect(page.get_by_role("tooltip")).to_contain_text(made["digest"])
    card = page.get_by_role("complementary", name="What is seen in this frame")
    expect(card).to_contain_text("Found by “Our tips”, at which the run looked in every frame.", timeout=60_000)
    expect(card.get_by_role("heading", name="Unknown things")).to_be_visible()
    expect(card).to_contain_text(re.compile(r"left out"))
    tools = page.get_by_role("region", name="Image").or_(page.locator("[data-over-picture]"))
    switch = tools.get_by_role("checkbox", name="Unknown things").first
    expect(switch).to_be_checked()
    with page.expect_response(re.compile(r"/frames/2/unknown\.png")) as drawn:
        page.keyboard.press("f")
    assert drawn.value.ok
    switch.uncheck()
    asked: list[str] = []
    page.on("request", lambda request: asked.append(request.url))
    with page.expect_response(re.compile(r"/frames/1/overlay\.png|/frames/0/overlay\.png")):
        page.keyboard.press("Home")
    assert not [url for url in asked if "unknown.png" in url]
    screenshots.take(page, "62-track-with-detector")
