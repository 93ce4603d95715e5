"""Scans in a real browser: dropped, found again, looked at, cropped with one stroke, registered."""

from __future__ import annotations

import base64
import re
import zipfile
from pathlib import Path
from typing import Any

import pytest

from tests.web.hands import write_scans
from tracker.capture import measure_size
from tracker.capture.scan import load_scan, save_scan

pytestmark = [pytest.mark.browser, pytest.mark.timeout(240)]

# Files fall onto the page as they do from a file manager.
DROP = """([name, data]) => {
  const bytes = Uint8Array.from(atob(data), (letter) => letter.charCodeAt(0));
  const transfer = new DataTransfer();
  transfer.items.add(new File([bytes], name));
  for (const type of ['dragenter', 'dragover', 'drop'])
    window.dispatchEvent(new DragEvent(type, { dataTransfer: transfer, bubbles: true, cancelable: true }));
}"""


@pytest.fixture(scope="module")
def archive(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two scans with their `scans.json`."""
    return write_scans(tmp_path_factory.mktemp("scans"), 2)[0]


@pytest.fixture(scope="module")
def scans(studio: Any, archive: Path) -> list[dict[str, Any]]:
    with archive.open("rb") as file:
        answer = studio.send(
            "POST", "/scans", files={"files": (archive.name, file)}, data={"options": '{"collection": "two"}'}
        )
    return answer.json()["added"] + answer.json()["known"]


def drop(page: Any, name: str, data: bytes) -> None:
    page.evaluate(DROP, [name, base64.b64encode(data).decode()])


def stroke(page: Any, points: list[tuple[float, float]]) -> None:
    """One drag over the 3D view; points as shares of its width and height."""
    box = page.get_by_test_id("strokes").bounding_box()
    at = [(box["x"] + x * box["width"], box["y"] + y * box["height"]) for x, y in points]
    page.mouse.move(*at[0])
    page.mouse.down()
    for point in at[1:]:
        page.mouse.move(*point, steps=4)
    page.mouse.up()


def open_scan(open_page: Any, scan: dict[str, Any], **options: Any) -> Any:
    page = open_page(**options)
    page.goto(f"/scans/{scan['id']}")
    page.wait_for_function("(id) => document.querySelector('[data-hand-view]')?.dataset.drawn === id", arg=scan["id"])
    return page


def save(page: Any) -> None:
    with page.expect_response(lambda answer: answer.request.method == "PUT" and answer.ok):
        page.keyboard.press("Control+s")
    page.get_by_text("Not saved yet; kept in this tab.").wait_for(state="detached")


def share_of(page: Any) -> float:
    found = re.search(r"([\d.]+) % of", page.get_by_test_id("crop-share").inner_text())
    return float(found[1]) if found else 0.0


def test_scans_dropped_on_the_page_are_added_and_each_that_cannot_be_used_says_why(
    studio, open_page, archive, screenshots
):
    from playwright.sync_api import expect

    page = open_page()
    page.goto("/scans")
    page.get_by_role("button", name=re.compile("^Add")).first.wait_for()
    screenshots.take(page, "scans-first")
    drop(page, archive.name, archive.read_bytes())
    dialog = page.get_by_role("dialog")
    dialog.get_by_label("Collection").fill("dropped")
    add = dialog.get_by_role("button", name="Add 2 scans")
    expect(dialog.get_by_text("Confirm the guessed size, or choose the unit.")).to_be_in_viewport(ratio=0.95)
    expect(add).to_be_disabled()
    screenshots.take(page, "scans-add")
    dialog.get_by_label("The sizes are right").check()
    add.click()
    dialog.get_by_text("2 scans added.").wait_for()
    dialog.get_by_role("button", name="Done").click()
    page.goto("/scans?collection=dropped")
    row = page.get_by_role("row").filter(has_text="flat_together")
    expect(row).to_contain_text("22,000")

    drop(page, "broken.ply", b"ply\nformat ascii 1.0\nelement vertex 3\nend_header\n")
    dialog.get_by_text("None of these files is a scan.").wait_for()
    expect(dialog.get_by_role("button", name="Add 0 scans")).to_be_disabled()
    expect(dialog.get_by_role("alert")).to_contain_text("broken.ply")
    expect(dialog.get_by_role("alert")).to_contain_text("found an element 'vertex' without properties; needed a PLY")
    screenshots.take(page, "scans-refused")
    dialog.get_by_role("button", name="Cancel").click()
    assert len(studio.get("/scans?collection=dropped")["items"]) == 2


@pytest.mark.slow
def test_a_unit_is_said_beside_a_hand_before_anything_is_stored_and_corrected_afterwards(
    studio, open_page, archive, tmp_path, screenshots
):
    """A scan in a unit of its own, as real ones come: 1 unit is 28.5 mm, and inches make a hand of it too."""
    from playwright.sync_api import expect

    with zipfile.ZipFile(archive) as packed:
        name = next(name for name in packed.namelist() if name.endswith(".ply"))
        packed.extract(name, tmp_path)
    scan = load_scan(tmp_path / name)
    save_scan(scan.scaled(1 / 0.0285), tmp_path / "own_unit.ply")
    page = open_page()
    page.goto("/scans")
    page.get_by_role("button", name=re.compile("^Add")).first.wait_for()
    drop(page, "own_unit.ply", (tmp_path / "own_unit.ply").read_bytes())
    dialog = page.get_by_role("dialog")
    expect(dialog.get_by_text("Guess", exact=True)).to_be_visible()
    add = dialog.get_by_role("button", name="Add 1 scan")
    expect(add).to_be_disabled()
    dialog.get_by_label("Collection").fill("units")

    def choose(unit: str) -> None:
        dialog.get_by_role("combobox", name="Unit of the files").click()
        page.get_by_role("option", name=unit).click()

    choose("Centimetres")
    dialog.get_by_text("1 scan has a size that no hand has: correct the unit.").wait_for()
    expect(add).to_be_disabled()
    choose("Another")
    dialog.get_by_label("1 unit is, in mm").fill("28.5")
    length = 100 * float(measure_size(scan.points)[0])
    expect(dialog.get_by_test_id("scan-length")).to_contain_text(f"{length:.1f} cm")
    screenshots.take(page, "scans-unit")
    add.click()
    dialog.get_by_text("1 scan added.").wait_for()
    dialog.get_by_role("button", name="Done").click()
    [added] = studio.get("/scans?collection=units")["items"]
    assert (added["metres_per_unit"], added["is_unit_guessed"]) == (0.0285, False)

    page = open_scan(open_page, added)
    panel = page.get_by_role("region", name="Unit and size")
    panel.get_by_role("button", name="Correct the unit …").click()
    unit = panel.get_by_role("combobox", name="Unit of the files")
    assert unit.evaluate("(field) => field.clientWidth > 120"), "its words have room beside the two numbers"
    panel.get_by_label("1 unit is, in mm").fill("27")
    screenshots.take(page, "scan-unit")
    panel.get_by_role("button", name="Set the unit").click()
    expect(panel).to_contain_text("1 unit = 27 mm")
    expect(panel.get_by_role("button", name="Set the unit")).to_have_count(0)
    now = studio.get(f"/scans/{added['id']}")
    assert (now["metres_per_unit"], now["revision"]) == (0.027, 2)
    assert now["size_m"][0] == pytest.approx(added["size_m"][0] * 27 / 28.5)

    page.goto("/scans?collection=units")
    page.get_by_label("Choose own_unit").check()
    page.get_by_role("button", name="Move to the bin").click()
    page.get_by_text("1 scan moved to the bin.").wait_for()
    page.goto("/bin?kind=scan")
    page.get_by_role("button", name="Restore own_unit").wait_for()
    screenshots.take(page, "bin")
    page.get_by_role("button", name="Restore own_unit").click()
    page.get_by_text("own_unit is back.").wait_for()
    assert studio.get(f"/scans/{added['id']}")["name"] == "own_unit"

    studio.send("DELETE", f"/scans/{added['id']}").raise_for_status()
    page.goto("/bin?kind=scan")
    page.get_by_role("button", name="Delete own_unit for good").click()
    erasing = page.get_by_role("dialog", name="Delete for good?")
    expect(erasing).to_contain_text("The scan own_unit is deleted, and cannot be restored.")
    expect(erasing.get_by_role("list", name="What goes")).to_contain_text("of files")
    screenshots.take(page, "bin-delete-for-good")
    erasing.get_by_role("button", name="Keep it").click()
    expect(erasing).to_be_hidden()
    page.get_by_role("button", name="Delete own_unit for good").click()
    erasing.get_by_role("button", name="Delete for good").click()
    page.get_by_text("own_unit is deleted for good.").wait_for()
    expect(page.get_by_role("button", name="Restore own_unit")).to_have_count(0)
    assert not (studio.data_dir / "scans" / added["id"]).exists()


def test_the_list_is_narrowed_and_the_address_holds_how(scans, open_page):
    from playwright.sync_api import expect

    page = open_page()
    page.goto("/scans?collection=two")
    expect(page.get_by_role("row")).to_have_count(3)
    page.get_by_label("Filter scans by name").fill("flat")
    expect(page.get_by_role("row")).to_have_count(2)
    page.wait_for_url(re.compile("search=flat"))
    page.get_by_label("Filter scans by name").fill("nothing of that name")
    page.get_by_text("No scan matches").wait_for()


def test_one_stroke_crops_a_scan_and_can_be_taken_back_before_and_after_it_is_saved(
    studio, scans, open_page, screenshots
):
    scan = scans[0]
    page = open_scan(open_page, scan)
    page.keyboard.press("x")
    stroke(page, [(0.1, 0.8), (0.5, 0.82), (0.9, 0.8)])
    below = share_of(page)
    assert 2 < below < 50
    page.keyboard.press("f")
    assert share_of(page) == pytest.approx(100 - below, abs=0.2), "the two sides of a line are the whole scan"
    page.keyboard.press("f")
    stroke(page, [(0.5, 0.3), (0.6, 0.3), (0.6, 0.45), (0.5, 0.45), (0.5, 0.3)])
    screenshots.take(page, "scan-crop")
    assert share_of(page) > below, "a closed stroke takes more"
    page.keyboard.press("z")
    assert share_of(page) == below
    page.reload()
    page.get_by_text("Not saved yet; kept in this tab.").wait_for()
    save(page)

    kept = studio.get(f"/scans/{scan['id']}")
    assert kept["revision"] == scan["revision"] + 1
    assert 100 * kept["removed_count"] / kept["point_count"] == pytest.approx(below, abs=1)
    page.keyboard.press("z")
    page.get_by_text("Not saved yet; kept in this tab.").wait_for()
    save(page)
    assert studio.get(f"/scans/{scan['id']}")["removed_count"] == 0, "the file stayed whole"


def test_a_studio_on_this_computer_is_used_while_the_browser_says_that_there_is_no_network(studio, scans, open_page):
    page = open_scan(open_page, scans[1])
    page.evaluate("window.dispatchEvent(new Event('offline'))")
    page.keyboard.press("x")
    stroke(page, [(0.1, 0.85), (0.9, 0.85)])
    save(page)
    page.keyboard.press("z")
    save(page)
    page.keyboard.press("ArrowRight")
    page.wait_for_function(
        "(id) => document.querySelector('[data-hand-view]')?.dataset.drawn !== id", arg=scans[1]["id"]
    )


HOLD = """() => {
  const send = window.fetch;
  window.held = [];
  window.fetch = (address, init) => init?.method === 'PUT'
    ? new Promise((done, failed) => window.held.push(() => send(address, init).then(done, failed)))
    : send(address, init);
  window.release = () => { window.fetch = send; window.held[0](); };
}"""
"""Requests that change something wait in the page itself: word of one that Playwright holds back came once too late."""


@pytest.mark.parametrize("leaves", [False, True], ids=["on the same page", "after leaving and coming back"])
def test_a_stroke_that_is_taken_back_while_the_crop_is_on_its_way_is_the_next_thing_to_save(
    studio, scans, open_page, leaves
):
    scan = studio.get(f"/scans/{scans[0]['id']}")
    page = open_scan(open_page, scan)
    page.keyboard.press("x")
    stroke(page, [(0.1, 0.8), (0.5, 0.82), (0.9, 0.8)])
    below = share_of(page)
    page.evaluate(HOLD)
    save_button = page.get_by_role("button", name="Save")
    page.keyboard.press("Control+s")
    save_button.locator(".mantine-Loader-root").wait_for()
    page.wait_for_function("window.held.length === 1")
    if leaves:
        page.keyboard.press("ArrowLeft")
        page.get_by_role("heading", name=scans[1]["name"]).wait_for()
        page.go_back()
        page.get_by_text("1 stroke;").wait_for()
        page.get_by_role("heading", name=scan["name"]).wait_for()
    page.keyboard.press("z")
    if not leaves:
        page.keyboard.press("Control+s")  # one is on its way
    with page.expect_response(lambda answer: answer.request.method == "PUT" and answer.ok):
        page.evaluate("window.release()")
    page.wait_for_function(
        "([key, base]) => JSON.parse(sessionStorage.getItem(key))?.base > base",
        arg=[f"handloom/crop/00000000-0000-4000-8000-000000000001/{scan['id']}", scan["revision"]],
    )

    assert page.evaluate("window.held.length") == 1
    kept = studio.get(f"/scans/{scan['id']}")
    assert 100 * kept["removed_count"] / kept["point_count"] == pytest.approx(below, abs=1)
    assert share_of(page) == 0
    page.get_by_text("Not saved yet; kept in this tab.").wait_for()
    save(page)
    assert studio.get(f"/scans/{scan['id']}")["removed_count"] == 0


def test_a_crop_that_somebody_else_has_changed_meanwhile_is_not_overwritten(studio, scans, open_page):
    scan = studio.get(f"/scans/{scans[1]['id']}")
    page = open_scan(open_page, scan)
    page.keyboard.press("x")
    stroke(page, [(0.1, 0.85), (0.9, 0.85)])
    plane = {"kind": "plane", "normal": [1, 0, 0], "offset": 10}
    theirs = {"strokes": [plane], "drops_objects": False}
    path = f"/scans/{scan['id']}/crop"
    studio.send("PUT", path, json=theirs, headers={"If-Match": f'"{scan["revision"]}"'}).raise_for_status()
    page.keyboard.press("Control+s")
    page.get_by_text("Somebody else has cropped this scan meanwhile").wait_for()
    assert studio.get(path)["strokes"][0]["kind"] == "plane"
    with page.expect_response(lambda answer: answer.request.method == "PUT" and answer.ok):
        page.get_by_role("button", name="Save mine over it").click()
    assert [one["kind"] for one in studio.get(path)["strokes"]] == ["polygon"]


def test_registering_is_started_from_the_scan(studio, scans, open_page):
    page = open_scan(open_page, scans[0])
    page.get_by_role("button", name="Register …").click()
    dialog = page.get_by_role("dialog")
    dialog.get_by_text("1 chosen scan.").wait_for()
    dialog.get_by_role("button", name="Register", exact=True).click()
    page.wait_for_url(re.compile("/jobs/"))
    page.get_by_role("heading", name=re.compile("1 scan")).wait_for()
    job = page.url.rsplit("/", 1)[-1]
    assert studio.get(f"/jobs/{job}")["kind"] == "register"
    studio.send("POST", f"/jobs/{job}/cancel")
