"""A moving scan in a real browser: imported by files, played by keys, registered, curated by stretch, kept."""

from __future__ import annotations

import json
import re
import zipfile
from pathlib import Path
from typing import Any

import pytest

from tests.server.moving_scans.moving import MovingPerson, moving_person
from tests.web.conftest import OpenPage, Screenshots, Studio
from tracker import load_mano

__all__ = ["moving_person"]

pytestmark = [pytest.mark.browser, pytest.mark.timeout(420)]


def add(page: Any, person: MovingPerson, folder: Path, name: str) -> None:
    """Choose the three frames and a broken one between them, and open what becomes of them."""
    from playwright.sync_api import expect

    folder.mkdir()
    for file, data in person.files.items():
        (folder / file).write_bytes(data)
    (folder / "frame0b.ply").write_bytes(b"ply\nnothing\n")
    page.goto("/scans")
    page.get_by_text("Moving people").click()
    page.set_input_files("[data-testid=choose-moving-files]", sorted(folder.iterdir()))
    dialog = page.get_by_role("dialog")
    dialog.get_by_label("Name").fill(name)
    dialog.get_by_label("Subject").fill("Ada")
    dialog.get_by_role("button", name="Add 4 files").click()
    expect(dialog).to_contain_text("1 frame cannot be used")
    expect(dialog.get_by_role("alert")).to_contain_text("frame0b.ply")
    dialog.get_by_role("button", name="Open").click()


def wait_for_frame(page: Any, frame: int) -> None:
    """Until the frame is on the screen."""
    from playwright.sync_api import expect

    view = page.get_by_role("application")
    expect(page.get_by_test_id("moving-frame")).to_have_text(f"frame {frame} of 4")
    expect(view).to_have_attribute("data-drawn", str(frame))
    expect(view).to_have_attribute("aria-busy", "false")


@pytest.mark.slow
def test_a_moving_scan_is_imported_listed_and_played_with_the_keyboard(
    open_page: OpenPage, moving_person: MovingPerson, tmp_path: Path
) -> None:
    from playwright.sync_api import expect

    page = open_page()
    add(page, moving_person, tmp_path / "walking", "Ada walks")
    wait_for_frame(page, 0)
    page.keyboard.press("ArrowRight")
    expect(page.get_by_label("The frame", exact=True)).to_contain_text("frame0b.ply cannot be used")
    page.keyboard.press("f")
    wait_for_frame(page, 2)
    page.keyboard.press("End")
    wait_for_frame(page, 3)
    page.keyboard.press("d")
    wait_for_frame(page, 2)
    page.keyboard.press("Home")
    wait_for_frame(page, 0)
    page.keyboard.press("Space")
    wait_for_frame(page, 3)
    strip = page.get_by_role("slider", name="Timeline")
    box = strip.bounding_box()
    page.mouse.click(box["x"] + 0.6 * box["width"], box["y"] + 5)
    wait_for_frame(page, 2)
    page.wait_for_url(re.compile("frame=2"))
    page.reload()
    wait_for_frame(page, 2)
    page.get_by_role("button", name="More").click()
    page.get_by_role("menuitem", name="Delete").click()
    expect(page.get_by_role("link", name="Ada walks")).to_have_count(0)
    page.get_by_role("button", name="Undo").click()
    expect(page.get_by_role("link", name="Ada walks")).to_be_visible()
    expect(page.get_by_role("row", name=re.compile("Ada walks"))).to_contain_text("3 of 4")


