"""The demo as somebody new meets it, in real Chromium: annotate, track, evaluate, register, curate, train; no error."""

from __future__ import annotations

import os
import re
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest

from tests.web.conftest import ROOT, Picture, Studio
from tests.web.test_curation import wait_for_hand, wait_until_saved

pytestmark = [pytest.mark.browser, pytest.mark.slow, pytest.mark.timeout(1800)]


@pytest.fixture(scope="module")
def demo(chromium: str, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Studio]:
    """`handloom demo` on an empty data folder; HANDLOOM_DEMO names one that is being served already."""
    if served := os.environ.get("HANDLOOM_DEMO"):
        yield Studio(served, Path(), Path())
        return
    folder = tmp_path_factory.mktemp("demo")
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    with (folder / "demo.log").open("w") as output:
        process = subprocess.Popen(
            [sys.executable, "-m", "server.cli", "demo", "--port", str(port)],
            cwd=ROOT,
            env=os.environ | {"HANDLOOM_DATA_DIR": str(folder / "data")},
            stdout=output,
            stderr=subprocess.STDOUT,
        )
    try:
        yield Studio(f"http://127.0.0.1:{port}", folder / "data", folder / "demo.log")
    finally:
        process.terminate()
        process.wait(30)


def wait_for_job(studio: Studio, kind: str, seconds: float = 900) -> dict[str, Any]:
    """The newest job of a kind, when it has succeeded."""
    deadline = time.monotonic() + seconds
    while time.monotonic() < deadline:
        try:
            [job] = studio.get(f"/jobs?kind={kind}&limit=1")["items"]
        except (httpx.HTTPError, ValueError):  # the samples are still being made
            time.sleep(1.0)
            continue
        assert job["state"] not in ("failed", "cancelled"), job["error"]
        if job["state"] == "succeeded":
            return job
        time.sleep(0.5)
    raise AssertionError(f"no {kind} job ended in {seconds:g} s")


def annotate(demo: Studio, page: Any, recording: str, frame: int) -> None:
    """A joint by a click, the others as the track suggests them; then nothing looks wrong."""
    from playwright.sync_api import expect

    page.goto(f"/recordings/{recording}/annotate?camera=cam0&frame={frame}&hand=right")
    picture = Picture(page)
    picture.wait()
    expect(page.get_by_test_id("suggested-by")).to_contain_text("Suggested by Track 1")
    points = demo.get(f"/sequences/{recording}/annotations")["items"][0]["points"]
    picture.click(*points[0][:2])  # the arm stands still
    page.keyboard.press("Shift+A")
    expect(page.get_by_role("tab", name="right 21/21")).to_be_visible()
    picture.wait_until_saved()
    stored = [one["frame"] for one in demo.get(f"/sequences/{recording}/annotations")["items"]]
    assert stored == sorted([0, 15, 30, 45, frame]), stored
    page.goto(f"/recordings/{recording}/check")
    expect(page.get_by_role("heading", name="No check found a wrong label")).to_be_visible()


def track_with(demo: Studio, page: Any, recording: str, model: str) -> None:
    """Choose a model in the form that tracks; it tells the job by its name."""
    from playwright.sync_api import expect

    page.goto(f"/recordings/{recording}")
    page.get_by_role("button", name="Track …").first.click()
    dialog = page.get_by_role("dialog")
    dialog.get_by_label("Last frame").fill("9")
    dialog.get_by_role("combobox", name="Hand model").click()
    page.get_by_role("option", name=model, exact=True).click()
    dialog.get_by_role("button", name="Start tracking").click()
    page.wait_for_url(re.compile(r"/jobs/[0-9a-f-]{36}$"))
    expect(page.get_by_role("region", name="Parameters").get_by_role("code").filter(has_text=model)).to_be_visible()
    page.get_by_role("link", name="Open the track").click(timeout=300_000)
    page.wait_for_url(re.compile("/tracks/"))
    expect(page.get_by_role("region", name="3D view")).to_be_visible()


def test_a_new_user_goes_the_whole_way(demo: Studio, browser: Any, screenshots: Any) -> None:
    from playwright.sync_api import expect

    tracked = wait_for_job(demo, "track")
    context = browser.new_context(viewport={"width": 1280, "height": 720}, base_url=demo.url, locale="en-GB")
    context.set_default_timeout(60_000)
    page = context.new_page()
    errors: list[str] = []
    page.on("pageerror", lambda error: None if "unsafe-eval" in str(error) else errors.append(str(error)))
    page.on("response", lambda one: errors.append(f"{one.status} {one.url}") if one.status >= 400 else None)

    # The track, and its error where the job shows it.
    page.goto(f"/jobs/{tracked['id']}")
    error = demo.get(f"/tracks/{tracked['track_id']}/evaluation")["joint_error_px"]["mean"]
    result = page.get_by_role("region", name="Result")
    expect(result.get_by_text(f"{error:.2f}", exact=True)).to_be_visible()
    screenshots.take(page, "demo-1-track-job")
    page.goto(f"/evaluations?recordings={tracked['sequence_id']}")
    expect(page.get_by_text("Sample: open and close").first).to_be_visible()
    screenshots.take(page, "demo-2-evaluation")
    annotate(demo, page, tracked["sequence_id"], 5)
    page.goto(f"/evaluations?recordings={tracked['sequence_id']}")
    expect(page.get_by_text("20 joints are left out: 20 accepted from Track 1")).to_be_visible()

    # Scans are registered already; every one is judged by a key.
    wait_for_job(demo, "register")
    page.goto("/curate?collection=Sample%20scans")
    queue = demo.get("/registrations?collection=Sample%20scans&queue=undecided&order=likely_failures&limit=100")[
        "items"
    ]
    assert sum(one["verdict"] == "good" for one in queue) >= 24, [one["verdict"] for one in queue]
    screenshots.take(page, "demo-3-curate")
    for registration in queue:
        wait_for_hand(page, registration["id"])
        page.keyboard.press("a")
    wait_until_saved(page)

    # Train, with one person kept to judge on.
    page.goto("/models")
    page.get_by_role("button", name="Train …").click()
    dialog = page.get_by_role("dialog")
    dialog.get_by_label("Subjects to leave out").fill(queue[0]["scan"]["subject"])
    page.keyboard.press("Enter")
    expect(dialog.get_by_role("button", name="Train", exact=True)).to_be_enabled()
    screenshots.take(page, "demo-4-train")
    dialog.get_by_role("button", name="Train", exact=True).click()
    page.wait_for_url(re.compile(r"/jobs/[0-9a-f-]{36}$"))
    trained = wait_for_job(demo, "train")
    expect(page.get_by_text("done", exact=True).first).to_be_visible()
    log = page.get_by_label("Log of the job")
    expect(log).to_contain_text("is evaluated on")  # the last line, which the page may draw after the state
    assert "Traceback" not in log.inner_text()
    page.get_by_role("link", name="Open the model").click()
    page.wait_for_url(re.compile(f"/models/{trained['hand_model_id']}$"))
    expect(page.get_by_role("region", name="People kept for testing")).to_be_visible()
    screenshots.take(page, "demo-5-model")
    track_with(demo, page, tracked["sequence_id"], "Hand model")
    screenshots.take(page, "demo-6-track-with-it")
    context.close()
    assert not errors, errors
