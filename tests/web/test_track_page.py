"""Presets, the layers of the 3D view and the energy of every iteration, in a real browser."""

from __future__ import annotations

import re
import time

import cv2
import numpy as np
import pytest

from tests.web.conftest import HeldBack

SEEN = 2e-4
"""Share of the 3D view's pixels from which a colour counts as seen."""

RED, CYAN = (250, 82, 82), (34, 211, 238)
"""Of the thumb, and of the term model to data."""

pytestmark = [pytest.mark.browser, pytest.mark.timeout(600)]


@pytest.fixture(scope="module")
def recorded(studio, synthesized):
    """The recording with the annotation of its first frame, stored through the API."""
    with synthesized.archive.open("rb") as file:
        made = studio.send("POST", "/imports", files={"files": ("opening-hand.zip", file)}).json()
    recording = studio.send("POST", f"/imports/{made['id']}/confirm", json={"name": "Hand for presets"}).json()
    body = {
        "points": [[x, y, 2] for x, y in synthesized.joints],
        "operation_id": "6a1c1f0e-3a3b-4f0a-9d55-6f1f3b6f0a12",
    }
    address = f"/sequences/{recording['id']}/annotations/cam0/0/right"
    studio.send("PUT", address, json=body, headers={"If-None-Match": "*"}).raise_for_status()
    return recording


@pytest.fixture(scope="module")
def track(studio, recorded):
    """A track with all terms."""
    plausible = next(one for one in studio.get("/jobs/form")["presets"] if one["name"] == "plausible")
    params = plausible["values"] | {"calibrate": False, "last_frame": 12}
    body = {"kind": "track", "sequence_id": recorded["id"], "params": params}
    job = studio.send("POST", "/jobs", json=body).json()
    deadline = time.monotonic() + 300
    while job["state"] in ("queued", "running") and time.monotonic() < deadline:
        time.sleep(0.1)
        job = studio.get(f"/jobs/{job['id']}")
    assert job["state"] == "succeeded", job
    return studio.get(f"/tracks/{job['track_id']}")


def test_a_preset_fills_the_form_a_changed_field_is_custom_and_every_option_is_there(
    studio, recorded, open_page, screenshots
):
    from playwright.sync_api import expect

    form = studio.get("/jobs/form")
    page = open_page()
    page.goto(f"/recordings/{recorded['id']}")
    page.get_by_role("button", name="Track …").first.click()
    dialog = page.get_by_role("dialog")
    iterations = dialog.get_by_label("Iterations", exact=True)
    preset = dialog.get_by_role("status")
    expect(preset).to_have_text("Balanced")
    for one in form["presets"]:
        dialog.get_by_role("radio", name=one["label"]).click()
        expect(preset).to_have_text(one["label"])
        expect(iterations).to_have_value(str(one["values"]["iterations"]))
        expect(dialog.get_by_role("combobox", name="Terms")).to_have_value(
            re.compile(re.escape(one["values"]["terms"]) + " · ")
        )
        expect(dialog.get_by_text(one["help"])).to_be_visible()
    dialog.get_by_label("Last frame").fill("3")
    expect(preset).to_have_text(form["presets"][-1]["label"])
    iterations.fill("7")
    expect(preset).to_contain_text("Custom")
    page.mouse.move(0, 0)
    screenshots.take(page, "14-presets")
    dialog.get_by_role("button", name="All parameters").click()
    for field in form["fields"]:
        expect(dialog.get_by_label(field["label"], exact=True).first).to_be_visible()
    dialog.get_by_role("radio", name="Fast").click()
    dialog.get_by_label("Threads").fill("2")
    expect(preset).to_have_text("Fast")
    dialog.get_by_role("button", name="Start tracking").click()
    page.wait_for_url(re.compile(r"/jobs/[0-9a-f-]{36}$"))
    job = studio.get(f"/jobs/{page.url.rsplit('/', 1)[1]}")
    assert (job["params"]["terms"], job["params"]["iterations"]) == ("LO", 5)
    assert (job["params"]["last_frame"], job["params"]["threads"]) == (3, 2)


