"""Two people and a lead in real browsers: work is given, done, submitted, returned, accepted, and compared."""

from __future__ import annotations

import json
import re
import sqlite3
import uuid
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import pytest

from server.access.secrets import hash_secret
from tests.web.conftest import Fingers, wait_for_held

pytestmark = [pytest.mark.browser, pytest.mark.timeout(300)]

AXE = Path(__file__).resolve().parents[2] / "web" / "node_modules" / "axe-core" / "axe.min.js"


def find_serious_faults(page: Any) -> list[Any]:
    """What axe finds on the page's own part that keeps people out."""
    page.evaluate(AXE.read_text())
    found = page.evaluate("async () => (await axe.run('#main', {resultTypes: ['violations']})).violations")
    heavy = [one for one in found if one["impact"] in ("serious", "critical")]
    return [(one["id"], [node["html"][:200] for node in one["nodes"]]) for one in heavy]


@dataclass(frozen=True)
class Person:
    """Somebody with a token, which their browser sends."""

    id: str
    name: str
    headers: dict[str, str]
    url: str

    def send(self, method: str, path: str, revision: int | None = None, **options: Any) -> Any:
        headers = (
            self.headers | ({} if revision is None else {"If-Match": f'"{revision}"'}) | options.pop("headers", {})
        )
        answer = httpx.request(method, f"{self.url}/api/v1{path}", headers=headers, timeout=60, **options)
        answer.raise_for_status()
        return answer.json() if answer.content else None

    def mark(self, recording: str, frame: int, points: Any, replica: str) -> None:
        path = f"/sequences/{recording}/annotations/cam0/{frame}/right"
        body = {"points": points, "operation_id": str(uuid.uuid4())}
        self.send("PUT", path, json=body, params={"replica": replica}, headers={"If-None-Match": "*"})

    def submit(self, assignment: dict[str, Any]) -> None:
        self.send("POST", f"/assignments/{assignment['id']}/submit", assignment["revision"])


@pytest.fixture
def join(studio):
    def made(name: str, role: str) -> Person:
        account_id, secret = uuid.uuid4(), uuid.uuid4().hex
        name = f"{name} {account_id.hex[:4]}"
        now = "2026-01-01 00:00:00.000000"
        with sqlite3.connect(studio.data_dir / "handloom.sqlite3", timeout=30) as database:
            database.execute(
                "INSERT INTO accounts (id, name, role, created_at) VALUES (?, ?, ?, ?)",
                (account_id.hex, name, role, now),
            )
            database.execute(
                "INSERT INTO tokens (id, account_id, name, secret_hash, may_write, created_at)"
                " VALUES (?, ?, ?, ?, 1, ?)",
                (uuid.uuid4().hex, account_id.hex, "test", hash_secret("token", secret), now),
            )
        return Person(str(account_id), name, {"Authorization": f"Bearer {secret}"}, studio.url)

    return made


@pytest.fixture
def open_as(open_page):
    def opened(person: Person, **options: Any) -> Any:
        page = open_page(**options)
        page.context.set_extra_http_headers(person.headers)
        return page

    return opened


@pytest.fixture
def project(join, recording):
    """A lead, and a project with the recording."""
    lead = join("Lea", "lead")
    made = lead.send("POST", "/projects", json={"name": f"Hands in action {uuid.uuid4().hex[:4]}"})
    lead.send("PUT", f"/projects/{made['id']}/sequences/{recording['id']}")
    return lead, made


