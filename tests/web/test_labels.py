"""Labels in the browser: kept, compared, restored, taken out, and brought in by dropping a file on the page."""

from __future__ import annotations

import json
import re
import uuid
from pathlib import Path
from typing import Any

import pytest

from tests.web.conftest import OpenPage, Screenshots, Studio, Synthesized

pytestmark = pytest.mark.browser


def mark(
    studio: Studio, recording: dict[str, Any], frame: int, joints: list[tuple[float, float]], shift: float
) -> None:
    place = f"/sequences/{recording['id']}/annotations/{recording['cameras'][0]['id']}/{frame}/right"
    points = [[x + shift, y, 2] for x, y in joints]
    now = studio.send("GET", place)
    headers = {"If-Match": now.headers["ETag"]} if now.is_success else {"If-None-Match": "*"}
    body = {"points": points, "operation_id": str(uuid.uuid4())}
    studio.send("PUT", place, json=body, headers=headers).raise_for_status()


@pytest.mark.slow
def test_labels_are_kept_compared_restored_exported_and_imported(
    studio: Studio,
    recording: dict[str, Any],
    synthesized: Synthesized,
    open_page: OpenPage,
    screenshots: Screenshots,
    tmp_path: Path,
) -> None:
    from playwright.sync_api import expect

    for frame in range(4):
        mark(studio, recording, frame, synthesized.joints, 0.0)
    page = open_page()
    page.goto(f"/recordings/{recording['id']}")
    page.get_by_role("link", name="Snapshots, export, import").click()
    expect(page.get_by_text("No snapshot yet")).to_be_visible()
    screenshots.take(page, "labels-first")

    page.get_by_label("Name of the snapshot").fill("Before the review")
    page.get_by_role("button", name="Keep a snapshot").click()
    row = page.locator("[data-snapshot='1']")
    expect(row).to_contain_text("Before the review")
    (made,) = studio.get(f"/sequences/{recording['id']}/labels/snapshots")["items"]
    expect(row).to_contain_text(made["content_hash"][:12])
    page.get_by_role("button", name="Keep a snapshot").click()
    expect(page.get_by_text("Nothing has changed: version 1")).to_be_visible()

    mark(studio, recording, 1, synthesized.joints, 3.0)
    mark(studio, recording, 5, synthesized.joints, 0.0)
    row.get_by_role("button", name="Compare").click()
    comparison = page.get_by_role("region", name="Comparison")
    expect(comparison.get_by_text("21 moved")).to_be_visible()
    expect(comparison.get_by_text("21 joints added")).to_be_visible()
    assert f"compare={made['id']}" in page.url
    screenshots.take(page, "labels-compare")

    cut = page.get_by_role("link", name="coco_keypoints").locator(".mantine-Button-label")
    room = cut.evaluate("(label) => label.clientHeight / parseFloat(getComputedStyle(label).fontSize)")
    assert room > 1.3, "underscores and tails of letters are seen"
    with page.expect_download() as export:
        page.get_by_role("link", name="coco_keypoints").click()
    labels = Path(export.value.path()).read_text()
    assert len(json.loads(labels)["annotations"]) == 5
    page.get_by_role("combobox", name="Format").click()
    page.get_by_role("option", name="DeepLabCut (CSV)").click()
    expect(page.get_by_label("What is lost")).to_contain_text("occluded joints become visible ones")

    row.get_by_role("button", name="More of version 1").click()
    page.get_by_role("menuitem", name="Verify its hash").click()
    expect(page.get_by_text("Version 1 is intact")).to_be_visible()
    row.get_by_role("button", name="More of version 1").click()
    page.get_by_role("menuitem", name="Restore (can be undone)").click()
    expect(page.get_by_text("Version 1 is back: 1 hand written, 1 taken away.")).to_be_visible()
    expect(comparison.get_by_text("Nothing: the two hold the same labels.")).to_be_visible()
    page.get_by_role("button", name="Undo").click()
    expect(comparison.get_by_text("21 moved")).to_be_visible()

    moved = json.loads(labels)
    moved["annotations"][0]["keypoints"][0] += 7.0
    path = tmp_path / "theirs.json"
    path.write_text(json.dumps(moved))
    page.get_by_test_id("choose-labels").set_input_files(path)
    report = page.get_by_test_id("label-report")
    expect(report).to_contain_text("1 labelled otherwise")
    expect(report).to_contain_text("4 already labelled the same")
    expect(report.get_by_role("button", name="Nothing to import")).to_be_disabled()
    report.get_by_text("Replace by the file's").click()
    screenshots.take(page, "labels-import")
    report.get_by_role("button", name="Import 1 hand").click()
    expect(page.get_by_text("0 hands added, 1 replaced.")).to_be_visible()
    camera = recording["cameras"][0]["id"]
    stored = studio.get(f"/sequences/{recording['id']}/annotations/{camera}/0/right")
    assert stored["points"][0][0] == moved["annotations"][0]["keypoints"][0]
    with page.expect_response(re.compile("/restore$")):
        page.get_by_role("button", name="Undo").last.click()
    expect(page.get_by_text("Undone: the labels are as they were before.").last).to_be_visible()
    restored = studio.get(f"/sequences/{recording['id']}/annotations/{camera}/0/right")
    assert restored["points"][0][0] == synthesized.joints[0][0]


def test_a_file_dropped_on_the_page_is_looked_at_there_and_refused_in_words(
    recording: dict[str, Any], open_page: OpenPage, screenshots: Screenshots
) -> None:
    from playwright.sync_api import expect

    page = open_page(1920, 1080, "light")
    page.goto(f"/recordings/{recording['id']}/labels")
    expect(page.get_by_text("Drop labels on this page")).to_be_visible()
    drop = """() => {
        const transfer = new DataTransfer();
        transfer.items.add(new File(["scorer,a\\nbodyparts,wrist\\ncoords,likelihood\\n"], "net.csv"));
        for (const type of ["dragenter", "dragover", "drop"])
            document.body.dispatchEvent(new DragEvent(type, {dataTransfer: transfer, bubbles: true, cancelable: true}));
    }"""
    page.evaluate(drop)
    alert = page.get_by_role("region", name="Import").get_by_role("alert")
    expect(alert).to_contain_text("predictions of a network, not labels")
    expect(alert).to_contain_text("Nothing was stored.")
    assert page.url.endswith("/labels")
    screenshots.take(page, "labels-refused-light")
