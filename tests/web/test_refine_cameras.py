"""Cameras refined from labels on the page of a recording: shown, taken, put back."""

from __future__ import annotations

import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.tracker.calibration.labelled_hands import record_knocked
from tests.web.test_accessibility import find_faults

pytestmark = [pytest.mark.browser, pytest.mark.timeout(240)]


@pytest.fixture
def knocked(studio, tmp_path: Path) -> dict[str, Any]:
    """A recording of four cameras, three of which were knocked, with labels of all frames."""
    record_knocked(tmp_path / "knocked", np.random.default_rng(0))
    archive = tmp_path / "knocked.zip"
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_STORED) as file:
        for path in sorted(path for path in (tmp_path / "knocked").rglob("*") if path.is_file()):
            file.write(path, path.relative_to(tmp_path))
    with archive.open("rb") as sent:
        made = studio.send("POST", "/imports", files={"files": ("knocked.zip", sent)}).json()
    assert made["state"] == "checked", made["report"]["problems"]
    stored = studio.send("POST", f"/imports/{made['id']}/confirm", json={"name": "Knocked"})
    stored.raise_for_status()
    return stored.json()


def find_places(studio, knocked) -> list[Any]:
    return [camera["T_world_camera"] for camera in studio.get(f"/sequences/{knocked['id']}")["cameras"]]


@pytest.mark.slow
def test_a_person_looks_takes_the_cameras_and_puts_those_of_before_back(studio, knocked, open_page, screenshots):
    from playwright.sync_api import expect

    before = find_places(studio, knocked)
    page = open_page()
    page.goto(f"/recordings/{knocked['id']}")
    part = page.get_by_role("region", name="Refine cameras from labels")
    part.get_by_role("button", name="Refine from labels").click()
    expect(part.get_by_role("status")).to_contain_text("Nothing is changed until you take them")
    expect(part.get_by_role("row")).to_have_count(5)
    expect(part.get_by_role("row").nth(1)).to_contain_text("stands still")
    expect(part.get_by_role("row").nth(2)).to_contain_text("mm")
    part.scroll_into_view_if_needed()
    screenshots.take(page, "refine-proposed")
    assert find_places(studio, knocked) == before

    part.get_by_role("button", name="Take these cameras").click()
    expect(part.get_by_role("status")).to_contain_text("These cameras were taken")
    after = find_places(studio, knocked)
    assert after != before and after[0] == before[0]

    page.reload()
    part.get_by_role("button", name="Restore the previous cameras").click()
    expect(part.get_by_role("status")).to_contain_text("The cameras of before were put back")
    assert find_places(studio, knocked) == before
    assert find_faults(page) == []


def test_a_proposal_is_left_and_the_cameras_stay(studio, knocked, open_page, screenshots):
    from playwright.sync_api import expect

    before = find_places(studio, knocked)
    page = open_page(width=390, height=844, scheme="light", is_phone=True)
    page.goto(f"/recordings/{knocked['id']}")
    part = page.get_by_role("region", name="Refine cameras from labels")
    part.get_by_role("button", name="Refine from labels").click()
    expect(part.get_by_role("status")).to_be_visible()
    part.scroll_into_view_if_needed()
    screenshots.take(page, "refine-proposed-phone")
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    part.get_by_role("button", name="Leave the cameras as they are").click()
    expect(part.get_by_role("status")).to_have_count(0)
    assert find_places(studio, knocked) == before


@pytest.mark.slow
def test_labels_that_are_too_few_are_told_in_a_sentence(recording, studio, knocked, open_page):
    from playwright.sync_api import expect

    for item in studio.get(f"/sequences/{knocked['id']}/annotations")["items"]:
        if item["camera"] != "cam0":
            path = f"/sequences/{knocked['id']}/annotations/{item['camera']}/{item['frame']}/right"
            gone = studio.send("DELETE", path, headers={"If-Match": f'"{item["revision"]}"'})
            assert gone.status_code < 300, gone.text
    page = open_page()
    page.goto(f"/recordings/{recording['id']}")
    expect(page.get_by_role("region", name="Tracks")).to_be_visible()
    expect(page.get_by_role("region", name="Refine cameras from labels")).to_have_count(0)  # it has one camera
    page.goto(f"/recordings/{knocked['id']}")
    part = page.get_by_role("region", name="Refine cameras from labels")
    part.get_by_role("button", name="Refine from labels").click()
    expect(part.get_by_role("alert")).to_contain_text("No two cameras share more than 0 labelled joints; needed 20")
