"""A real studio (server, worker, database) and a real Chromium that looks at it."""

from __future__ import annotations

import json
import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import time
import zipfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import httpx
import pytest

from tests.once import make_once

ROOT = Path(__file__).resolve().parents[2]
CHROMIUM_NAMES = ("chromium", "chromium-browser", "google-chrome-stable", "google-chrome")
CHROMIUM_FLAGS = (
    "--no-sandbox",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-gpu-rasterization",
    "--disable-gpu-compositing",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--no-first-run",
    "--disable-quic",
)
FRAMES = 16


def _lacking(message: str) -> None:
    """Somebody's machine may lack a browser; the one that decides must not."""
    if os.environ.get("CI", "").lower() in ("1", "true"):
        pytest.fail(message)
    pytest.skip(message)


@pytest.fixture(scope="session")
def chromium() -> str:
    """Path of a Chromium; without one these tests are skipped, and fail in CI."""
    found = next((path for name in CHROMIUM_NAMES if (path := shutil.which(name))), None)
    if found is None:
        _lacking("No Chromium found: install the package `chromium` to run the browser tests.")
    assert found is not None
    return found


@dataclass(frozen=True)
class Studio:
    """A served studio."""

    url: str
    data_dir: Path
    log: Path

    def get(self, path: str) -> Any:
        answer = httpx.get(f"{self.url}/api/v1{path}", timeout=60)
        answer.raise_for_status()
        return answer.json()

    def send(self, method: str, path: str, **options: Any) -> httpx.Response:
        return httpx.request(method, f"{self.url}/api/v1{path}", timeout=60, **options)


@pytest.fixture(scope="session")
def studio(chromium: str, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Studio]:
    """`handloom serve` with its worker, on an empty data folder."""
    if not (ROOT / "web" / "dist" / "index.html").is_file():
        _lacking("The browser app is not built: run `make setup` first.")
    folder = tmp_path_factory.mktemp("studio")
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    log = folder / "studio.log"
    environment = os.environ | {"HANDLOOM_DATA_DIR": str(folder / "data")}
    with log.open("w") as output:
        process = subprocess.Popen(
            [sys.executable, "-m", "server.cli", "serve", "--port", str(port)],
            cwd=ROOT,
            env=environment,
            stdout=output,
            stderr=subprocess.STDOUT,
        )
    studio = Studio(f"http://127.0.0.1:{port}", folder / "data", log)
    try:
        _wait_until_up(studio, process)
        yield studio
    finally:
        process.send_signal(signal.SIGTERM)
        try:
            process.wait(20)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()


def _wait_until_up(studio: Studio, process: subprocess.Popen[bytes], seconds: float = 90) -> None:
    deadline = time.monotonic() + seconds
    while time.monotonic() < deadline:
        if process.poll() is not None:
            pytest.fail(f"The studio ended with code {process.returncode}:\n{studio.log.read_text()[-4000:]}")
        try:
            if httpx.get(f"{studio.url}/api/v1/health", timeout=5).is_success:
                return
        except httpx.HTTPError:
            time.sleep(0.2)
    pytest.fail(f"The studio was not up after {seconds:g} s:\n{studio.log.read_text()[-4000:]}")


@dataclass(frozen=True)
class Synthesized:
    """A recording that nobody has annotated, and what somebody would mark in its first frame."""

    folder: Path
    archive: Path
    joints: list[tuple[float, float]]
    """px in frame 0, in the order of the joints."""


@pytest.fixture(scope="session")
def synthesized(tmp_path_factory: pytest.TempPathFactory) -> Synthesized:
    """Made by the product itself, once for all processes of a run."""
    folder = make_once(tmp_path_factory, "synthesized", _synthesize) / "opening-hand"
    archive, marks = folder.with_suffix(".zip"), folder.with_suffix(".json")
    return Synthesized(folder, archive, [(x, y) for x, y, _ in json.loads(marks.read_text())])