@pytest.mark.slow
def test_a_moving_scan_is_registered_looked_at_and_curated_by_stretch(
    open_page: OpenPage, moving_person: MovingPerson, studio: Studio, screenshots: Screenshots, tmp_path: Path
) -> None:
    from playwright.sync_api import expect

    page = open_page()
    add(page, moving_person, tmp_path / "waving", "Ada waves")
    wait_for_frame(page, 0)
    scan_id = page.url.split("/")[-1].split("?")[0]
    page.get_by_role("button", name="Register …").click()
    page.get_by_label("First frame").fill("2")
    expect(page.get_by_label("Frames of a chunk")).to_have_value("50")
    screenshots.take(page, "moving-register")
    page.get_by_label("Frames of a chunk").fill("1")
    page.get_by_role("dialog").get_by_role("button", name="Register", exact=True).click()
    expect(page.get_by_role("region", name="The job")).to_be_visible()
    expect(page.get_by_role("dialog")).to_have_count(0)
    page.keyboard.press("End")
    wait_for_frame(page, 3)
    frame = page.get_by_label("The frame", exact=True)
    expect(frame).to_contain_text("Scan to body, mean", timeout=300_000)
    expect(page.get_by_text("The left hand is guessed: the scan does not show it", exact=True)).to_be_visible()
    expect(frame).to_contain_text("the left hand is guessed")
    wait_for_frame(page, 3)
    page.keyboard.press("e")
    expect(page.get_by_text("3 mm and more between scan and body")).to_be_visible()
    expect(page.get_by_role("region", name="The job")).to_have_count(0, timeout=60_000)
    screenshots.take(page, "moving-errors")

    page.keyboard.press("i")
    decisions = page.get_by_role("list", name="Decisions about this registration")
    accepted = page.get_by_label("Accepted frames")
    page.get_by_role("application").focus()
    page.keyboard.press("a")
    expect(decisions).to_contain_text("frame 3")
    expect(accepted).to_contain_text("Accepted, 1 of 4 frames")
    page.keyboard.press("z")
    expect(decisions).to_have_count(0)
    expect(accepted).to_contain_text("Accepted, 0 of 4 frames")
    page.get_by_label("From frame").fill("2")
    page.get_by_role("button", name="Accept", exact=True).click()
    expect(accepted).to_contain_text("frames 2 to 3")
    expect(accepted).to_contain_text("registration 1, mixture prior")
    told = studio.get(f"/moving-scans/{scan_id}/accepted")
    assert (told["frame_count"], told["stretches"][0]["first_frame"], told["stretches"][0]["last_frame"]) == (2, 2, 3)

    page.get_by_role("button", name="Keep what is accepted …").click()
    page.get_by_role("dialog").get_by_label("Name").fill("Waving hands")
    page.get_by_role("dialog").get_by_role("button", name="Keep", exact=True).click()
    with page.expect_download() as kept:
        page.get_by_role("link", name="Download Waving hands").click()
    kept.value.save_as(tmp_path / "kept.zip")
    with zipfile.ZipFile(tmp_path / "kept.zip") as archive:
        lineage = json.loads(archive.read("lineage.json"))
    assert [each["scan"] for each in lineage["frames"]] == ["frame1.ply", "frame2.ply"]
    assert lineage["set"]["stretches"][0]["accepted_by_name"]

    page.get_by_role("button", name="Make the person’s model of Waving hands").click()
    page.get_by_role("button", name="The person’s model of Waving hands", exact=True).click(timeout=60_000)
    screenshots.take(page, "moving-model")
    with page.expect_download() as made:
        page.get_by_role("menuitem", name="As SMPL-H, .npz").click()
    made.value.save_as(tmp_path / "SMPLH.npz")
    assert load_mano(tmp_path / "SMPLH.npz").num_bones == 52
    page.get_by_role("button", name="Register …").click()
    dialog = page.get_by_role("dialog")
    expect(dialog.get_by_label("Whose shapes")).to_be_visible()
    dialog.get_by_role("combobox", name="The person’s own model").click()
    page.get_by_role("option", name="Waving hands, from 2 frames").click()
    expect(dialog.get_by_label("Whose shapes")).to_have_count(0)
    screenshots.take(page, "moving-register-with-model")
    page.keyboard.press("Escape")

    page.get_by_role("button", name=re.compile("Register again from frame 2")).click()
    dialog = page.get_by_role("dialog")
    expect(dialog.get_by_role("radio", name="One Gaussian")).to_be_checked()
    dialog.get_by_text("No prior").click()
    dialog.get_by_label("Last frame").fill("2")
    dialog.get_by_role("button", name="Register", exact=True).click()
    choice = page.get_by_role("combobox", name="Registration", exact=True)
    expect(choice).to_have_value("2: no prior, frames 2 to 2", timeout=60_000)
    expect(page.get_by_role("region", name="The job")).to_have_count(0, timeout=120_000)
    page.get_by_role("button", name="Accept", exact=True).click()
    expect(accepted).to_contain_text("registration 2, no prior")
    told = studio.get(f"/moving-scans/{scan_id}/accepted")
    assert [each["registration_number"] for each in told["stretches"]] == [2, 1], "the frame accepted last counts"
