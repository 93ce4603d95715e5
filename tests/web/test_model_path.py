"""From scans to a hand model in a real browser: registered, judged, trained, evaluated, and registered again."""

from __future__ import annotations

import json
import re
import uuid
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import server.app.app  # noqa: F401 (all tables, which name each other)
from server.database import Database
from server.registrations import service as registrations
from server.registrations.models import RegistrationRow
from server.settings import Settings
from server.storage import Storage
from server.storage.digest import compute_digest
from tests.server.conftest import GeneratedHand
from tests.server.curation import make_true_hand
from tests.web.test_curation import wait_for_hand, wait_until_saved
from tracker import save_blend_model, save_registration, untrained_hand

pytestmark = [pytest.mark.browser, pytest.mark.timeout(900)]

COLLECTION = "whole path"
TRAINED_ON, POSES = (1, 2, 3), (0, 5, 9, 20, 27, 40, 45)
TESTED_ON = 32
COLD = 1
"""Scans that nobody has registered before; the others begin at a registration by another model, and are quick."""


@pytest.fixture(scope="module")
def scans(studio: Any, tmp_path_factory: pytest.TempPathFactory) -> Iterator[list[dict[str, Any]]]:
    """Small scans of four people. A model that somebody uploaded has registered all but one of them."""
    folder = tmp_path_factory.mktemp("path")
    wanted = [(who, pose) for who in TRAINED_ON for pose in POSES] + [(TESTED_ON, pose) for pose in POSES[:3]]
    hands = {
        f"{who:02d}-{pose:02d}": make_true_hand(folder / f"{who:02d}-{pose:02d}", who, pose) for who, pose in wanted
    }
    archive = folder / "scans.zip"
    with zipfile.ZipFile(archive, "w") as file:
        for name, hand in hands.items():
            file.write(hand.folder / "hand.ply", f"{name}.ply")
        listed = [
            {"file": f"{name}.ply", "subject": hand.found.subject, "pose": hand.found.pose_name, "side": "right"}
            for name, hand in hands.items()
        ]
        file.writestr("scans.json", json.dumps(listed))
    with archive.open("rb") as file:
        options = json.dumps({"collection": COLLECTION})
        answer = studio.send("POST", "/scans", files={"files": (archive.name, file)}, data={"options": options})
    assert answer.status_code == 201 and not answer.json()["refused"], answer.text
    added = sorted(answer.json()["added"], key=lambda scan: scan["name"])
    save_blend_model(untrained_hand("right"), folder / "other.npz")
    with (folder / "other.npz").open("rb") as file:
        sent = studio.send("POST", "/hand-models", files={"files": ("other.npz", file)}, data={"name": "Other hand"})
    other = sent.json()["id"]
    database, storage = Database(Settings(data_dir=studio.data_dir).sqlalchemy_url), Storage(studio.data_dir)
    for scan in added[COLD:]:
        _add_registration(database, storage, scan, hands[scan["name"].removesuffix(".ply")], uuid.UUID(other))
    yield added
    for model in studio.get("/hand-models")["items"]:
        if model["kind"] in ("trained", "uploaded"):
            studio.send("DELETE", f"/hand-models/{model['id']}")
    for scan in added:
        studio.send("DELETE", f"/scans/{scan['id']}")


def _add_registration(
    database: Database, storage: Storage, scan: dict[str, Any], hand: GeneratedHand, model_id: uuid.UUID
) -> None:
    id_ = uuid.uuid4()
    folder = storage.folder(registrations.AREA, id_)
    save_registration(hand.found, folder)
    with database.writing() as session:
        row = RegistrationRow(
            id=id_,
            scan_id=uuid.UUID(scan["id"]),
            model_id=model_id,
            round=1,
            crop_revision=1,
            digest=compute_digest(folder / registrations.FILE),
            side="right",
            verdict="good",
            score=0.1,
            reasons=[],
            scan_to_mesh_mm=hand.found.scan_to_mesh_mm,
            seconds=1.0,
            decision=None,
        )
        registrations.add_registration(session, row)


def _wait_for_end(studio: Any, page: Any, job_id: str, seconds: float = 400) -> dict[str, Any]:
    for _ in range(int(10 * seconds)):
        job = studio.get(f"/jobs/{job_id}")
        if job["state"] not in ("queued", "running"):
            assert job["state"] == "succeeded", job["error"]
            return job
        page.wait_for_timeout(100)
    raise AssertionError(studio.get(f"/jobs/{job_id}"))