@pytest.mark.slow
def test_work_is_given_done_submitted_returned_and_accepted(
    join, open_as, recording, project, picture_of, screenshots
) -> None:
    from playwright.sync_api import expect

    lead, made = project
    ann = join("Ann", "annotator")

    page = open_as(lead)
    page.goto(f"/projects/{made['id']}")
    form = page.get_by_role("form", name="Give frames to somebody")
    form.get_by_label("Last frame").fill("1")
    form.get_by_label("Person").click()
    page.get_by_role("option", name=re.compile(ann.name)).click()
    form.get_by_label("Note").fill("Both wrists")
    form.get_by_role("button", name="Assign").click()
    expect(page.get_by_test_id("person")).to_contain_text(ann.name)
    expect(page.get_by_test_id("person")).to_contain_text("0 of 2 frames done")
    page.get_by_role("button", name=re.compile("^Change the work of")).click()
    change = page.get_by_role("form", name=re.compile("^Change the work of"))
    change.get_by_label("Note").fill("Both wrists, please")
    screenshots.take(page, "team-change")
    change.get_by_role("button", name="Save").click()
    expect(page.get_by_test_id("person")).to_contain_text("Both wrists, please")

    work = open_as(ann)
    work.goto("/projects")
    expect(work.get_by_test_id("work")).to_contain_text("Both wrists, please")
    screenshots.take(work, "team-my-work")
    work.get_by_role("link", name="Go on at frame 0").click()
    picture = picture_of(work)
    picture.wait()
    bar = work.get_by_role("group", name="Assignment")
    expect(bar).to_contain_text("0 of 2 done")
    picture.click(320, 350)
    picture.wait_until_saved()
    expect(bar).to_contain_text("0 of 2 done, 1 begun")
    work.keyboard.press("Control+Enter")
    expect(bar).to_contain_text("1 frame is not begun. 1 frame has open joints, the first is 0.")
    work.keyboard.press("Shift+o")
    expect(bar).to_contain_text("1 of 2 done")
    picture.wait_until_saved()
    work.keyboard.press("Alt+n")
    expect(work.get_by_label("Frame", exact=True)).to_have_value("1")
    picture.wait()
    held, asked = [], []
    work.route("**/annotations/cam0/1/right*", lambda route: held.append(route))
    work.on("request", lambda request: asked.append(request.url) if request.url.endswith("/submit") else None)
    picture.click(300, 300)
    expect(bar).to_contain_text("1 of 2 done, 1 begun")
    screenshots.take(work, "team-annotator")
    work.keyboard.press("Control+Enter")
    expect(bar).to_contain_text("1 frame has open joints, the first is 1.")
    work.keyboard.press("Control+Enter")
    expect(bar).to_contain_text("Submits as soon as everything is saved")
    screenshots.take(work, "team-submits-when-saved")
    wait_for_held(work, held, 1)
    assert not asked, "the last joint is still on its way"
    for route in held:
        route.continue_()
    work.unroute("**/annotations/cam0/1/right*")
    expect(bar.get_by_test_id("assignment-state")).to_have_text("in review")
    expect(work.get_by_test_id("next-click")).to_contain_text("waits for its review")
    picture.click(400, 300)
    assert len(lead.send("GET", f"/sequences/{recording['id']}/annotations")["items"]) == 2
    points = lead.send("GET", f"/sequences/{recording['id']}/annotations/cam0/1/right")["points"]
    assert sum(v > 0 for _, _, v in points) == 1, "a click into locked work does nothing"
    tools = work.get_by_role("toolbar", name="Tools")
    for tool in ("Occluded, or visible again", "Clear the joint", "Clear the whole hand", "Swap left and right"):
        expect(tools.get_by_role("button", name=tool)).to_be_disabled()

    page.goto("/projects")
    waiting = page.get_by_role("region", name="My work").get_by_test_id("work").filter(has_text="in review").last
    expect(waiting).to_contain_text(recording["name"])
    screenshots.take(page, "team-to-review")
    waiting.get_by_role("link", name="Review it").click()
    picture_of(page).wait()
    page.keyboard.press("f")
    expect(page.get_by_label("Frame", exact=True)).to_have_value("1")
    picture_of(page).wait()
    review = page.get_by_role("group", name="Assignment")
    expect(review.get_by_role("button", name="Accept")).to_be_visible()
    page.keyboard.press("Alt+c")
    expect(review.get_by_role("textbox", name="Comment on")).to_be_focused()
    page.keyboard.type("The wrist is lower.")
    sent: list[Any] = []
    page.route("**/assignments/*/comments", lambda route: sent.append(route))
    page.keyboard.press("Enter")
    wait_for_held(page, sent, 1)
    [comment] = sent
    answer = comment.fetch()  # live news of the comment come before its answer
    page.get_by_role("tab", name="Comments").click()
    expect(page.get_by_role("group", name="Comments")).to_contain_text("The wrist is lower.")
    page.get_by_label("Colour of frame 1").focus()
    page.keyboard.press("Alt+r")
    reason = review.get_by_role("textbox", name="What should be changed")
    expect(reason).to_be_focused()
    with page.expect_response("**/assignments/*/comments"):
        comment.fulfill(response=answer)
    page.wait_for_timeout(200)
    expect(reason).to_be_focused()
    page.unroute("**/assignments/*/comments")
    page.keyboard.type("See frame 1.")
    page.keyboard.press("Enter")
    expect(review.get_by_test_id("assignment-state")).to_have_text("returned")
    screenshots.take(page, "team-review")
    assert find_serious_faults(page) == []

    work.goto("/projects")
    expect(work.get_by_test_id("work")).to_contain_text("See frame 1.")
    screenshots.take(work, "team-returned")
    assert find_serious_faults(work) == []
    work.get_by_role("link", name=re.compile("Look through|Go on")).click()
    picture.wait()
    work.get_by_role("tab", name="Comments").click()
    said = work.get_by_role("group", name="Comments")
    said.get_by_role("button", name=re.compile("frame 1")).click()
    expect(work.get_by_label("Frame", exact=True)).to_have_value("1")
    said.get_by_role("button", name="Resolve").first.click()
    expect(said.get_by_text("resolved by")).to_be_visible()

    work.keyboard.press("Alt+c")
    work.keyboard.type("Is it hidden?")
    work.keyboard.press("Control+b")
    work.keyboard.press("Control+Enter")  # sends what was written; it does not hand the work in
    expect(said).to_contain_text("Is it hidden?")
    expect(bar.get_by_role("textbox", name="Comment on")).to_have_count(0)
    expect(work.get_by_label("Frame", exact=True)).to_have_value("1")
    expect(bar).not_to_contain_text("open joints")
    bar.get_by_role("button", name="Submit").click()
    expect(bar).to_contain_text("open joints")
    bar.get_by_role("button", name="Submit").click()
    expect(bar.get_by_test_id("assignment-state")).to_have_text("in review")

    page.reload()
    picture_of(page).wait()
    expect(review.get_by_role("button", name="Accept")).to_be_visible()
    page.keyboard.press("Alt+a")
    expect(review.get_by_test_id("assignment-state")).to_have_text("accepted")
    expect(page.get_by_test_id("next-click")).to_contain_text("finished")


