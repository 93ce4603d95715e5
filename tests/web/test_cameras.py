"""Several cameras side by side in a real browser: epipolar lines, triangulation, errors of the marks."""

from __future__ import annotations

import base64
import json
import re
import subprocess
import sys
import time
import uuid
import zipfile
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest

from tests.web.conftest import ROOT, HeldBack
from tests.web.test_accessibility import find_faults
from tracker import Camera, load_sequence
from tracker.capture import triangulate

pytestmark = [pytest.mark.browser, pytest.mark.timeout(240)]

CAMERAS = 8
BENT = np.array([-0.16, 0.05, 0.0008, -0.0006])


def bend(folder: Path, camera: dict[str, Any]) -> None:
    """Give a rendered camera a lens that distorts, and its images with it."""
    own = Camera(camera["id"], camera["width"], camera["height"], np.array(camera["K"]), BENT)
    columns, rows = np.meshgrid(np.arange(own.width, dtype=float), np.arange(own.height, dtype=float))
    rays = own.unproject(np.column_stack([columns.ravel(), rows.ravel()]))
    straight = (rays @ own.K.T)[:, :2].reshape(own.height, own.width, 2).astype(np.float32)
    for path in (folder / camera["color"]).parent.glob("*.png"):
        image = cv2.imread(str(path), cv2.IMREAD_UNCHANGED)
        cv2.imwrite(str(path), cv2.remap(image, straight, None, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE))
    camera["distortion"] = BENT.tolist()