def _bars(page: Any, title: str) -> dict[str, float]:
    rows = page.get_by_role("region", name=title, exact=True).locator("tbody tr").all()
    found = {}
    for row in rows:
        name, value = row.locator("th").inner_text(), row.locator("td").last.inner_text()
        found[name.lower()] = float(value.removesuffix(" mm"))
    return found


def _legend(page: Any, title: str) -> dict[str, float]:
    """Values of the curves of a plot at the place where its line stands."""
    figure = page.get_by_role("figure", name=title, exact=True)
    return {
        entry.inner_text().split("\n")[0].strip(): float(re.findall(r"[\d.]+", entry.locator("strong").inner_text())[0])
        for entry in figure.locator("span:has(> strong)").all()
    }


def _inked(page: Any, title: str) -> int:
    """Pixels of a plot that are neither empty nor grey: its curves."""
    canvas = page.get_by_role("figure", name=title, exact=True).locator("canvas")
    return canvas.evaluate(
        """(canvas) => {
          const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
          let count = 0;
          for (let i = 0; i < data.length; i += 4) {
            const [r, g, b, alpha] = data.slice(i, i + 4);
            if (alpha > 100 && Math.max(r, g, b) - Math.min(r, g, b) > 40) count++;
          }
          return count;
        }"""
    )


