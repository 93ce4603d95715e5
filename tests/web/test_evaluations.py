"""Tracks against marks whose distance is known by hand, in a real browser; and the report opened from disk."""

from __future__ import annotations

import re
import time
import uuid
from pathlib import Path

import pytest

pytestmark = [pytest.mark.browser, pytest.mark.timeout(600)]

MARKED = (0, 3, 6, 9, 12, 15)
WORST = 9
AXE = Path(__file__).resolve().parents[2] / "web" / "node_modules" / "axe-core" / "axe.min.js"
HEAVY = ("serious", "critical")


@pytest.fixture(scope="module")
def judged(studio, synthesized):
    """A recording with two tracks. The marks lie 5 px from the first one, in frame 9 9 px."""
    with synthesized.archive.open("rb") as file:
        made = studio.send("POST", "/imports", files={"files": ("opening-hand.zip", file)}).json()
    name = "Hand to be judged"
    recording = studio.send("POST", f"/imports/{made['id']}/confirm", json={"name": name}).json()
    _mark(studio, recording, 0, [[x, y, 2] for x, y in synthesized.joints], {"If-None-Match": "*"})
    usual = {"calibrate": False, "terms": "LO"}
    tracks = [_track(studio, recording, usual | {"iterations": iterations}) for iterations in (5, 2)]
    joints = studio.get(f"/tracks/{tracks[0]['id']}/joints?camera=cam0")
    for frame in MARKED:
        far = 1.8 if frame == WORST else 1.0
        points = [[x + 3 * far, y + 4 * far, 2] for x, y in joints["points"][frame][:21]]
        _mark(studio, recording, frame, points, {"If-Match": '"1"'} if frame == 0 else {"If-None-Match": "*"})
    return recording, tracks


def _mark(studio, recording, frame, points, headers) -> None:
    address = f"/sequences/{recording['id']}/annotations/cam0/{frame}/right"
    body = {"points": points, "operation_id": str(uuid.uuid4())}
    studio.send("PUT", address, json=body, headers=headers).raise_for_status()


def _track(studio, recording, params):
    body = {"kind": "track", "sequence_id": recording["id"], "params": params}
    job = studio.send("POST", "/jobs", json=body).json()
    deadline = time.monotonic() + 300
    while job["state"] in ("queued", "running") and time.monotonic() < deadline:
        time.sleep(0.1)
        job = studio.get(f"/jobs/{job['id']}")
    assert job["state"] == "succeeded", job
    return studio.get(f"/tracks/{job['track_id']}")


@pytest.mark.slow
def test_two_tracks_are_chosen_compared_and_the_address_holds_it_all(studio, judged, open_page, screenshots):
    from playwright.sync_api import expect

    recording, tracks = judged
    page = open_page()
    page.goto("/evaluations")
    expect(page.get_by_role("button", name="Tick tracks to evaluate")).to_be_disabled()
    for track in tracks:
        page.get_by_role("checkbox", name=f"{track['name']} of {recording['name']}", exact=True).check()
    screenshots.take(page, "30-evaluations-choose")
    page.get_by_role("button", name="Compare 2 tracks").click()
    expect(page).to_have_url(re.compile(f"tracks={tracks[0]['id']}(%2C|,){tracks[1]['id']}"))
    rows = page.get_by_role("table", name="Error of each track").get_by_role("row")
    first, second = rows.nth(1), rows.nth(2)
    mean = (5 * 5 + 9) / 6
    expect(first).to_contain_text(f"{mean:.2f}")
    expect(first).to_contain_text("9.00")
    expect(first).to_contain_text("100.0 %")
    expect(first).to_contain_text("the reference")
    expect(second).to_contain_text(re.compile("(better|worse|no difference seen)"))
    differing = page.get_by_role("table", name="Parameters that differ")
    expect(differing.get_by_role("row").nth(1)).to_have_text(re.compile("Iterations.*5.*2"))
    page.wait_for_timeout(300)
    screenshots.take(page, "31-evaluations")
    page.set_viewport_size({"width": 1200, "height": 720})
    table = page.get_by_role("table", name="Error of each track")
    assert table.evaluate("(table) => table.parentElement.scrollWidth - table.parentElement.clientWidth") == 0
    assert (
        table.get_by_role("columnheader").evaluate_all(
            "(cells) => cells.filter((cell) => cell.offsetHeight > 48).length"
        )
        == 0
    )
    page.set_viewport_size({"width": 1280, "height": 720})

    second.get_by_role("radio").click()
    expect(second.get_by_role("radio")).to_be_checked()
    expect(first).to_contain_text("px,")
    expect(second).to_contain_text("the reference")
    expect(page).to_have_url(re.compile(f"reference={tracks[1]['id']}"))
    page.get_by_label("Within, px").fill("7")
    expect(first).to_contain_text("83.3 %")
    page.get_by_text("Without the first frame").click()
    expect(first).to_contain_text(f"{(4 * 5 + 9) / 5:.2f}")
    page.reload()
    expect(first).to_contain_text(f"{(4 * 5 + 9) / 5:.2f}")
    expect(first).to_contain_text("80.0 %")
    page.get_by_role("radiogroup", name="Joints").get_by_text("Occluded").click()
    expect(first).to_contain_text("Nothing to compare with")
    screenshots.take(page, "32-evaluations-nothing")
    page.get_by_role("radiogroup", name="Joints").get_by_text("All joints").click()

    kept = studio.send("POST", f"/sequences/{recording['id']}/labels/snapshots", json={"name": "Before the review"})
    page.reload()
    labels = page.get_by_role("combobox", name="Labels that judge")
    expect(labels).to_have_value("Current labels")
    labels.click()
    page.get_by_role("option", name="Snapshot 1: Before the review").click()
    expect(page).to_have_url(re.compile(f"snapshots={kept.json()['id']}"))
    expect(page.get_by_role("region", name="What was judged, and by which labels")).to_contain_text("snapshot 1")
    page.reload()
    expect(labels).to_have_value("Snapshot 1: Before the review")
    labels.click()
    page.get_by_role("option", name="Current labels").click()
    expect(page).not_to_have_url(re.compile("snapshots="))