@pytest.mark.slow
def test_every_layer_is_switched_counted_and_explained(studio, track, open_page, screenshots):
    from playwright.sync_api import expect

    page = open_page()
    page.goto(f"/tracks/{track['id']}?frame=2&layers=mesh")
    canvas = page.frame_locator("iframe").locator("canvas").first
    canvas.wait_for(timeout=60_000)
    bar = page.get_by_role("group", name="Layers of the 3D view")
    card = page.get_by_role("complementary", name="What is seen in this frame")
    expect(card).to_have_count(0)
    _wait_for_color(canvas, (255, 146, 43))
    assert max(_share_of_color(canvas, RED), _share_of_color(canvas, CYAN)) < SEEN, "a bare hand has neither"

    bar.get_by_label("Detections").check()
    expect(card).to_contain_text("confidence")
    expect(card).to_contain_text("right thumb")
    count = int(re.search(r"Detections ?(\d+)", bar.inner_text())[1])
    assert count == card.get_by_text("confidence").count() >= 3
    assert _wait_for_color(canvas, RED) > SEEN, "the thumb's detection is drawn in the thumb's red"
    screenshots.take(page, "15-detections")

    bar.get_by_label("Contacts").check()
    expect(card).to_contain_text("There is nothing to hold")
    bar.get_by_label("Collisions").check()
    expect(card.get_by_role("heading", name="Collisions")).to_be_visible()
    bar.get_by_label("Distances").check()
    expect(card.get_by_role("img", name=re.compile("blue is 0"))).to_be_visible()
    expect(card).to_contain_text("median")
    screenshots.take(page, "16-evidence")
    for layer in ("Detections", "Contacts", "Collisions", "Distances"):
        bar.get_by_label(layer).uncheck()

    bar.get_by_label("Correspondences").check()
    term = card.get_by_label("Correspondences of model to data")
    expect(term).to_be_checked()
    for other in card.get_by_role("checkbox").all():
        other.uncheck()
    expect(term).not_to_be_checked()
    expect(card.get_by_role("checkbox").first).to_be_visible()
    term.check()
    assert _wait_for_color(canvas, CYAN) > SEEN, "only that term's lines, in its colour"
    expect(page).to_have_url(re.compile("layers=mesh%2Ccorrespondences"))
    for size in ((1280, 720), (1920, 1080)):
        page.set_viewport_size({"width": size[0], "height": size[1]})
        is_cut = "(bar) => bar.scrollWidth > bar.clientWidth"
        for layer in bar.get_by_role("checkbox").all():
            layer.check()
        expect(card).to_contain_text("Distance to the data")
        assert not bar.evaluate(is_cut), f"a layer's name is cut off at {size}"


@pytest.mark.slow
def test_the_energy_of_a_frame_is_drawn_by_iteration_and_a_click_goes_to_another_frame(
    studio, track, open_page, screenshots
):
    from playwright.sync_api import expect

    page = open_page()
    page.goto(f"/tracks/{track['id']}?frame=3&tab=energy")
    by_frame = page.get_by_role("figure", name="Energy of each term by frame")
    expect(by_frame).to_be_visible()
    expect(page.get_by_role("figure", name="by iteration of frame 3")).to_be_visible()
    page.wait_for_timeout(500)
    screenshots.take(page, "17-energy")
    box = by_frame.locator(".u-over").bounding_box()
    page.mouse.click(box["x"] + 0.8 * box["width"], box["y"] + 0.5 * box["height"])
    expect(page).not_to_have_url(re.compile(r"frame=3\b"))
    frame = int(re.search(r"frame=(\d+)", page.url)[1])
    assert abs(frame - 0.8 * (track["frame_count"] - 1)) <= 1
    figure = page.get_by_role("figure", name=f"by iteration of frame {frame}")
    expect(figure).to_be_visible()
    logarithmic = _labels_ink(figure)
    page.get_by_role("switch", name="Logarithmic").click()
    page.wait_for_timeout(400)
    assert not np.array_equal(_labels_ink(figure), logarithmic), "another scale is another picture"


@pytest.mark.slow
def test_keys_go_on_working_after_a_layer_is_ticked_and_after_a_click_into_the_3d_view(studio, track, open_page):
    from playwright.sync_api import expect

    page = open_page()
    page.goto(f"/tracks/{track['id']}?frame=3&layers=mesh")
    frame = page.get_by_test_id("frame")
    bar = page.get_by_role("group", name="Layers of the 3D view")
    inner = page.frame_locator("iframe").locator("canvas[data-engine]")
    inner.wait_for(timeout=60_000)
    for press, then in (("f", 4), ("Right", 5), ("d", 4), ("Home", 0), ("v", 10)):
        bar.get_by_label("Cloud").click()
        page.keyboard.press(press.replace("Right", "ArrowRight"))
        expect(frame).to_have_text(f"frame {then}")
    # Space goes on ticking the box that has the focus, and plays nothing.
    was = bar.get_by_label("Cloud").is_checked()
    page.keyboard.press("Space")
    expect(bar.get_by_label("Cloud")).to_be_checked(checked=not was)
    mesh = page.get_by_role("checkbox", name="Mesh", exact=True).last
    mesh.click()
    page.keyboard.press("Space")
    expect(mesh).to_be_checked()
    expect(page.get_by_role("button", name="Play")).to_be_visible()
    page.get_by_role("button", name="Next frame", exact=True).click()
    page.keyboard.press("ArrowRight")
    expect(frame).to_have_text("frame 12")

    inner.click()
    expect(page.locator("iframe")).to_be_focused()
    for press, then in (("d", 11), ("ArrowRight", 12), ("Home", 0)):
        page.keyboard.press(press)
        expect(frame).to_have_text(f"frame {then}")
    page.keyboard.press("?")
    expect(page.get_by_role("dialog")).to_contain_text("Next annotated frame")


