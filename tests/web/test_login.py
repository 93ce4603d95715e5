"""People in real Chromium: logging in, a login that ends in mid-frame, somebody else at the same browser, people."""

from __future__ import annotations

import logging
import os
import re
import signal
import socket
import sqlite3
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import httpx
import pytest

from server.access.logins import set_password
from server.access.models import Role
from server.access.people import add_account
from server.cli.open_studio import open_studio
from server.settings import Settings
from tests.web.conftest import (
    ROOT,
    Picture,
    Screenshots,
    Studio,
    Synthesized,
    _lacking,
    _wait_until_up,
    wait_for_held,
)
from tests.web.hands import fill_studio
from tests.web.test_curation import wait_for_hand

pytestmark = pytest.mark.browser
log = logging.getLogger(__name__)
PASSWORD = "four words in a row"
PEOPLE: tuple[tuple[str, Role], ...] = (("Lea", "admin"), ("Anna", "annotator"), ("Ben", "annotator"))


@dataclass(frozen=True)
class Lab(Studio):
    """A studio where people log in."""

    recording_id: str = ""

    token: str = ""

    def execute(self, statement: str) -> None:
        with closing(sqlite3.connect(self.data_dir / "handloom.sqlite3", timeout=20)) as database, database:
            database.execute(statement)

    def send(self, method: str, path: str, **options: Any) -> httpx.Response:
        headers = {"Authorization": f"Bearer {self.token}"}
        return httpx.request(method, f"{self.url}/api/v1{path}", headers=headers, timeout=60, **options)

    def get(self, path: str) -> Any:
        return self.send("GET", path).raise_for_status().json()

    def annotations(self) -> list[dict[str, Any]]:
        return self.get(f"/sequences/{self.recording_id}/annotations")["items"]


@pytest.fixture(scope="module")
def lab(chromium: str, synthesized: Synthesized, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Lab]:
    if not (ROOT / "web" / "dist" / "index.html").is_file():
        _lacking("The browser app is not built: run `make setup` first.")
    folder = tmp_path_factory.mktemp("lab")
    data = folder / "data"
    environment = os.environ | {"HANDLOOM_DATA_DIR": str(data), "HANDLOOM_LOGIN": "required"}
    with open_studio(Settings(data_dir=data)) as opened:
        for name, role in PEOPLE:
            with opened.database.writing() as session:
                account = add_account(session, None, name, role)
            set_password(opened.database, account.id, name, PASSWORD)
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    log = folder / "studio.log"
    with log.open("w") as output:
        process = subprocess.Popen(
            [sys.executable, "-m", "server.cli", "serve", "--no-worker", "--port", str(port)],
            cwd=ROOT,
            env=environment,
            stdout=output,
            stderr=subprocess.STDOUT,
        )
    lab = Lab(f"http://127.0.0.1:{port}", data, log)
    try:
        _wait_until_up(lab, process)
        api = f"{lab.url}/api/v1"
        with httpx.Client(base_url=api, timeout=60) as client, synthesized.archive.open("rb") as file:
            client.post("/login", json={"name": "Lea", "password": PASSWORD}).raise_for_status()
            token = client.post("/account/tokens", json={"name": "the tests", "may_write": True}).json()["secret"]
            made = client.post("/imports", files={"files": ("opening-hand.zip", file)}).json()
            stored = client.post(f"/imports/{made['id']}/confirm", json={"name": "Opening hand"})
        yield Lab(lab.url, lab.data_dir, log, stored.json()["id"], token)
    finally:
        process.send_signal(signal.SIGTERM)
        try:
            process.wait(20)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()


OpenLab = Callable[..., Any]


@pytest.fixture
def open_lab(browser: Any, lab: Lab) -> Iterator[OpenLab]:
    """Opens a page of the lab in a browser profile of its own, where that person has logged in."""
    contexts: list[Any] = []

    def opened(who: str | None = None, scheme: str = "dark", width: int = 1280, height: int = 720) -> Any:
        context = browser.new_context(viewport={"width": width, "height": height}, base_url=lab.url, locale="en-GB")
        context.set_default_timeout(30_000)
        context.add_init_script(f"localStorage.setItem('handloom/colours', '{scheme}')")
        contexts.append(context)
        if who is not None:
            assert context.request.post("/api/v1/login", data={"name": who, "password": PASSWORD}).ok
        return context.new_page()

    yield opened
    for context in contexts:
        context.close()