@pytest.fixture(scope="module")
def surrounded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A hand in colour, seen by eight cameras, every second one through a lens that distorts."""
    folder = tmp_path_factory.mktemp("surrounded") / "eight-cameras"
    command = ["synthesize", "--motion", "open-close", "--frames", "0:12", "--step", "4", "--cameras", str(CAMERAS)]
    command += ["--size", "320x240", "--noise", "none", "--out", str(folder)]
    subprocess.run([sys.executable, "-m", "server.cli", *command], cwd=ROOT, check=True, capture_output=True)
    document = json.loads((folder / "sequence.json").read_text())
    del document["annotations"]
    for number, camera in enumerate(document["cameras"]):
        del camera["depth"], camera["depth_scale"]
        if number % 2:
            bend(folder, camera)
    (folder / "sequence.json").write_text(json.dumps(document))
    return folder


@pytest.fixture(scope="module")
def archive(surrounded: Path) -> Path:
    path = surrounded.parent / "eight-cameras.zip"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_STORED) as file:
        for found in sorted(surrounded.rglob("*.png")):
            if "depth" not in found.parts:
                file.write(found, found.relative_to(surrounded.parent))
        file.write(surrounded / "sequence.json", "eight-cameras/sequence.json")
    return path


@pytest.fixture
def recording(studio, archive: Path) -> dict[str, Any]:
    with archive.open("rb") as file:
        made = studio.send("POST", "/imports", files={"files": ("eight-cameras.zip", file)})
    made.raise_for_status()
    assert made.json()["state"] == "checked", made.json()["report"]["problems"]
    stored = studio.send("POST", f"/imports/{made.json()['id']}/confirm", json={"name": "Eight cameras"})
    stored.raise_for_status()
    return stored.json()


@pytest.fixture(scope="module")
def cameras(surrounded: Path) -> dict[str, Camera]:
    return {camera.id: camera for camera in load_sequence(surrounded).cameras}


@pytest.fixture(scope="module")
def truth(surrounded: Path, cameras) -> dict[str, np.ndarray]:
    """(21, 2) px of the joints of frame 0 in each camera."""
    with np.load(surrounded / "truth.npz") as file:
        joints = file["joints_3d"][0]
    return {name: camera.project(joints) for name, camera in cameras.items()}


def open_cameras(open_page, picture_of, recording, names, has_detector: bool = False, **size):
    """The annotator with these cameras, and the picture of each; without the hand detector only marks suggest joints."""
    page = open_page(**size)
    if not has_detector:
        page.route(re.compile("/detector$"), lambda route: route.fulfill(json={"items": [], "next_cursor": None}))
    page.goto(f"/recordings/{recording['id']}/annotate?camera={names[0]}&cameras={','.join(names)}")
    pictures = {name: picture_of(page, index) for index, name in enumerate(names)}
    for picture in pictures.values():
        picture.wait()
    return page, pictures


def find_points(studio, recording, camera: str, frame: int = 0) -> list[list[float]] | None:
    items = studio.get(f"/sequences/{recording['id']}/annotations")["items"]
    return next((item["points"] for item in items if (item["camera"], item["frame"]) == (camera, frame)), None)


MARKS, CURSOR = 1, 2
"""Layers of a picture: hands, suggestions and lines; what moves with the cursor. The image itself is below."""


def pixels_of(page, index: int, layer: int) -> np.ndarray:
    """What is drawn on a layer of a picture now, (H, W, 4) in screen pixels."""
    canvas = page.locator("[data-picture]").nth(index).locator("canvas").nth(layer)
    data = canvas.evaluate("(c) => c.toDataURL('image/png').split(',')[1]")
    image = cv2.imdecode(np.frombuffer(base64.b64decode(data), np.uint8), cv2.IMREAD_UNCHANGED)
    assert image is not None
    return image


def is_drawn_at(page, picture, index: int, place, layer: int = MARKS, radius: int = 2) -> bool:
    box = picture.element.bounding_box()
    left, top = picture.at(*place)
    column, row = round(left - box["x"]), round(top - box["y"])
    near = pixels_of(page, index, layer)[row - radius : row + radius + 1, column - radius : column + radius + 1]
    return bool(near.size and near[..., 3].max() > 60)


def test_two_marks_suggest_the_third_and_a_person_accepts_it(
    studio, recording, cameras, truth, open_page, picture_of, screenshots
):
    from playwright.sync_api import expect

    names = ["cam0", "cam1", "cam2"]
    page, pictures = open_cameras(open_page, picture_of, recording, names)
    joint = 8  # the index finger's tip
    page.keyboard.press("m")
    page.keyboard.press("m")  # stay at the joint after a click
    for _ in range(4):
        page.keyboard.press("2")
    expect(page.get_by_test_id("next-click")).to_contain_text("index tip")

    # The first mark: its epipolar line passes through the true place in the other pictures.
    pictures["cam0"].click(*truth["cam0"][joint])
    for index, name in enumerate(names[1:], start=1):
        page.mouse.move(5, 300)
        expect_drawn(page, pictures[name], index, truth[name][joint])
    page.keyboard.press("y")
    expect_drawn(page, pictures["cam1"], 1, truth["cam1"][joint], is_there=False)
    page.keyboard.press("y")

    # T needs two views and says so.
    page.keyboard.press("t")
    expect(page.get_by_text("is marked in two cameras yet")).to_be_visible()

    # The second mark, in another pane: its camera becomes the active one and the joint is still the same.
    pictures["cam1"].click(*truth["cam1"][joint])
    expect(page.locator("[data-camera=cam1]")).to_have_attribute("data-active", "true")
    expect(page.get_by_test_id("next-click")).to_contain_text("index tip")
    pictures["cam0"].wait_until_saved()
    page.keyboard.press("y")  # without the lines only the suggestion can be drawn there
    page.mouse.move(5, 300)
    expect_drawn(page, pictures["cam2"], 2, truth["cam2"][joint], is_there=False)
    page.keyboard.press("t")
    expect_drawn(page, pictures["cam2"], 2, truth["cam2"][joint])
    page.keyboard.press("y")
    screenshots.take(page, "cameras-suggested")
    assert find_points(studio, recording, "cam2") is None, "a suggestion is no label"

    page.keyboard.press("Shift+T")
    expect(page.locator("[data-camera=cam2]")).to_contain_text("1/21")
    pictures["cam0"].wait_until_saved()
    points = find_points(studio, recording, "cam2")
    assert points is not None
    assert points[joint][2] == 2 and [p[2] for p in points].count(0) == 20
    assert np.linalg.norm(np.array(points[joint][:2]) - truth["cam2"][joint]) < 1.0
    page.keyboard.press("Control+z")
    expect(page.locator("[data-camera=cam2]")).to_contain_text("0/21")
    pictures["cam0"].wait_until_saved()
    assert find_points(studio, recording, "cam2") is None, "undone in one step"


def test_the_detector_suggests_in_every_picture_and_one_key_accepts_the_frame(
    studio, recording, truth, open_page, picture_of, screenshots
):
    from playwright.sync_api import expect

    names = ["cam0", "cam1", "cam2"]
    page, pictures = open_cameras(open_page, picture_of, recording, names, has_detector=True)
    page.mouse.move(5, 300)
    for index, name in enumerate(names):
        expect_drawn(page, pictures[name], index, truth[name][0], radius=12)
    screenshots.take(page, "cameras-detected")
    page.get_by_test_id("suggested-by").get_by_role("button", name="Accept all in every picture").click()
    pictures["cam0"].wait_until_saved()
    for name in names:
        expect(page.locator(f"[data-camera={name}]")).to_contain_text("21/21")
        points = np.array(find_points(studio, recording, name))
        assert np.median(np.linalg.norm(points[:, :2] - truth[name], axis=1)) < 8.0
    page.keyboard.press("Control+z")
    pictures["cam0"].wait_until_saved()
    assert [find_points(studio, recording, name) for name in names] == [None, None, None], "undone in one step"


def expect_drawn(page, picture, index: int, place, is_there: bool = True, **how: int) -> None:
    """Wait until something is drawn there, or no more."""
    for _ in range(200):
        if is_drawn_at(page, picture, index, place, **how) == is_there:
            return
        page.wait_for_timeout(50)
    raise AssertionError(
        f"At {place} in picture {index} there should be {'something' if is_there else 'nothing'} drawn."
    )


def put(studio, recording, camera: str, points) -> None:
    path = f"/sequences/{recording['id']}/annotations/{camera}/0/right"
    body = {"points": [[float(x), float(y), 2] for x, y in points], "operation_id": str(uuid.uuid4())}
    studio.send("PUT", path, json=body, headers={"If-None-Match": "*"}).raise_for_status()


def test_the_error_shown_is_the_one_computed_and_the_worst_is_a_key_away(
    studio, recording, cameras, truth, open_page, picture_of, screenshots
):
    from playwright.sync_api import expect

    names = ["cam0", "cam1", "cam2", "cam3"]
    marks = {name: truth[name] + np.random.default_rng(3).normal(0, 0.4, (21, 2)) for name in names}
    marks["cam2"][12] += [6.0, -8.0]
    for name in names:
        put(studio, recording, name, marks[name])
    page, _ = open_cameras(open_page, picture_of, recording, names)
    stacked = np.stack([marks[name] for name in names], axis=1)
    expected = triangulate([cameras[name] for name in names], stacked)
    np.testing.assert_array_equal(expected.is_used[12], [True, True, False, True])
    off = np.where(expected.is_used[12], expected.residuals[12], expected.left_out_residuals[12])

    panel = page.get_by_label("Agreement of the cameras")
    expect(panel).to_contain_text("Worst (Shift+L): middle tip, cam2")
    page.keyboard.press("Shift+L")
    expect(page.locator("[data-camera=cam2]")).to_have_attribute("data-active", "true")
    expect(page.get_by_test_id("next-click")).to_contain_text("middle tip")
    for column, name in enumerate(names):
        shown = panel.get_by_role("button", name=re.compile(f"^{name}"))
        expect(shown).to_contain_text(f"{off[column]:.1f} px")
    expect(panel.get_by_role("button", name=re.compile("^cam2"))).to_contain_text("set aside")
    row = page.get_by_role("button", name="middle tip, visible")
    expect(row).to_contain_text(f"{off.max():.1f} px")
    screenshots.take(page, "cameras-4-errors")

    # L brings the joint to the middle of every picture that has it.
    page.keyboard.press("l")
    for index, name in enumerate(names):
        element = page.locator("[data-picture]").nth(index)
        expect(element).not_to_have_attribute("data-view", re.compile(r'"scale":1\.\d'))
        box = element.bounding_box()
        x, y = picture_of(page, index).at(*marks[name][12])
        assert abs(x - box["x"] - box["width"] / 2) < 2 and abs(y - box["y"] - box["height"] / 2) < 2, name
    screenshots.take(page, "cameras-4-looked-at")


def test_the_cursor_is_followed_in_the_other_pictures_without_lag(recording, truth, open_page, picture_of):
    names = ["cam0", "cam1"]
    page, pictures = open_cameras(open_page, picture_of, recording, names)
    page.mouse.move(*pictures["cam0"].at(*truth["cam0"][0]))
    expect_drawn(page, pictures["cam1"], 1, truth["cam1"][0], layer=CURSOR, radius=6)  # the line is dotted
    with_lines = measure_movement(page, pictures["cam0"].at(*truth["cam0"][0]))
    page.keyboard.press("y")
    without = measure_movement(page, pictures["cam0"].at(*truth["cam0"][0]))
    assert with_lines < 1.5 * without + 16, f"{with_lines:.0f} ms with lines, {without:.0f} ms without"


def measure_movement(page, start: tuple[float, float]) -> float:
    """Median time from a movement of the pointer to the next picture on the screen, ms."""
    return page.evaluate(
        """async ([x, y]) => {
          const picture = document.querySelector("[data-picture]");
          const times = [];
          for (let k = 0; k < 31; k += 1) {
            const began = performance.now();
            const moved = { bubbles: true, clientX: x + k, clientY: y, pointerId: 1 };
            picture.dispatchEvent(new PointerEvent("pointermove", moved));
            await new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve)));
            times.push(performance.now() - began);
          }
          return times.sort((a, b) => a - b)[15];
        }""",
        list(start),
    )


def test_which_cameras_are_shown_is_in_the_address_and_remembered(recording, open_page, picture_of):
    from playwright.sync_api import expect

    page = open_page()
    page.goto(f"/recordings/{recording['id']}/annotate")
    expect(page.locator("[data-picture]")).to_have_count(4)
    page.get_by_role("button", name="4 of 8 cameras").click()
    page.get_by_label("cam1", exact=True).uncheck()
    page.get_by_label("cam6", exact=True).check()
    expect(page).to_have_url(re.compile("cameras=cam0%2Ccam2%2Ccam3%2Ccam6"))
    page.keyboard.press("Escape")
    page.keyboard.press("f")
    expect(page).to_have_url(re.compile("frame=1"))
    expect(page).to_have_url(re.compile("cameras=cam0%2Ccam2%2Ccam3%2Ccam6"))
    page.goto(f"/recordings/{recording['id']}/annotate")
    expect(page.locator("[data-camera]")).to_have_count(4)
    expect(page.locator("[data-camera=cam6]")).to_be_visible()

    # Enlarged and resized, by keys.
    before = page.locator("[data-camera=cam0]").bounding_box()["width"]
    picture_of(page).wait()
    page.locator("[data-picture]").first.focus()
    page.keyboard.press("p")
    expect(page.get_by_role("button", name="As large as the others cam0")).to_be_visible()
    assert page.locator("[data-camera=cam0]").bounding_box()["width"] > 1.3 * before
    page.keyboard.press("p")
    expect(page.get_by_role("button", name="Enlarge cam0")).to_be_visible()
    border = page.get_by_role("separator", name="Width of the pictures")
    border.focus()
    page.keyboard.press("ArrowLeft")
    page.keyboard.press("ArrowLeft")
    assert page.locator("[data-camera=cam0]").bounding_box()["width"] < before - 20


@pytest.mark.parametrize(("count", "size", "scheme"), [(2, (1280, 720), "dark"), (8, (1920, 1080), "light")])
def test_all_panes_show_the_same_frame(recording, open_page, picture_of, screenshots, count, size, scheme):
    from playwright.sync_api import expect

    names = [f"cam{k}" for k in range(count)]
    page, pictures = open_cameras(open_page, picture_of, recording, names, width=size[0], height=size[1], scheme=scheme)
    for _ in range(2):
        page.keyboard.press("f")
    expect(page.get_by_label("Frame", exact=True)).to_have_value("2")
    for picture in pictures.values():
        picture.wait()
    labels = page.locator("[data-picture]").evaluate_all("(all) => all.map((one) => one.ariaLabel)")
    assert all("frame 2" in label for label in labels) and len(labels) == count
    boxes = [picture.element.bounding_box() for picture in pictures.values()]
    assert min(box["width"] for box in boxes) > 200 and min(box["height"] for box in boxes) > 150
    screenshots.take(page, f"cameras-{count}-{scheme}")


def test_each_picture_takes_gestures_by_itself_once_it_is_there(studio, recording, open_page, picture_of, screenshots):
    from playwright.sync_api import expect

    first, second = (camera["id"] for camera in recording["cameras"][:2])
    page = open_page()
    slow = HeldBack(page, re.compile(f"/cameras/{second}/frames/[1-9]/color"))
    page.goto(f"/recordings/{recording['id']}/annotate?camera={first}&cameras={first},{second}")
    here, late = picture_of(page, 0), picture_of(page, 1)
    here.wait()
    late.wait()
    page.keyboard.press("f")
    here.wait()
    late.click(150, 100)
    note = page.locator(f"[data-camera={second}]").get_by_text("Waiting for the picture of frame 1")
    expect(note).to_be_visible()
    screenshots.take(page, "stale-pane")
    here.click(120, 90)
    here.wait_until_saved()
    assert find_points(studio, recording, second, frame=1) is None
    slow.release()
    late.wait()
    expect(note).to_be_hidden()
    late.click(160, 110)
    late.wait_until_saved()
    assert [round(value) for value in find_points(studio, recording, first, frame=1)[0]] == [120, 90, 2]
    marked = [[round(x), round(y)] for x, y, v in find_points(studio, recording, second, frame=1) if v]
    assert marked == [[160, 110]], "the click on the picture of frame 0 left nothing"


@pytest.mark.slow
def test_a_track_in_all_cameras_shows_every_picture_and_how_well_each_camera_agrees(
    studio, recording, open_page, screenshots
):
    from playwright.sync_api import expect

    names = [camera["id"] for camera in recording["cameras"]]
    job = studio.send("POST", "/jobs", json={"sequence_id": recording["id"], "params": {"calibrate": False}}).json()
    deadline = time.monotonic() + 150
    while job["state"] in ("queued", "running") and time.monotonic() < deadline:
        time.sleep(0.1)
        job = studio.get(f"/jobs/{job['id']}")
    assert job["state"] == "succeeded", job["error"]
    views = studio.get(f"/tracks/{job['track_id']}/frames")["views"]
    assert [view["camera"] for view in views] == names
    summary = studio.get(f"/tracks/{job['track_id']}")["summary"]["views"]

    page = open_page(width=1920, height=1080)
    page.goto(f"/tracks/{job['track_id']}")
    table = page.get_by_role("table", name="Cameras")
    expect(table.get_by_role("row")).to_have_count(1 + CAMERAS)
    for name in names:
        row = table.get_by_role("row", name=re.compile(f"^{name} "))
        own = summary[name]
        expect(row.get_by_role("cell")).to_have_text(
            [name, f"{own['fit_px']:.1f}", f"{own['left_out_px']:.1f}", f"{own['weight']:.2f}"]
        )
    table.get_by_role("button", name="cam3").click()
    expect(page.get_by_role("combobox", name="Camera", exact=True)).to_have_value("cam3")
    expect(page.get_by_label("How well cam3 agrees, by frame")).to_be_visible()

    page.get_by_role("combobox", name="Camera", exact=True).click()
    page.get_by_role("option", name="All cameras").click()
    for name in names:
        expect(page.get_by_label(f"Image of {name} of frame 0 with the fitted hand")).to_be_visible()
    assert not find_faults(page)
    screenshots.take(page, "track-all-cameras-dark-1920")
    page.reload()
    page.get_by_role("button", name="cam5", exact=True).first.click()
    expect(page.get_by_role("combobox", name="Camera", exact=True)).to_have_value("cam5")
    expect(page.get_by_label("Image of frame 0 with the fitted hand")).to_have_count(1)