@pytest.mark.slow
def test_a_reviewer_looks_through_the_work_comments_and_accepts_by_touch(
    join, open_as, recording, synthesized, project, picture_of, screenshots
) -> None:
    from playwright.sync_api import expect

    lead, made = project
    ann = join("Ann", "annotator")
    frames = {"sequence_id": recording["id"], "account_id": ann.id, "frame_first": 0, "frame_last": 1}
    work = lead.send("POST", f"/projects/{made['id']}/assignments", json=frames)
    hand = {"points": [[x, y, 2] for x, y in synthesized.joints], "operation_id": str(uuid.uuid4())}
    place = f"/sequences/{recording['id']}/annotations/cam0/0/right"
    ann.send("PUT", place, json=hand, headers={"If-None-Match": "*"})
    ann.submit(ann.send("GET", f"/assignments/{work['id']}"))
    before = lead.send("GET", f"/sequences/{recording['id']}/annotations")["items"]

    page = open_as(lead, width=390, height=844, is_phone=True)
    page.goto("/projects")
    mine = page.get_by_role("region", name="My work").get_by_test_id("work").filter(has_text=ann.name)
    for part in (mine.get_by_text(f"{recording['name']}, frames 0–1"), mine.get_by_role("link", name="Review it")):
        box = part.bounding_box()
        assert box["width"] > 200 and box["x"] >= 0 and box["x"] + box["width"] <= 390, "all of it is on the phone"
    screenshots.take(page, "team-work-phone")
    mine.get_by_role("link", name="Review it").tap()
    picture, fingers = picture_of(page), Fingers(page)
    picture.wait()
    frame = page.get_by_label("Frame", exact=True)
    x, y = picture.at(300, 300)
    fingers.draw(((x, y), (x - 90, y)))
    expect(frame).to_have_value("1")
    picture.wait()
    fingers.draw(((x - 90, y), (x, y)))
    expect(frame).to_have_value("0")
    picture.wait()
    scale = json.loads(picture.element.get_attribute("data-view"))["scale"]
    fingers.draw(((x - 20, y), (x - 60, y)), ((x + 20, y), (x + 60, y)))
    page.wait_for_function(
        "(scale) => JSON.parse(document.querySelector('[data-picture]').dataset.view).scale > 2 * scale", arg=scale
    )
    page.touchscreen.tap(*picture.at(280, 230))
    page.touchscreen.tap(*picture.at(*synthesized.joints[8]))
    bar = page.get_by_role("group", name="Assignment")
    bar.get_by_role("button", name="Comment").tap()
    words = page.get_by_label("Comment on the right index tip")
    words.fill("Half a pixel low.")
    page.get_by_role("button", name="Send").tap()
    page.get_by_role("tab", name="Comments").tap()
    expect(page.get_by_role("group", name="Comments")).to_contain_text("Half a pixel low.")
    screenshots.take(page, "team-review-phone")
    assert page.evaluate("document.scrollingElement.scrollWidth <= innerWidth")
    bar.get_by_role("button", name="Accept").tap()
    expect(bar.get_by_test_id("assignment-state")).to_have_text("accepted")
    assert lead.send("GET", f"/sequences/{recording['id']}/annotations")["items"] == before, "looking marks nothing"