def _synthesize(where: Path) -> None:
    """Without its annotations, for they are to be made in the browser; those of frame 0 lie beside it."""
    folder = where / "opening-hand"
    command = ["synthesize", "--motion", "open-close", "--frames", f"0:{FRAMES}", "--out", str(folder)]
    subprocess.run([sys.executable, "-m", "server.cli", *command], cwd=ROOT, check=True, capture_output=True)
    first = next(i for i in json.loads((folder / "annotations.json").read_text())["items"] if i["frame"] == 0)
    description = json.loads((folder / "sequence.json").read_text())
    description.pop("annotations", None)
    (folder / "sequence.json").write_text(json.dumps(description))
    (folder / "annotations.json").unlink()
    with zipfile.ZipFile(folder.with_suffix(".zip"), "w", zipfile.ZIP_STORED) as file:
        for path in sorted(folder.rglob("*")):
            if path.is_file() and path.parts[-2] != "models":
                file.write(path, path.relative_to(where))
    folder.with_suffix(".json").write_text(json.dumps(first["points"]))


def import_copy(studio: Studio, synthesized: Synthesized) -> dict[str, Any]:
    """A fresh copy of the recording in the studio, imported through the API."""
    with synthesized.archive.open("rb") as file:
        made = studio.send("POST", "/imports", files={"files": ("opening-hand.zip", file)})
    made.raise_for_status()
    assert made.json()["state"] == "checked", made.json()["report"]["problems"]
    stored = studio.send("POST", f"/imports/{made.json()['id']}/confirm", json={"name": "Opening hand"})
    stored.raise_for_status()
    return stored.json()


@pytest.fixture
def recording(studio: Studio, synthesized: Synthesized) -> dict[str, Any]:
    """A recording that no other test has seen."""
    return import_copy(studio, synthesized)


@pytest.fixture(scope="session")
def playwright() -> Iterator[Any]:
    """One for all browsers: Playwright refuses to be started twice in a process."""
    from playwright.sync_api import expect, sync_playwright

    expect.set_options(timeout=20_000)  # a small machine renders and tracks at the same time
    with sync_playwright() as started:
        yield started


@pytest.fixture(scope="session")
def browser(playwright: Any, chromium: str) -> Iterator[Any]:
    launched = playwright.chromium.launch(executable_path=chromium, args=list(CHROMIUM_FLAGS))
    yield launched
    launched.close()


@dataclass
class Screenshots:
    """Pictures for people to look at, in the folder that HANDLOOM_SCREENSHOTS names."""

    folder: Path | None = field(
        default_factory=lambda: Path(found) if (found := os.environ.get("HANDLOOM_SCREENSHOTS")) else None
    )

    def take(self, page: Any, name: str) -> None:
        if self.folder is not None:
            self.folder.mkdir(parents=True, exist_ok=True)
            page.screenshot(path=self.folder / f"{name}.png")


@pytest.fixture(scope="session")
def screenshots() -> Screenshots:
    return Screenshots()


OpenPage = Callable[..., Any]


@pytest.fixture
def open_page(browser: Any, studio: Studio) -> Iterator[OpenPage]:
    """Opens a page of the studio; fails the test if any of them threw an error."""
    contexts: list[Any] = []
    errors: list[str] = []

    def note(error: Any) -> None:
        # The 3D viewer's own code tries `eval` and goes on without it, as its policy says it should.
        if "unsafe-eval" not in str(error):
            errors.append(str(error))

    def opened(width: int = 1280, height: int = 720, scheme: str = "dark", is_phone: bool = False) -> Any:
        context = browser.new_context(
            viewport={"width": width, "height": height},
            base_url=studio.url,
            locale="en-GB",
            has_touch=is_phone,
            is_mobile=is_phone,
        )
        context.set_default_timeout(30_000)
        context.add_init_script(f"localStorage.setItem('handloom/colours', '{scheme}')")
        contexts.append(context)
        page = context.new_page()
        page.on("pageerror", note)
        return page

    yield opened
    for context in contexts:
        context.close()
    assert not errors, errors