def test_what_was_accepted_from_a_track_does_not_judge_it_and_the_page_says_so(studio, judged, open_page, screenshots):
    from playwright.sync_api import expect

    recording, tracks = judged
    joints = studio.get(f"/tracks/{tracks[0]['id']}/joints?camera=cam0")["points"][1][:21]
    address = f"/sequences/{recording['id']}/annotations/cam0/1/right"
    accepted = {"kind": "track", "label": tracks[0]["name"], "track_id": tracks[0]["id"]}
    points = [[x, y, 2] for x, y in joints]
    body = {"points": points, "sources": [accepted] * 21, "operation_id": str(uuid.uuid4())}
    studio.send("PUT", address, json=body, headers={"If-None-Match": "*"}).raise_for_status()
    try:
        page = open_page()
        page.goto(f"/evaluations?tracks={tracks[0]['id']}")
        row = page.get_by_role("table", name="Error of each track").get_by_role("row").nth(1)
        expect(row).to_contain_text(f"{(5 * 5 + 9) / 6:.2f}")
        told = page.get_by_role("note", name="Joints left out")
        expect(told).to_contain_text(f"21 joints are left out: 21 accepted from {tracks[0]['name']}.")
        page.wait_for_load_state("networkidle")
        screenshots.take(page, "35-evaluations-left-out")
        told.get_by_role("button", name="Count them too").click()
        expect(page).to_have_url(re.compile("sources=all"))
        expect(row).to_contain_text(f"{(5 * 5 + 9) / 7:.2f}")
        expect(told).to_have_count(0)
        page.get_by_role("button", name="Sources: All sources").click()
        page.get_by_role("radio", name="Some kinds").click()
        expect(page).to_have_url(re.compile("sources=hand"))
        screenshots.take(page, "36-evaluations-sources")
        expect(row).to_contain_text(f"{(5 * 5 + 9) / 6:.2f}")
    finally:
        studio.send("DELETE", address, headers={"If-Match": '"1"'}).raise_for_status()


def test_a_worst_frame_is_one_click_from_the_annotator_and_from_the_3d_view(studio, judged, open_page, screenshots):
    from playwright.sync_api import expect

    recording, tracks = judged
    page = open_page()
    page.goto(f"/evaluations?tracks={tracks[0]['id']}")
    worst = page.get_by_role("region", name="Worst frames").get_by_role("article").first
    expect(worst).to_contain_text(f"frame {WORST}")
    expect(worst).to_contain_text("9.00 px")
    worst.scroll_into_view_if_needed()
    page.wait_for_function("() => document.querySelector('article img')?.naturalWidth === 384")
    screenshots.take(page, "33-evaluations-worst")
    worst.get_by_role("link", name="Annotate").click()
    expect(page).to_have_url(re.compile(rf"/recordings/{recording['id']}/annotate\?.*frame={WORST}\b"))
    assert {"camera=cam0", "hand=right"} <= set(re.split("[?&]", page.url))
    page.go_back()
    worst.get_by_role("link", name="3D").click()
    expect(page).to_have_url(re.compile(rf"/tracks/{tracks[0]['id']}\?.*frame={WORST}\b"))
    expect(page.get_by_test_id("frame")).to_have_text(f"frame {WORST}")
    page.get_by_role("link", name="Evaluate and compare").click()
    expect(page.get_by_role("table", name="Error of each track").get_by_role("row")).to_have_count(3)