@pytest.mark.slow
def test_blind_replicas_are_marked_apart_and_compared(join, open_as, recording, project, picture_of, screenshots):
    from playwright.sync_api import expect

    lead, made = project
    ann, others = join("Ann", "annotator"), [join(name, "annotator") for name in ("Bob", "Cy")]
    shared = {"points": [[200, 200, 2]] * 21, "operation_id": str(uuid.uuid4())}
    path = f"/sequences/{recording['id']}/annotations/cam0/4/right"
    lead.send("PUT", path, json=shared, headers={"If-None-Match": "*"})
    body = {"name": "Agreement, week 1", "sequence_id": recording["id"], "frames": [1, 4, 9], "cameras": ["cam0"]}
    people = [ann, *others]
    body |= {"hands": ["right"], "account_ids": [person.id for person in people]}
    replicas = lead.send("POST", f"/projects/{made['id']}/replica-sets", json=body)
    early = open_as(lead)
    early.goto(f"/projects/{made['id']}/agreement/{replicas['id']}")
    expect(early.get_by_role("heading", name="Nothing to compare yet")).to_be_visible()
    expect(early.get_by_text("At least two people must submit their work; nobody has so far.")).to_be_visible()
    expect(early.get_by_role("table")).to_have_count(0)
    expect(early.get_by_role("link", name="CSV")).to_have_count(0)
    screenshots.take(early, "team-agreement-early")
    given = {person.id: person.send("GET", "/assignments", params={"mine": "true"})["items"][0] for person in people}
    rng = np.random.default_rng(1)
    for person in others:
        for frame in (1, 4, 9):
            xy = 200 + 8 * np.arange(42).reshape(21, 2) + rng.normal(size=(21, 2)) * 1.5
            person.mark(recording["id"], frame, [[x, y, 2] for x, y in xy.tolist()], given[person.id]["id"])
        person.submit(given[person.id])

    page = open_as(ann)
    page.goto(f"/recordings/{recording['id']}/annotate?frame=4")
    picture_of(page).wait()
    expect(page.get_by_text("You mark this frame blindly;")).to_be_visible()
    expect(page.get_by_role("tab", name="right 0/21")).to_be_visible()
    page.get_by_role("link", name="Open my version").click()
    picture = picture_of(page)
    bar = page.get_by_role("group", name="Assignment")
    expect(bar).to_contain_text("0 of 3 done")
    expect(page).to_have_url(re.compile("replica="))
    for frame, following in ((4, 9), (9, 9)):
        picture.wait()
        expect(page.get_by_label("Frame", exact=True)).to_have_value(str(frame))
        for joint in range(21):
            picture.click(200 + 16 * joint, 208 + 8 * joint if joint < 20 else 350)
        picture.wait_until_saved()
        page.keyboard.press("f")
        expect(page.get_by_label("Frame", exact=True)).to_have_value(str(following))
    page.keyboard.press("d")
    page.keyboard.press("d")
    expect(page.get_by_label("Frame", exact=True)).to_have_value("1")
    screenshots.take(page, "team-blind")
    page.reload()
    picture.wait()
    expect(bar).to_contain_text("2 of 3 done")
    assert lead.send("GET", f"/sequences/{recording['id']}/annotations")["items"][0]["points"][0] == [200, 200, 2]
    expect(bar.get_by_role("button", name="Submit")).to_be_visible()
    page.keyboard.press("Control+Enter")
    expect(bar).to_contain_text("1 frame is not begun.")
    page.keyboard.press("Control+Enter")
    expect(bar.get_by_test_id("assignment-state")).to_have_text("in review")

    for width, height, scheme in ((1280, 720, "dark"), (1920, 1080, "light")):
        report = open_as(lead, width=width, height=height, scheme=scheme)
        report.goto(f"/projects/{made['id']}")
        expect(report.get_by_role("region", name="Blind replicas")).to_contain_text("3 of 3")
        screenshots.take(report, f"team-project-{width}-{scheme}")
        assert find_serious_faults(report) == []
        report.get_by_role("link", name="Agreement", exact=True).click()
        expect(report.get_by_role("region", name="Annotators")).to_contain_text("Bob")
        assert not report.evaluate("document.scrollingElement.scrollWidth > innerWidth")
        screenshots.take(report, f"team-agreement-{width}-{scheme}")
        assert find_serious_faults(report) == []
    with report.expect_download() as download:
        report.get_by_role("link", name="HTML").click()
    assert "Agreement, week 1" in download.value.path().read_text()
    worst = report.get_by_role("region", name="Where they differ most")
    worst.get_by_role("link", name=others[0].name).first.click()
    picture_of(report).wait()
    expect(report.get_by_test_id("next-click")).to_contain_text("to be looked at, not changed")
    assert replicas["id"]