def log_in(page: Any, name: str, password: str = PASSWORD) -> None:
    page.get_by_label("Name", exact=True).fill(name)
    page.get_by_role("textbox", name="Password").fill(password)
    page.get_by_role("button", name="Log in").click()
    if password == PASSWORD:
        page.get_by_role("button", name=f"Account of {name}").wait_for()


def annotate(page: Any, lab: Lab, frame: int) -> Picture:
    page.goto(f"/recordings/{lab.recording_id}/annotate?frame={frame}")
    return Picture(page)


UNSAVED = "Object.keys(localStorage).filter((name) => name.startsWith('handloom/unsaved/')).length"


@contextmanager
def asking_nothing(page: Any) -> Iterator[None]:
    """No answer tells the page within the block that a login has ended: no dialog comes in between a gesture and the
    picture it is meant for. What was asked before is answered first; what was held goes on afterwards."""
    page.route("**/api/v1/**", lambda route: None)
    page.wait_for_timeout(500)
    yield
    page.unroute("**/api/v1/**")


def end_logins(page: Any, lab: Lab, gesture: Callable[[], None]) -> None:
    """Every login ends, and the gesture is the first that meets it."""
    with asking_nothing(page):
        lab.execute("DELETE FROM logins")
        gesture()


def test_nothing_is_shown_before_somebody_logs_in(lab: Lab, open_lab: OpenLab, screenshots: Screenshots) -> None:
    from playwright.sync_api import expect

    page = open_lab()
    page.goto(f"/recordings/{lab.recording_id}")
    expect(page.get_by_role("button", name="Log in")).to_be_visible()
    expect(page.get_by_text("Opening hand")).to_have_count(0)
    screenshots.take(page, "login-dark-1280")
    log_in(page, "Anna", "not her password")
    expect(page.get_by_role("alert")).to_contain_text("The name or the password is wrong")
    screenshots.take(page, "login-wrong-dark-1280")
    log_in(page, "Anna")
    expect(page.get_by_role("heading", name="Opening hand")).to_be_visible()
    page.get_by_role("button", name="Account of Anna").click()
    screenshots.take(page, "me-menu-dark-1280")
    expect(page.get_by_role("menuitem", name="People")).to_have_count(0)
    page.get_by_role("menuitem", name="Log out").click()
    expect(page.get_by_role("button", name="Log in")).to_be_visible()


def test_a_login_that_ends_in_mid_frame_loses_no_gesture(
    lab: Lab, open_lab: OpenLab, synthesized: Synthesized, screenshots: Screenshots
) -> None:
    from playwright.sync_api import expect

    page = open_lab("Anna")
    picture = annotate(page, lab, 1)
    picture.wait()
    picture.click(*synthesized.joints[0])
    picture.wait_until_saved()
    end_logins(page, lab, lambda: picture.click(*synthesized.joints[1]))
    dialog = page.get_by_role("dialog", name="Your login has ended")
    expect(dialog).to_be_visible()
    expect(page.get_by_test_id("save-state")).to_have_text(re.compile("log in to save, 1 waiting"))
    screenshots.take(page, "login-ended-dark-1280")
    assert lab_points(lab, 1) == 1
    dialog.get_by_role("textbox", name="Password").fill(PASSWORD)
    page.keyboard.press("Enter")
    expect(dialog).to_have_count(0)
    picture.wait_until_saved()
    assert lab_points(lab, 1) == 2
    picture.click(*synthesized.joints[2])
    picture.wait_until_saved()
    assert lab_points(lab, 1) == 3
    assert {item["author"] for item in lab.annotations() if item["frame"] == 1} == {"Anna"}


def test_a_login_that_ends_while_curating_loses_no_decision(
    lab: Lab, open_lab: OpenLab, tmp_path: Path, screenshots: Screenshots
) -> None:
    from playwright.sync_api import expect

    hands = fill_studio(lab, tmp_path, 3, "curation")
    page = open_lab("Lea")
    page.goto("/curate?collection=curation")
    wait_for_hand(page, hands.registrations[0])
    page.keyboard.press("a")
    wait_for_hand(page, hands.registrations[1])
    saved = page.get_by_test_id("save-state")
    expect(saved).to_have_text("saved")
    end_logins(page, lab, lambda: page.keyboard.press("r"))
    dialog = page.get_by_role("dialog", name="Your login has ended")
    expect(dialog).to_be_visible()
    expect(saved).to_have_text(re.compile("log in to save, 1 waiting"))
    screenshots.take(page, "login-ended-curating-dark-1280")

    def decisions() -> list[str | None]:
        found = {item["id"]: item["decision"] for item in lab.get("/registrations?collection=curation")["items"]}
        return [found[id_] for id_ in hands.registrations]

    assert decisions() == ["accept", None, None]
    dialog.get_by_role("textbox", name="Password").fill(PASSWORD)
    page.keyboard.press("Enter")
    expect(dialog).to_have_count(0)
    expect(saved).to_have_text("saved")
    assert decisions() == ["accept", "reject", None]
    wait_for_hand(page, hands.registrations[2])
    page.keyboard.press("u")
    expect(page.get_by_text("The queue is done")).to_be_visible()
    expect(saved).to_have_text("saved")
    assert decisions() == ["accept", "reject", "unsure"]