def test_who_leaves_a_track_before_its_address_is_written_is_not_called_back(judged, open_page):
    """The page that is left stays drawn until the code of the next has come, and its address is written late."""
    from playwright.sync_api import expect

    _, tracks = judged
    page = open_page()
    asked = []

    def slowly(route):
        asked.append(route.request.url)
        time.sleep(0.6)
        route.continue_()

    page.route(re.compile(r"/assets/EvaluationsPage[^/]*\.js"), slowly)
    page.goto(f"/tracks/{tracks[0]['id']}")
    expect(page.get_by_test_id("frame")).to_have_text("frame 0")
    expect(page).to_have_url(re.compile("frame=0"))
    page.get_by_role("link", name="Evaluate and compare").evaluate(
        """(link) => {
          document.body.dispatchEvent(new KeyboardEvent("keydown", { key: "f", code: "KeyF", bubbles: true }));
          link.click();
        }"""
    )
    expect(page.get_by_role("table", name="Error of each track").get_by_role("row")).to_have_count(3)
    assert asked and "/evaluations?recordings=" in page.url and "frame=" not in page.url


def test_a_click_in_the_curve_offers_that_frame(judged, open_page):
    from playwright.sync_api import expect

    recording, tracks = judged
    page = open_page()
    page.goto(f"/evaluations?recordings={recording['id']}")
    figure = page.get_by_role("figure", name="Mean error by annotated frame")
    box = figure.locator(".u-over").bounding_box()
    page.mouse.click(box["x"] + WORST / 15 * box["width"], box["y"] + 0.5 * box["height"])
    curves = page.get_by_role("region", name="Curves")
    expect(curves).to_contain_text(f"Frame {WORST}:")
    expect(curves.get_by_role("link", name=f"{tracks[0]['name']}, 9.00 px")).to_be_visible()
    curves.get_by_role("link", name="Annotate").click()
    expect(page).to_have_url(re.compile(rf"/annotate\?.*frame={WORST}\b"))


def test_the_report_is_one_file_that_opens_from_disk_without_a_network(
    studio, judged, open_page, browser, screenshots, tmp_path
):
    _, tracks = judged
    page = open_page(1920, 1080, "light")
    page.goto(f"/evaluations?tracks={tracks[0]['id']},{tracks[1]['id']}")
    page.get_by_role("figure", name="Mean error by annotated frame").locator("canvas").wait_for()
    page.wait_for_function("() => document.querySelector('article img')?.naturalWidth === 384")
    screenshots.take(page, "34-evaluations-light")
    page.get_by_role("button", name="Report").click()
    with page.expect_download() as download:
        page.get_by_role("menuitem", name="Page (HTML)").click()
    path = tmp_path / "report.html"
    download.value.save_as(path)
    found = studio.get(f"/evaluations?track={tracks[0]['id']}&track={tracks[1]['id']}")
    for scheme, ground in (("dark", "rgb(23, 25, 29)"), ("light", "rgb(246, 247, 248)")):
        context = browser.new_context(offline=True, color_scheme=scheme, viewport={"width": 1280, "height": 900})
        try:
            asked: list[str] = []
            context.on("request", lambda request, asked=asked: asked.append(request.url))
            report = context.new_page()
            report.goto(path.as_uri())
            text = report.locator("body").inner_text()
            for track in found["tracks"]:
                for measure in ("mean", "std", "median", "p95", "max"):
                    assert f"{track['error'][measure]:.2f}" in text
                assert track["labels"]["sha256"] in text
            assert [url for url in asked if not url.startswith(("file:", "data:"))] == []
            widths = report.evaluate("[...document.images].map((image) => image.naturalWidth)")
            assert len(widths) == 2 * len(MARKED) and set(widths) == {384}
            assert report.evaluate("getComputedStyle(document.body).backgroundColor") == ground
            assert report.evaluate("document.documentElement.scrollWidth <= innerWidth")
            if screenshots.folder is not None:
                report.screenshot(path=screenshots.folder / f"34-report-{scheme}.png", full_page=True)
        finally:
            context.close()


def test_a_project_is_judged_as_a_whole_and_the_page_has_no_serious_fault(studio, judged, open_page):
    from playwright.sync_api import expect

    recording, tracks = judged
    project = studio.send("POST", "/projects", json={"name": f"Hands {uuid.uuid4()}"}).json()
    studio.send("PUT", f"/projects/{project['id']}/sequences/{recording['id']}").raise_for_status()
    page = open_page()
    page.goto("/evaluations")
    page.get_by_role("combobox", name="A whole project").click()
    page.get_by_role("option", name=f"{project['name']} (1)").click()
    expect(page).to_have_url(re.compile(f"project={project['id']}"))
    rows = page.get_by_role("table", name="Error of each track").get_by_role("row")
    expect(rows).to_have_count(1 + len(tracks))
    page.wait_for_function("() => document.querySelector('article img')?.naturalWidth === 384")
    page.evaluate(AXE.read_text())
    found = page.evaluate("async () => (await axe.run('#main', {resultTypes: ['violations']})).violations")
    serious = [(one["id"], [node["html"][:200] for node in one["nodes"]]) for one in found if one["impact"] in HEAVY]
    assert serious == []
