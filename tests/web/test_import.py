"""Importing as a new user: choose files, one page with every question, store."""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path

import cv2
import numpy as np
import pytest
import trimesh

pytestmark = [pytest.mark.browser, pytest.mark.timeout(300)]

SHOWN = "() => [...document.querySelectorAll('main img')].filter((image) => image.naturalWidth > 0).length"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Two series of 16-bit images as a Kinect v2 takes them, and colour; nothing says which is depth."""
    rng = np.random.default_rng(5)
    hand = np.zeros((424, 512), np.uint16)
    hand[120:320, 180:340] = 700
    for number in range(3):
        for name, image in {
            "infrared": rng.integers(300, 9000, hand.shape).astype(np.uint16),
            "range": np.where(hand > 0, hand + number, 0).astype(np.uint16),
            "rgb": np.full((424, 512, 3), 80 * number, np.uint8),
        }.items():
            path = tmp_path / "my take" / name / f"{number:04d}.png"
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(cv2.imencode(".png", image)[1].tobytes())
    return tmp_path / "my take"


def choose(page, folder: Path) -> None:
    from playwright.sync_api import expect

    page.goto("/recordings")
    page.locator("main h1, main h2").first.wait_for()
    page.wait_for_function("() => !document.querySelector('main .mantine-Skeleton-root')")
    page.get_by_test_id("choose-folder").first.set_input_files(folder)
    expect(page.get_by_role("heading", name="Import report")).to_be_visible()


def test_files_become_a_recording_in_one_round_without_typing_a_pattern(studio, folder, open_page, screenshots):
    from playwright.sync_api import expect

    page = open_page()
    choose(page, folder)
    # Everything is asked at once, and nothing that is optional is starred.
    for label in ("Focal length fx, px", "Principal point cx, px", "Principal point cy, px", "Depth unit, m"):
        field = page.get_by_label(re.compile(f"^{label}"))
        expect(field).to_have_attribute("aria-invalid", "true")
    expect(page.get_by_label("Focal length fy, px", exact=True)).not_to_have_attribute("aria-invalid", "true")
    expect(page.get_by_text("Still needed: depth images, focal length fx")).to_be_visible()
    store = page.get_by_role("button", name="Store the recording")
    expect(store).to_be_disabled()
    # The series are shown as pictures: first, middle and last of colour and of both series of 16 bits.
    page.wait_for_function(f"() => ({SHOWN})() === 9")
    screenshots.take(page, "20-import-questions")
    page.get_by_label("Name of the recording").fill("Box in hand")
    page.get_by_role("radio", name="range/*.png").click()
    # The guess is offered, not taken.
    expect(page.get_by_text("A guess, from the size of the images")).to_contain_text("Kinect v2")
    page.get_by_role("button", name="Use its typical values").click()
    expect(page.get_by_text("Typical values, not this camera's calibration")).to_be_visible()
    expect(page.get_by_test_id("depth-preview")).to_contain_text("The nearest thing is 0.70 m away")
    expect(store).to_be_enabled()
    # A unit that cannot be right is said beside its field while one types, and nothing typed is lost.
    unit = page.get_by_label(re.compile("^Depth unit, m"))
    unit.fill("")
    unit.press_sequentially("0.05")
    expect(page.get_by_text("Puts the nearest thing at 35 m; needed 0.05 to 5 m.")).to_be_visible()
    expect(store).to_be_disabled()
    unit.fill("")
    unit.press_sequentially("0.001")
    expect(store).to_be_enabled()
    expect(page.get_by_label("Name of the recording")).to_have_value("Box in hand")
    screenshots.take(page, "21-import-answered")
    store.click()
    expect(page.get_by_role("heading", name="Box in hand")).to_be_visible()
    stored = studio.get(f"/sequences/{page.url.rsplit('/', 1)[1]}")
    assert (stored["frame_count"], stored["cameras"][0]["has_color"]) == (3, True)
    assert stored["cameras"][0]["K"][0][0] == pytest.approx(365.456)


def test_a_video_brings_no_questions_about_depth(studio, tmp_path, open_page):
    from playwright.sync_api import expect

    (tmp_path / "clip").mkdir()
    writer = cv2.VideoWriter(str(tmp_path / "clip/cam0.mp4"), cv2.VideoWriter.fourcc(*"mp4v"), 30, (64, 48))
    for number in range(4):
        writer.write(np.full((48, 64, 3), 50 * number, np.uint8))
    writer.release()
    page = open_page()
    choose(page, tmp_path / "clip")
    expect(page.get_by_text("Still needed: focal length fx, principal point cx, principal point cy.")).to_be_visible()
    expect(page.get_by_text("Depth unit")).to_have_count(0)
    expect(page.get_by_text("Sensor", exact=True)).to_have_count(0)


def test_the_size_of_an_object_is_shown_and_its_unit_chosen_before_it_is_stored(
    studio, synthesized, tmp_path, open_page, screenshots
):
    from playwright.sync_api import expect

    folder = tmp_path / "with a cube"
    shutil.copytree(synthesized.folder, folder, ignore=shutil.ignore_patterns("models", "truth.npz"))
    (folder / "objects").mkdir()
    trimesh.creation.box((6.0, 6.0, 6.0)).export(folder / "objects" / "cube.ply")
    document = json.loads((folder / "sequence.json").read_text())
    document["objects"] = [{"name": "cube", "model": "objects/cube.ply"}]
    (folder / "sequence.json").write_text(json.dumps(document))

    page = open_page()
    choose(page, folder)
    unit = page.get_by_role("radiogroup", name="Unit of the objects’ meshes")
    expect(unit.get_by_label("Millimetres: cube is 0.6 x 0.6 x 0.6 cm (guessed)")).to_be_checked()
    expect(page.get_by_text("cube, 0.60 × 0.60 × 0.60 cm (guessed)")).to_be_visible()
    screenshots.take(page, "24-import-object-guessed")
    unit.get_by_label("Centimetres: cube is 6 x 6 x 6 cm").check()
    expect(page.get_by_text("cube, 6.0 × 6.0 × 6.0 cm")).to_be_visible()
    screenshots.take(page, "25-import-object")
    page.get_by_role("button", name="Store the recording").click()
    expect(page).to_have_url(re.compile(r"/recordings/[0-9a-f-]{36}$"))
    stored = studio.data_dir / "sequences" / page.url.rpartition("/")[2] / "sequence.json"
    assert json.loads(stored.read_text())["objects"][0]["metres_per_unit"] == 0.01