def lab_points(lab: Lab, frame: int) -> int:
    """Joints that the studio has of a frame."""
    items = [item for item in lab.annotations() if item["frame"] == frame]
    return sum(point[2] > 0 for item in items for point in item["points"])


def test_what_one_person_left_is_not_sent_in_the_name_of_the_next(
    lab: Lab, open_lab: OpenLab, synthesized: Synthesized, screenshots: Screenshots
) -> None:
    from playwright.sync_api import expect

    page = open_lab()
    picture = annotate(page, lab, 3)
    log_in(page, "Anna")
    picture.wait()
    end_logins(page, lab, lambda: picture.click(*synthesized.joints[0]))
    assert page.evaluate(UNSAVED) == 1, "the gesture is kept in the browser"
    dialog = page.get_by_role("dialog", name="Your login has ended")
    expect(dialog).to_be_visible()
    dialog.get_by_label("Name", exact=True).fill("Ben")
    dialog.get_by_role("textbox", name="Password").fill(PASSWORD)
    dialog.get_by_role("button", name="Log in").click()
    expect(page.get_by_role("button", name="Account of Ben")).to_be_visible()
    picture.wait()
    picture.wait_until_saved()
    assert lab_points(lab, 3) == 0, "Anna's gesture waits for Anna"
    expect(page.get_by_test_id("waits-for")).to_have_text("1 gesture of Anna waits for Anna")
    screenshots.take(page, "waits-for-anna-dark-1280")
    page.get_by_role("button", name="Account of Ben").click()
    page.get_by_role("menuitem", name="Log out").click()
    log_in(page, "Anna")
    picture = annotate(page, lab, 3)
    picture.wait()
    picture.wait_until_saved()
    assert lab_points(lab, 3) == 1
    assert [item["author"] for item in lab.annotations() if item["frame"] == 3] == ["Anna"]


def test_a_page_of_the_person_before_cannot_write_as_the_next(
    lab: Lab, open_lab: OpenLab, synthesized: Synthesized
) -> None:
    """Two tabs of one browser: in the second one somebody else logs in."""
    from playwright.sync_api import expect

    page = open_lab()
    picture = annotate(page, lab, 5)
    log_in(page, "Anna")
    picture.wait()
    # Nothing that the page asks by itself may tell it before the gesture that Anna is gone.
    page.route("**/api/v1/**", lambda route: None if route.request.method == "GET" else route.continue_())
    other = page.context.new_page()
    other.goto("/recordings")
    other.get_by_role("button", name="Account of Anna").click()
    other.get_by_role("menuitem", name="Log out").click()
    log_in(other, "Ben")
    expect(other.get_by_role("button", name="Account of Ben")).to_be_visible()
    picture.click(*synthesized.joints[0])
    left = page.evaluate("Object.keys(localStorage).filter((name) => name.startsWith('handloom/unsaved/'))")
    assert len(left) == 1, "the gesture is kept in the browser"
    page.unroute("**/api/v1/**")  # what was held goes on
    dialog = page.get_by_role("dialog")
    expect(dialog).to_be_visible()
    assert lab_points(lab, 5) == 0
    dialog.get_by_role("textbox", name="Password").fill(PASSWORD)
    dialog.get_by_role("button", name="Log in").click()
    expect(dialog).to_have_count(0)
    picture.wait_until_saved()
    assert [item["author"] for item in lab.annotations() if item["frame"] == 5] == ["Anna"]