def test_projects_are_made_put_away_and_brought_back(join, open_as, screenshots) -> None:
    from playwright.sync_api import expect

    lead = join("Lea", "lead")
    name = f"Grasps {uuid.uuid4().hex[:6]}"
    page = open_as(lead)
    page.goto("/projects")
    page.get_by_label("Name of a new project").fill(name)
    page.get_by_role("button", name="New project").click()
    expect(page.get_by_role("heading", name=name)).to_be_visible()
    screenshots.take(page, "team-empty-project")
    page.get_by_role("button", name="Rename the project").click()
    page.get_by_label("Description").fill("Two people, six objects")
    page.keyboard.press("Enter")
    expect(page.get_by_text("Two people, six objects")).to_be_visible()
    page.get_by_role("button", name="Archive").click()
    expect(page).to_have_url(re.compile("/projects$"))
    expect(page.get_by_role("link", name=name)).to_have_count(0)
    page.get_by_role("button", name="Undo").click()
    expect(page.get_by_role("heading", name=name)).to_be_visible()


def test_a_page_that_only_leads_may_use_says_so_and_offers_a_way_on(join, open_as) -> None:
    page = open_as(join("Ada", "annotator"))
    refused = []
    page.on("response", lambda answer: refused.append(answer.url) if answer.status == 403 else None)
    page.goto("/calibrations/new")
    page.get_by_role("heading", name="Leads calibrate cameras").wait_for()
    page.get_by_role("link", name="To the calibrated cameras").click()
    page.wait_for_url("**/calibrations")
    assert refused == []
    page.goto("/people")
    page.get_by_role("heading", name="You cannot open this now").wait_for()
    page.get_by_role("link", name="To the recordings", exact=True).click()
    page.wait_for_url("**/recordings")