@dataclass(frozen=True)
class Picture:
    """The annotator's picture, with gestures in image pixels."""

    page: Any
    index: int = 0

    @property
    def element(self) -> Any:
        return self.page.locator("[data-picture]").nth(self.index)

    def wait(self) -> None:
        """Until the image that is wanted is on the screen."""
        self.element.locator("canvas").first.wait_for()
        self.page.wait_for_function(
            """(i) => {
              const pane = document.querySelectorAll('[data-picture]')[i];
              return pane?.getAttribute('aria-busy') === 'false' && pane.dataset.drawn === pane.dataset.frame;
            }""",
            arg=self.index,
        )

    def at(self, x: float, y: float) -> tuple[float, float]:
        """Where an image pixel is in the window; its centre is half a pixel from its corner."""
        box = self.element.bounding_box()
        view = json.loads(self.element.get_attribute("data-view"))
        return box["x"] + view["x"] + view["scale"] * (x + 0.5), box["y"] + view["y"] + view["scale"] * (y + 0.5)

    def click(self, x: float, y: float, **options: Any) -> None:
        self.page.mouse.click(*self.at(x, y), **options)

    def drag(self, start: tuple[float, float], end: tuple[float, float]) -> None:
        self.page.mouse.move(*self.at(*start))
        self.page.mouse.down()
        self.page.mouse.move(*self.at(*end), steps=6)
        self.page.mouse.up()

    def wait_until_saved(self) -> None:
        from playwright.sync_api import expect

        expect(self.page.get_by_test_id("save-state")).to_have_text(re.compile("^saved$"))


@dataclass
class HeldBack:
    """Answers that a page gets only when it is told so: a slow network, without waiting for it."""

    page: Any
    addresses: re.Pattern[str]
    held: list[Any] = field(default_factory=list)
    is_open: bool = False

    def __post_init__(self) -> None:
        self.page.route(self.addresses, lambda route: route.continue_() if self.is_open else self.held.append(route))

    def release(self) -> None:
        self.is_open = True
        while self.held:
            self.held.pop(0).continue_()


def wait_for_held(page: Any, held: list[Any], count: int) -> None:
    """Word of a held request comes later than the page sent it."""
    for _ in range(1500):
        if len(held) >= count:
            return
        page.wait_for_timeout(20)
    is_online = page.evaluate("navigator.onLine")
    raise AssertionError(f"{len(held)} of {count} requests were held; the browser has a network: {is_online}")


LOSE_ANSWERS = """([method, address]) => {
  const send = window.fetch;
  window.unheard = 0;
  window.fetch = (to, init) => init?.method === method && new RegExp(address).test(String(to))
    ? new Promise((_, fail) => void send(to, init).then(() => { window.unheard += 1; }, fail))
    : send(to, init);
}"""


def lose_answers(page: Any, method: str, address: str) -> None:
    """From now on the server gets what the page sends there, and the page never hears of it.

    Done in the page itself: of a request that is held on its way Playwright has told nothing at times.
    """
    page.evaluate(LOSE_ANSWERS, [method, address])


def wait_until_unheard(page: Any, count: int = 1) -> None:
    """Until the server has answered so many of them."""
    page.wait_for_function("(count) => window.unheard === count", arg=count)


@dataclass(frozen=True)
class Fingers:
    """Touches that Playwright has no words for; places are px of the window."""

    page: Any

    def draw(self, *paths: tuple[tuple[float, float], tuple[float, float]], steps: int = 6) -> None:
        """As many fingers as paths, each from one place to another."""
        session = self.page.context.new_cdp_session(self.page)
        for step in range(steps + 1):
            touches = [
                {"x": ax + (bx - ax) * step / steps, "y": ay + (by - ay) * step / steps, "id": number}
                for number, ((ax, ay), (bx, by)) in enumerate(paths)
            ]
            kind = "touchStart" if step == 0 else "touchMove"
            session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": touches})
        session.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
        session.detach()


@pytest.fixture
def picture_of() -> Callable[[Any], Picture]:
    return Picture