@pytest.mark.slow
def test_scans_become_a_model_that_is_judged_and_registers_again(studio, scans, open_page, screenshots):
    from playwright.sync_api import expect

    page = open_page()

    # Register: a real worker does it, and the page follows it.
    page.goto(f"/scans?collection={COLLECTION}")
    page.get_by_role("button", name="Register …").first.click()
    dialog = page.get_by_role("dialog")
    dialog.get_by_role("combobox", name="Hand model").click()
    page.get_by_role("option", name="Untrained right hand").click()
    dialog.get_by_role("button", name="Register", exact=True).click()
    page.wait_for_url(re.compile(r"/jobs/[0-9a-f-]{36}$"))
    expect(page.get_by_role("status").get_by_text(f"of {len(scans)} scans")).to_be_visible(timeout=60_000)
    expect(page.get_by_text("Registering", exact=False).first).to_be_visible()
    screenshots.take(page, "path-registering")
    job = _wait_for_end(studio, page, page.url.rsplit("/", 1)[1])
    assert (job["frames_done"], job["frames_total"]) == (len(scans), len(scans))
    made = studio.get(f"/registrations?job_id={job['id']}&limit=100")["items"]
    assert {one["scan"]["id"] for one in made} == {scan["id"] for scan in scans} and len(made) == len(scans)
    assert sum(one["verdict"] == "good" for one in made) >= 20
    screenshots.take(page, "path-registered")
    page.get_by_role("link", name="Curate", exact=True).first.click()

    # Curate: by keys alone.
    page.goto(f"/curate?collection={COLLECTION}")
    queue = studio.get(f"/registrations?collection={COLLECTION}&queue=undecided&order=likely_failures&limit=100")[
        "items"
    ]
    for registration in queue:
        wait_for_hand(page, registration["id"])
        page.keyboard.press("a")
    wait_until_saved(page)
    counts = studio.get(f"/registrations/counts?collection={COLLECTION}")
    assert (counts["accept"], counts["undecided"]) == (len(scans), 0)

    # Train: what was accepted of all but one person, on whom the model is then judged.
    page.goto("/models")
    page.get_by_role("button", name="Train …").click()
    dialog = page.get_by_role("dialog")
    dialog.get_by_label("Name of the model").fill("Hand of the whole path")
    dialog.get_by_role("combobox", name="Collection").click()
    page.get_by_role("option", name=COLLECTION).click()
    expect(dialog.get_by_label("Quick", exact=False)).to_be_disabled()
    dialog.get_by_label("Subjects to leave out").fill(f"S{TESTED_ON}")
    page.keyboard.press("Enter")
    expect(dialog.get_by_label("Quick", exact=False)).to_be_checked()
    expect(
        dialog.get_by_text(f"{len(TRAINED_ON) * len(POSES)} registrations of {len(TRAINED_ON)} subjects")
    ).to_be_visible()
    dialog.get_by_label("Parts of the hand vary by themselves, too").check()
    screenshots.take(page, "path-train-dialog")
    dialog.get_by_role("button", name="Train", exact=True).click()
    page.wait_for_url(re.compile(r"/jobs/[0-9a-f-]{36}$"))
    screenshots.take(page, "path-training")
    job = _wait_for_end(studio, page, page.url.rsplit("/", 1)[1])
    assert job["params"]["options"]["num_local_shapes"] == 40
    parameters = page.get_by_role("region", name="Parameters")
    expect(parameters.get_by_text("Shapes of parts of the hand")).to_be_visible()
    expect(page.get_by_label("Log of the job").get_by_text("Hand of the whole path is trained")).to_be_visible()
    screenshots.take(page, "path-trained")
    page.get_by_role("link", name="Open the model").click()

    # The model's page: its figures are those of the API.
    page.wait_for_url(re.compile(f"/models/{job['hand_model_id']}$"))
    report = studio.get(f"/hand-models/{job['hand_model_id']}/report")["report"]
    study = report["study"]
    assert (study["people"], study["scans"], report["people"]) == ([f"S{TESTED_ON}"], 2, len(TRAINED_ON))
    kept = page.get_by_role("region", name="People kept for testing")
    expect(kept.get_by_text(f"2 scans of subject S{TESTED_ON}")).to_be_visible()
    for title, group, key in (
        ("Scan to mesh", "models", "scan_to_mesh_mm"),
        ("Vertices", "models", "vertices_mm"),
        ("Scan to mesh, own template", "own_template", "scan_to_mesh_mm"),
        ("Vertices, own template", "own_template", "vertices_mm"),
    ):
        assert _bars(page, title) == {name: round(row[key], 3) for name, row in study[group].items()}, title
    assert set(study["models"]) == {"learned", "untrained"}
    assert set(study["own_template"]) == {"learned", "blend shapes off"}
    last = study["pose_generalisation"]["learned"][-1]
    assert _legend(page, "Generalisation of poses") == {"Learned": pytest.approx(last["mean_mm"], abs=0.0051)}
    shared = min(len(report["shape_space"]), len(report["pose_space"]))
    assert _legend(page, "Compactness") == {
        "Shape space": pytest.approx(100 * report["shape_space"][shared - 1], abs=0.051),
        "Pose space": pytest.approx(100 * report["pose_space"][shared - 1], abs=0.051),
    }
    for title in ("Generalisation of poses", "Compactness", "Generalisation of shapes", "Passes"):
        assert _inked(page, title) > 100, title
    screenshots.take(page, "path-model")
    kept.scroll_into_view_if_needed()
    screenshots.take(page, "path-model-plots")
    if screenshots.folder:
        large = open_page(1920, 1080, "light")
        large.goto(page.url)
        large.get_by_role("region", name="People kept for testing").scroll_into_view_if_needed()
        large.wait_for_timeout(1500)
        screenshots.take(large, "path-model-light-1920")
    page.get_by_role("button", name="Download").click()
    with page.expect_download() as started:
        page.get_by_role("menuitem", name="The report").click()
    text = Path(started.value.path()).read_text()
    assert "Hand of the whole path" in text and f"{study['models']['learned']['vertices_mm']:.3f}" in text
    page.keyboard.press("Escape")

    # And again, with the new model; what has begun can be gone on with.
    page.get_by_role("button", name="Register again").click()
    page.get_by_role("menuitem", name="The loop", exact=False).click()
    dialog = page.get_by_role("dialog")
    dialog.get_by_role("combobox", name="Collection").click()
    page.get_by_role("option", name=COLLECTION).click()
    screenshots.take(page, "path-loop-dialog")
    dialog.get_by_role("button", name="Start", exact=True).click()
    page.wait_for_url(re.compile(r"/jobs/[0-9a-f-]{36}$"))
    expect(page.get_by_role("heading", name=re.compile(f"1 round over {len(scans)} scans"))).to_be_visible()
    loop = studio.get(f"/jobs/{page.url.rsplit('/', 1)[1]}")
    assert (loop["kind"], loop["params"]["model_id"], loop["params"]["by"]) == ("loop", job["hand_model_id"], "verdict")
    expect(page.get_by_text("running", exact=True).first).to_be_visible()
    while not studio.get(f"/jobs/{loop['id']}")["frames_done"]:  # something must be kept to go on from
        page.wait_for_timeout(200)
    page.get_by_role("button", name="Cancel").click()
    expect(page.get_by_text("cancelled", exact=True).first).to_be_visible()
    expect(page.get_by_role("button", name="Resume")).to_be_visible()