@pytest.mark.slow
def test_saved_is_said_when_nothing_waits_and_not_before(
    lab: Lab, open_lab: OpenLab, synthesized: Synthesized, screenshots: Screenshots
) -> None:
    """Also of another recording, of key frames, and after a reload and a login."""
    from playwright.sync_api import expect

    with synthesized.archive.open("rb") as file:
        made = lab.send("POST", "/imports", files={"files": ("opening-hand.zip", file)}).json()
    other = lab.send("POST", f"/imports/{made['id']}/confirm", json={"name": "Another"}).json()["id"]
    page = open_lab("Anna")
    picture = annotate(page, lab, 8)
    picture.wait()
    state = page.get_by_test_id("save-state")
    held: list[Any] = []
    page.route("**/annotations/cam0/8/right*", lambda route: held.append(route))
    picture.click(*synthesized.joints[0])
    expect(state).to_have_text("saving …")
    page.reload()
    picture.wait()
    expect(state).to_have_text("saving …")
    page.goto(f"/recordings/{other}/annotate?frame=2")
    picture.wait()
    expect(state).to_have_text("saved here, 1 waiting elsewhere")
    screenshots.take(page, "saved-here-dark-1280")
    page.evaluate("fetch('/api/v1/logout', { method: 'POST' })")
    page.reload()
    log_in(page, "Anna")
    picture.wait()
    expect(state).to_have_text("saved here, 1 waiting elsewhere")
    assert lab_points(lab, 8) == 0
    page.get_by_role("link", name="Open where it waits").click()
    expect(page).to_have_url(re.compile(f"{lab.recording_id}/annotate"))
    page.unroute("**/annotations/cam0/8/right*")
    page.reload()
    picture.wait_until_saved()
    assert lab_points(lab, 8) == 1

    kept: list[Any] = []
    page.route(
        "**/key-frames/cam0/8/right*", lambda route: kept.append(route)
    )  # before the page is loaded: it takes time
    picture = annotate(page, lab, 8)
    picture.wait()
    page.keyboard.press("k")
    expect(state).to_have_text("saving …")
    wait_for_held(page, kept, 1)
    page.reload()
    picture.wait()
    wait_for_held(page, kept, 2)
    expect(state).to_have_text("saving …")
    assert lab.get(f"/sequences/{lab.recording_id}/key-frames")["items"] == []
    page.unroute("**/key-frames/cam0/8/right*")
    page.reload()
    picture.wait_until_saved()
    assert [item["frame"] for item in lab.get(f"/sequences/{lab.recording_id}/key-frames")["items"]] == [8]


def test_logging_out_says_what_waits_and_when_it_did_not_succeed(
    lab: Lab, open_lab: OpenLab, synthesized: Synthesized, screenshots: Screenshots
) -> None:
    from playwright.sync_api import expect

    page = open_lab("Anna")
    picture = annotate(page, lab, 12)
    picture.wait()

    def leave() -> None:
        page.get_by_role("button", name="Account of Anna").click()
        page.get_by_role("menuitem", name="Log out").click()

    # Without a network nobody is logged out, and the page stays.
    page.context.set_offline(True)
    leave()
    expect(page.get_by_role("alert").filter(has_text="You are still logged in")).to_be_visible()
    expect(picture.element).to_be_visible()
    screenshots.take(page, "still-logged-in-dark-1280")
    page.context.set_offline(False)

    held: list[Any] = []
    page.route("**/annotations/cam0/12/right*", lambda route: held.append(route))
    picture.click(*synthesized.joints[0])
    wait_for_held(page, held, 1)
    leave()
    dialog = page.get_by_role("dialog", name="Log out")
    expect(dialog).to_contain_text("1 change of yours is not on the server yet.")
    screenshots.take(page, "log-out-waits-dark-1280")
    dialog.get_by_role("button", name="Stay").click()
    expect(dialog).to_have_count(0)
    leave()
    dialog.get_by_role("button", name="Log out anyway").click()
    log_in(page, "Anna")
    page.unroute("**/annotations/cam0/12/right*")
    page.goto(f"/recordings/{lab.recording_id}/annotate?frame=12")
    picture.wait_until_saved()
    assert lab_points(lab, 12) == 1

    # With everything saved nothing is asked.
    leave()
    page.get_by_role("button", name="Log in").wait_for()


