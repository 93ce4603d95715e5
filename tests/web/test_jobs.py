"""Jobs in real Chromium: many started at once, watched, stopped, and two of them compared."""

from __future__ import annotations

import re
from typing import Any

import pytest

pytestmark = [pytest.mark.browser, pytest.mark.timeout(300)]


@pytest.fixture
def recordings(studio: Any, synthesized: Any) -> list[dict[str, Any]]:
    """Three of them; the names tell them from those of other tests."""
    stored = []
    for name in ("Batch one", "Batch two", "Batch three"):
        with synthesized.archive.open("rb") as file:
            made = studio.send("POST", "/imports", files={"files": ("opening-hand.zip", file)})
        made.raise_for_status()
        stored.append(studio.send("POST", f"/imports/{made.json()['id']}/confirm", json={"name": name}).json())
    return stored


@pytest.mark.slow
def test_a_batch_is_started_watched_stopped_and_run_again_and_two_runs_are_compared(
    studio: Any, recordings: list[dict[str, Any]], open_page: Any, screenshots: Any
) -> None:
    from playwright.sync_api import expect

    project = studio.send("POST", "/projects", json={"name": "Both ends"})
    project.raise_for_status()
    for member in (recordings[0], recordings[2]):
        studio.send("PUT", f"/projects/{project.json()['id']}/sequences/{member['id']}").raise_for_status()
    page = open_page()
    page.goto("/jobs")
    expect(page.get_by_role("heading", name="Jobs", exact=True)).to_be_visible()
    expect(
        page.get_by_role("region", name="Workers").get_by_text(re.compile("waits for a job|at work")).first
    ).to_be_visible()

    # One form for all whose name says so.
    page.get_by_role("button", name="Track several …").click()
    page.get_by_role("combobox", name="Choose a whole project").click()
    page.get_by_role("option", name="Both ends").click()
    expect(page.get_by_role("button", name="Track 2 recordings")).to_be_visible()
    page.get_by_role("textbox", name="Filter recordings by name").fill("batch")
    page.get_by_label("All that are shown").check()
    expect(page.get_by_role("radio", name="Fast")).to_be_visible()
    page.get_by_role("radio", name="Fast").check()
    screenshots.take(page, "jobs-batch-form")
    page.get_by_role("button", name="Track 3 recordings").click()
    page.wait_for_url(re.compile(r"batch=[0-9a-f-]{36}"))

    # Seen as they go: the batch, its jobs, who works.
    expect(page.get_by_role("dialog")).to_be_hidden()
    batch_id = page.url.split("batch=")[1][:36]
    batches = page.get_by_role("region", name="Batches")
    expect(batches.get_by_text("3 recordings").first).to_be_visible()
    jobs = page.get_by_role("region", name="All jobs")
    for name in ("Batch one", "Batch two", "Batch three"):
        expect(jobs.get_by_text(f"Track {name}")).to_be_visible()
    expect(page.get_by_role("region", name="Workers").get_by_text("at work").first).to_be_visible()
    screenshots.take(page, "jobs-running")

    # One ends by itself, the rest is stopped from the page.
    _wait_for(studio, page, batch_id, lambda states: states["succeeded"] >= 1)
    cancel = batches.get_by_role("button", name="Cancel the batch")
    if cancel.is_visible():
        cancel.click()
    _wait_for(studio, page, batch_id, lambda states: states["queued"] + states["running"] == 0)
    states = studio.get(f"/jobs/batches/{batch_id}")["states"]
    assert states["succeeded"] + states["cancelled"] == 3
    if states["cancelled"]:
        expect(jobs.get_by_text("cancelled").first).to_be_visible()

    # A second run of one with other parameters, and the two side by side.
    done = next(job for job in studio.get(f"/jobs?batch_id={batch_id}")["items"] if job["state"] == "succeeded")
    body = {"sequence_id": done["sequence_id"], "params": {**done["params"], "iterations": 3, "calibrate": False}}
    second = studio.send("POST", "/jobs", json=body).json()
    page.goto(f"/jobs?recording={done['sequence_id']}")
    expect(jobs.get_by_role("checkbox")).to_have_count(2)
    expect(jobs.get_by_text("done", exact=True)).to_have_count(2, timeout=120_000)
    for box in jobs.get_by_role("checkbox").all():
        box.check()
    screenshots.take(page, "jobs-chosen")
    page.get_by_role("link", name="Compare").click()
    page.wait_for_url(re.compile(r"/jobs/compare\?a=.*&b="))
    parameters = page.get_by_role("region", name="Parameters")
    row = parameters.get_by_role("row", name=re.compile(r"^Iterations \d+ \d+ ≠ differs"))
    expect(row).to_be_visible()
    assert parameters.locator("[data-different=true]").count() == _count_different(done, second)
    expect(
        page.get_by_role("region", name="Results").get_by_role("row", name=re.compile("^Frames 16 16"))
    ).to_be_visible()
    screenshots.take(page, "jobs-compare")
    page.reload()
    expect(row).to_be_visible()


def test_the_address_holds_what_the_list_is_narrowed_to(
    studio: Any, recordings: list[dict[str, Any]], open_page: Any, screenshots: Any
) -> None:
    from playwright.sync_api import expect

    job = studio.send("POST", "/jobs", json={"sequence_id": recordings[1]["id"], "params": {}}).json()
    studio.send("POST", f"/jobs/{job['id']}/cancel").raise_for_status()
    page = open_page(1920, 1080, "light")
    page.goto("/jobs?search=two&state=cancelled")
    jobs = page.get_by_role("region", name="All jobs")
    expect(jobs.get_by_text("Track Batch two").first).to_be_visible()
    expect(jobs.get_by_text("Track Batch three")).to_have_count(0)
    screenshots.take(page, "jobs-filtered-light")
    page.get_by_label("Search jobs by recording").fill("nothing like it")
    expect(page.get_by_role("heading", name="No job matches")).to_be_visible()
    page.get_by_role("button", name="Show all").click()
    assert "search" not in page.url
    page.goto(f"/jobs/{job['id']}")
    expect(page.get_by_text("Started by")).to_be_visible()
    screenshots.take(page, "job-page-light")


def _count_different(first: dict[str, Any], second: dict[str, Any]) -> int:
    return sum(first["params"][name] != second["params"][name] for name in first["params"])


def _wait_for(studio: Any, page: Any, batch_id: str, is_so: Any) -> None:
    for _ in range(1200):
        if is_so(studio.get(f"/jobs/batches/{batch_id}")["states"]):
            return
        page.wait_for_timeout(100)
    raise AssertionError(studio.get(f"/jobs/batches/{batch_id}"))