def test_a_track_from_before_iterations_were_kept_says_so(studio, track, open_page):
    from playwright.sync_api import expect

    path = studio.data_dir / "tracks" / track["id"] / "frames.npz"
    whole = path.read_bytes()
    with np.load(path) as arrays:
        old = {name: arrays[name] for name in arrays.files if name != "iteration_costs"}
    np.savez(path, **old)
    try:
        page = open_page()
        page.goto(f"/tracks/{track['id']}?frame=3&tab=energy")
        expect(page.get_by_text("made before the energy of every iteration was kept")).to_be_visible()
        expect(page.get_by_role("figure", name="Energy of each term by frame")).to_be_visible()
    finally:
        path.write_bytes(whole)


@pytest.mark.slow
def test_a_track_can_be_had_in_all_four_forms(studio, track, open_page):
    from playwright.sync_api import expect

    page = open_page()
    page.goto(f"/tracks/{track['id']}")
    page.get_by_role("button", name="More").click()
    for label, suffix in (
        ("Arrays (npz)", ".npz"),
        ("Table of joints (CSV)", ".csv"),
        ("Animation (glTF)", ".glb"),
        ("MANO-style parameters (npz)", ".npz"),
    ):
        item = page.get_by_role("menuitem", name=label)
        expect(item).to_be_visible()
        with page.expect_download() as download:
            item.click()
        assert download.value.suggested_filename.endswith(suffix)
        assert download.value.path().stat().st_size > 500
        page.get_by_role("button", name="More").click()


def _labels_ink(figure) -> np.ndarray:
    return np.frombuffer(figure.screenshot(), np.uint8)


def _wait_for_color(canvas, rgb: tuple[int, int, int], seconds: float = 60) -> float:
    """Share of the viewer's pixels in a strong colour, once it is worth mentioning."""
    deadline = time.monotonic() + seconds
    share = 0.0
    while share <= SEEN and time.monotonic() < deadline:
        time.sleep(0.5)
        share = _share_of_color(canvas, rgb)
    return share


def _share_of_color(canvas, rgb: tuple[int, int, int]) -> float:
    wanted = cv2.cvtColor(np.array([[rgb[::-1]]], np.uint8), cv2.COLOR_BGR2HSV)[0, 0]
    image = cv2.imdecode(np.frombuffer(canvas.screenshot(), np.uint8), cv2.IMREAD_COLOR)
    assert image is not None
    hue, saturation, value = (plane.astype(int) for plane in cv2.split(cv2.cvtColor(image, cv2.COLOR_BGR2HSV)))
    off = np.abs(hue - int(wanted[0]))
    return float(((np.minimum(off, 180 - off) <= 3) & (saturation > 110) & (value > 150)).mean())


@pytest.mark.slow
def test_an_image_that_is_still_of_another_frame_says_so_and_carries_its_own_skeleton(
    recorded, track, open_page, picture_of, screenshots
):
    from playwright.sync_api import expect

    page = open_page()
    slow = HeldBack(page, re.compile(r"/frames/(9|1\d)/color\.jpg"))
    page.goto(f"/tracks/{track['id']}?frame=0")
    picture = picture_of(page)
    picture.wait()
    page.get_by_label("Mesh", exact=True).last.uncheck()

    def skeleton():
        return page.evaluate("document.querySelectorAll('[data-picture] canvas')[1].toDataURL()")

    page.wait_for_load_state("networkidle")
    before = skeleton()
    picture.element.focus()
    page.keyboard.press("v")
    note = page.get_by_text("Waiting for the picture of frame 10")
    expect(note).to_be_visible()
    assert picture.element.get_attribute("data-drawn") == "0"
    screenshots.take(page, "track-stale")
    assert skeleton() == before, "the skeleton is that of the image below it"
    slow.release()
    picture.wait()
    expect(note).to_be_hidden()
    assert skeleton() != before