@pytest.mark.slow
def test_two_people_see_each_other_and_what_the_other_does_as_it_is_stored(
    lab: Lab, open_lab: OpenLab, synthesized: Synthesized, screenshots: Screenshots
) -> None:
    from playwright.sync_api import expect

    hers, his = open_lab("Anna"), open_lab("Ben", "light", 1920, 1080)
    ann, ben = annotate(hers, lab, 10), annotate(his, lab, 11)
    ann.wait()
    ben.wait()
    here = hers.get_by_role("group", name="Also here")
    expect(here).to_have_text("BBen at 11")
    expect(his.get_by_role("group", name="Also here")).to_have_text("AAnna at 10")
    his.keyboard.press("d")
    expect(here).to_have_text("BBen at 10")
    ben.wait()

    # How long from the answer to his save until it is in her page.
    hers.evaluate(
        """() => {
            window.seen = null;
            const look = () => { if (/1\\/21/.test(document.body.innerText)) window.seen ??= Date.now(); };
            new MutationObserver(look).observe(document.body, { childList: true, subtree: true, characterData: true });
        }"""
    )
    with his.expect_response(lambda answer: answer.request.method == "PUT" and "/annotations/" in answer.url) as saved:
        ben.click(*synthesized.joints[0])
    assert saved.value.ok
    stored = his.evaluate("Date.now()")
    hers.wait_for_function("() => window.seen !== null")
    late = hers.evaluate("window.seen") - stored
    log.info("Shown %d ms after it was acknowledged.", late)
    assert late < 1000 * (1 + max(0.0, os.getloadavg()[0] - (os.cpu_count() or 1)))
    expect(hers.get_by_label("Frame", exact=True)).to_have_value("10")
    screenshots.take(hers, "live-dark-1280")
    screenshots.take(his, "live-light-1920")

    # The history that she has open follows too.
    hers.get_by_role("tab", name="History").click()
    versions = hers.get_by_role("list", name="Versions, newest first").get_by_role("listitem")
    expect(versions).to_have_count(1)
    ben.click(5, 5)
    expect(versions).to_have_count(2)
    wrong = hers.get_by_text("On the background")
    expect(wrong).to_be_visible()
    his.keyboard.press("Control+z")
    expect(versions).to_have_count(3)
    expect(wrong).to_have_count(0)
    hers.get_by_role("tab", name="Joints").click()

    # She has something unsaved of that hand: hers stays, and she chooses.
    held: list[Any] = []
    hers.route(
        "**/annotations/cam0/10/right*",
        lambda route: held.append(route) if route.request.method == "PUT" else route.continue_(),
    )
    ann.click(*synthesized.joints[1])
    expect(hers.get_by_test_id("save-state")).to_have_text("saving …")
    ben.click(*synthesized.joints[2])
    ben.wait_until_saved()
    hers.unroute("**/annotations/cam0/10/right*")  # what was held goes on
    card = hers.get_by_role("group", name="Two versions")
    expect(card).to_contain_text("Ben changed the right hand of frame 10")
    card.get_by_role("button", name="Keep mine").click()
    ann.wait_until_saved()
    assert [item["author"] for item in lab.annotations() if item["frame"] == 10] == ["Anna"]
    his.close()
    expect(here).to_have_count(0)


def test_people_are_added_by_link_and_shut_out(lab: Lab, open_lab: OpenLab, screenshots: Screenshots) -> None:
    from playwright.sync_api import expect

    page = open_lab("Lea")
    page.goto("/people")
    page.get_by_label("Name", exact=True).fill("Mia")
    page.get_by_role("button", name="Add person").click()
    link = page.get_by_test_id("secret").inner_text()
    screenshots.take(page, "people-dark-1280")
    hers = open_lab(scheme="light")
    hers.goto(link)
    hers.get_by_label("New password").fill("my own four words")
    hers.get_by_label("Again").fill("my own four words")
    screenshots.take(hers, "login-code-light-1280")
    hers.get_by_role("button", name="Set password and log in").click()
    expect(hers.get_by_role("button", name="Account of Mia")).to_be_visible()
    assert "code" not in hers.url
    hers.goto("/account")
    hers.get_by_label("What it is for").fill("nightly export")
    hers.get_by_role("button", name="Make token").click()
    token = hers.get_by_test_id("secret").inner_text()
    screenshots.take(hers, "account-light-1280")
    answer = httpx.get(f"{lab.url}/api/v1/account", headers={"Authorization": f"Bearer {token}"})
    assert answer.json()["name"] == "Mia"
    page.reload()
    page.get_by_role("button", name="Disable Mia").click()
    expect(page.get_by_test_id("person-Mia")).to_contain_text("disabled")
    hers.goto("/recordings")
    expect(hers.get_by_role("button", name="Log in")).to_be_visible()
    page.get_by_test_id("person-Mia").get_by_role("link", name="Acts").click()
    expect(page.get_by_role("heading", name="Audit trail")).to_be_visible()
    expect(page.get_by_role("cell", name="token · add")).to_be_visible()
    screenshots.take(page, "audit-dark-1280")
