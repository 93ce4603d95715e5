"""What cannot work says so before it is tried: every form of a job in real Chromium, with its button disabled."""

from __future__ import annotations

import json
import re
import zipfile
from typing import Any

import pytest

from tests.web.hands import fill_studio

pytestmark = [pytest.mark.browser, pytest.mark.timeout(240)]

COLLECTION = "too few"


@pytest.fixture(scope="module")
def colour_only(studio: Any, synthesized: Any, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """The recording without its depth images, of which nobody says whose hands it shows."""
    archive = tmp_path_factory.mktemp("colour") / "colour.zip"
    with zipfile.ZipFile(archive, "w") as file:
        for path in sorted(synthesized.folder.rglob("*.png")):
            if path.parent.name == "color":
                file.write(path, f"colour/color/{path.name}")
        description = json.loads((synthesized.folder / "sequence.json").read_text())
        for camera in description["cameras"]:
            camera.pop("depth")
            camera.pop("depth_scale", None)
        description["objects"] = description["hands"] = []
        file.writestr("colour/sequence.json", json.dumps(description))
    with archive.open("rb") as file:
        made = studio.send("POST", "/imports", files={"files": ("colour.zip", file)})
    assert made.json()["state"] == "checked", made.text
    return studio.send("POST", f"/imports/{made.json()['id']}/confirm", json={"name": "Colour only"}).json()


def expect_refused(dialog: Any, button: str, reason: str | re.Pattern[str]) -> None:
    from playwright.sync_api import expect

    told = dialog.get_by_role("status", name="Can this be started").get_by_text(reason)
    expect(told).to_be_visible()
    expect(dialog.get_by_role("button", name=button, exact=True)).to_be_disabled()
    for part in (told, dialog.get_by_role("button", name=button, exact=True)):
        expect(part).to_be_in_viewport(ratio=0.95)  # however long the form is


def take_both(open_page: Any, screenshots: Any, page: Any, name: str) -> None:
    """Pictures of a form at two sizes; the second page is the same one, made larger."""
    screenshots.take(page, f"cannot-{name}-1280")
    if screenshots.folder is not None:
        page.set_viewport_size({"width": 1920, "height": 1080})
        page.wait_for_timeout(300)
        screenshots.take(page, f"cannot-{name}-1920")
        page.set_viewport_size({"width": 1280, "height": 720})


@pytest.mark.parametrize("scheme", ["dark", pytest.param("light", marks=pytest.mark.slow)])
def test_a_recording_that_cannot_be_tracked_is_not_offered_to_be(
    studio: Any, colour_only: dict[str, Any], recording: dict[str, Any], open_page: Any, screenshots: Any, scheme: str
) -> None:
    from playwright.sync_api import expect

    page = open_page(scheme=scheme)
    asked: list[int] = []
    page.on("response", lambda one: asked.append(one.status) if one.url.endswith("/jobs/check") else None)
    page.goto(f"/recordings/{colour_only['id']}")
    tracks = page.get_by_role("region", name="Tracks")
    expect(tracks.get_by_text("It cannot be tracked. The recording does not say which hands it shows.")).to_be_visible()
    for button in page.get_by_role("button", name="Track …").all():
        expect(button).to_be_disabled()
    assert set(asked) == {200}, "asked once the page knows its recording, and answered"
    take_both(open_page, screenshots, page, f"recording-{scheme}")

    page.goto("/jobs")
    page.get_by_role("button", name="Track several …").click()
    dialog = page.get_by_role("dialog")
    expect(dialog.get_by_text("Choose recordings above")).to_be_in_viewport(ratio=0.95)
    dialog.get_by_label("Filter recordings by name").fill("colour only")
    expect(dialog.get_by_text("The recording does not say which hands it shows.", exact=False)).to_be_visible()
    expect(dialog.get_by_role("checkbox", name="Colour only")).to_be_disabled()
    take_both(open_page, screenshots, page, f"batch-{scheme}")

    # Options that cannot be, of one that can: the form says so while they are typed.
    page.goto(f"/recordings/{recording['id']}")
    page.get_by_role("button", name="Track …").first.click()
    dialog = page.get_by_role("dialog")
    expect(dialog.get_by_role("button", name="Start tracking")).to_be_enabled()
    dialog.get_by_label("First frame", exact=True).fill("9")
    dialog.get_by_label("Last frame", exact=True).fill("4")
    expect_refused(dialog, "Start tracking", "The last frame, 4, comes before the first, 9.")
    take_both(open_page, screenshots, page, f"track-{scheme}")
    dialog.get_by_label("Last frame", exact=True).fill("12")
    expect(dialog.get_by_role("button", name="Start tracking")).to_be_enabled()

    # A job of a recording that is gone by now cannot be done again.
    job = studio.send("POST", "/jobs", json={"sequence_id": recording["id"]}).json()
    studio.send("POST", f"/jobs/{job['id']}/cancel").raise_for_status()
    revision = studio.send("GET", f"/sequences/{recording['id']}").headers["etag"]
    studio.send("DELETE", f"/sequences/{recording['id']}", headers={"If-Match": revision}).raise_for_status()
    page.goto(f"/jobs/{job['id']}")
    expect(page.get_by_role("region", name="What is kept").get_by_text(re.compile("was deleted"))).to_be_visible()
    expect(page.get_by_role("button", name="Try again")).to_be_disabled()
    expect(page.get_by_text("No step was finished.", exact=False)).to_be_visible()
    expect(page.get_by_role("button", name="Resume")).to_have_count(0)
    take_both(open_page, screenshots, page, f"job-{scheme}")
    studio.send("POST", f"/sequences/{recording['id']}/restore").raise_for_status()


@pytest.mark.parametrize("scheme", ["dark", pytest.param("light", marks=pytest.mark.slow)])
def test_forms_about_scans_say_what_is_missing(
    studio: Any, open_page: Any, screenshots: Any, tmp_path_factory: pytest.TempPathFactory, scheme: str
) -> None:
    from playwright.sync_api import expect

    hands = fill_studio(studio, tmp_path_factory.mktemp("few"), 6, COLLECTION)
    page = open_page(scheme=scheme)
    page.goto(f"/scans?collection={COLLECTION}")
    page.get_by_role("button", name="Register …").first.click()
    dialog = page.get_by_role("dialog")
    expect_refused(dialog, "Register", re.compile(f"has registered all {len(hands.scans)} scans of {COLLECTION}"))
    take_both(open_page, screenshots, page, f"register-{scheme}")
    dialog.get_by_label("All, again").check()
    expect(dialog.get_by_role("button", name="Register", exact=True)).to_be_enabled()

    page.goto("/models")
    page.get_by_role("button", name="Train …").click()
    dialog = page.get_by_role("dialog")
    dialog.get_by_role("combobox", name="Collection").click()
    page.get_by_role("option", name=COLLECTION, exact=True).click()
    expect_refused(dialog, "Train", re.compile("There are 0 registrations of 0 people; a model needs 20 of at least 2"))
    expect_refused(dialog, "Train", re.compile("registrations wait for a decision on the page Curate"))
    people = sorted({studio.get(f"/scans/{scan['id']}")["subject"] for scan in hands.scans})
    dialog.get_by_label("Subjects to leave out").click()
    for person in people:
        expect(page.get_by_role("option", name=person, exact=True)).to_be_visible()
    page.get_by_role("option", name=people[0], exact=True).click()
    expect(dialog.get_by_label("Quick", exact=False)).to_be_enabled()
    dialog.get_by_label("Name of the model").click()  # the list of people is shut
    expect(dialog.get_by_role("link", name="Accept registrations")).to_have_attribute("href", re.compile("/curate"))
    take_both(open_page, screenshots, page, f"train-{scheme}")
    page.keyboard.press("Escape")

    page.get_by_role("button", name="Register, train, again …").click()
    dialog = page.get_by_role("dialog")
    dialog.get_by_role("combobox", name="Collection").click()
    page.get_by_role("option", name=COLLECTION, exact=True).click()
    expect_refused(dialog, "Start", re.compile("a model needs 20 of at least 2 people"))
    take_both(open_page, screenshots, page, f"loop-{scheme}")
    for scan in hands.scans:
        studio.send("DELETE", f"/scans/{scan['id']}")
