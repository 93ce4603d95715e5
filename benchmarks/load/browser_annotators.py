"""People at real browsers: they press V and click at once, whatever the picture does meanwhile."""

from __future__ import annotations

import asyncio
import contextlib
import random
import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from server.cli.bench_server import BITS, HEIGHT, STRIPE, WIDTH

PATIENCE_MS = 30_000
"""So long somebody waits for a page before loading it again."""

PATIENT_PART = 0.6
"""Of the clicks: those made when the picture is there; the others come at once."""

TAKEN_AFTER_MS = 150
"""So long after a click the page has told which joint the next one places; nobody presses anything meanwhile."""

WATCH = """([bits, stripe, takenAfter]) => {
  const shown = (pane, view) => {
    const canvas = pane.querySelector('canvas');
    if (!canvas) return null;
    const ratio = canvas.width / canvas.clientWidth;
    const context = canvas.getContext('2d');
    let frame = 0;
    for (let bit = 0; bit < bits; bit += 1) {
      const x = Math.round(ratio * (view.x + view.scale * stripe * (bit + 0.5)));
      const y = Math.round(ratio * (view.y + view.scale * stripe));
      const [red, , , alpha] = context.getImageData(x, y, 1, 1).data;
      if (alpha === 0) return null;
      frame += (red > 127 ? 1 : 0) << bit;
    }
    return frame;
  };
  const joint = (pane) => /Next click (.*?)\\.?$/.exec(pane.getAttribute('aria-label'))?.[1] ?? '';
  window.handloomGestures = [];
  window.addEventListener('pointerup', (event) => {
    const pane = event.target.closest?.('[data-picture]');
    if (!pane?.dataset.view) return;
    const box = pane.getBoundingClientRect();
    const view = JSON.parse(pane.dataset.view);
    const gesture = {
      frame: shown(pane, view),
      joint: joint(pane),
      x: (event.clientX - box.left - view.x) / view.scale - 0.5,
      y: (event.clientY - box.top - view.y) / view.scale - 0.5,
      is_taken: false,
      at: Date.now() / 1000,
    };
    window.handloomGestures.push(gesture);
    setTimeout(() => (gesture.is_taken = joint(pane) !== gesture.joint), takenAfter);
  }, true);
}"""
"""Notes with every gesture which frame is on the screen at that moment, read from the picture's own pixels."""

WHERE = """(pane) => {
  const box = pane.getBoundingClientRect();
  return [box.x, box.y, JSON.parse(pane.dataset.view)];
}"""

DRAWN = """() => {
  const pane = document.querySelector('[data-picture]');
  return pane && pane.dataset.drawn === pane.dataset.frame;
}"""


@dataclass(frozen=True)
class Gesture:
    """A click on a picture.

    Attributes:
        frame: The one that was on the screen, by its pixels; None where there was no picture.
        joint: What the page said that a click would place; empty when none.
        x, y: Where, px of the picture.
        is_taken: The page went on to the next joint.
        at: When, s since 1970.
    """

    frame: int | None
    joint: str
    x: float
    y: float
    is_taken: bool
    at: float


@dataclass
class BrowserAnnotator:
    """One person at one browser.

    Args:
        page: Of Playwright, without anything open.
        url: Of the recording's annotator.
        frames: Nobody else works on them.
        pause: Mean time between two gestures, s.
    """

    page: Any
    url: str
    frames: Sequence[int]
    pause: float
    chance: random.Random
    gestures: list[Gesture] = field(default_factory=list)
    opened: list[float] = field(default_factory=list)

    async def work(self, until: float) -> None:
        """Annotate until a moment of `time.monotonic`."""
        await self.page.add_init_script(f"({WATCH})({[BITS, STRIPE, TAKEN_AFTER_MS]})")
        frame = self.frames[len(self.frames) // 2]
        is_open = False
        while time.monotonic() < until:
            is_open = is_open or await self._open(frame)
            if not is_open:
                continue
            try:
                frame = await self._go_and_click()
            except Exception as fault:  # the page went away under the network's faults: open it anew
                if not _is_of_the_browser(fault):
                    raise
                await self._collect()
                is_open = False
            await asyncio.sleep(TAKEN_AFTER_MS / 1000 + self.chance.expovariate(1 / self.pause))

    async def _open(self, frame: int) -> bool:
        with contextlib.suppress(Exception):
            await self.page.goto(f"{self.url}?frame={frame}", timeout=PATIENCE_MS, wait_until="domcontentloaded")
            await self.page.locator("[data-picture] canvas").first.wait_for(timeout=PATIENCE_MS)
            self.opened.append(time.time())
            return True
        return False

    async def _go_and_click(self) -> int:
        """Up to twice a key that moves, and a click, at once or on the picture that comes."""
        frame = int(await self.page.get_by_label("Frame", exact=True).input_value(timeout=5000))
        low, high = self.frames[0] + 21, self.frames[-1] - 21
        keys = "vf" if frame < low else "cd" if frame > high else "vcfd"
        pane = self.page.locator("[data-picture]").first
        left, top, view = await pane.evaluate(WHERE, timeout=5000)
        x, y = self._choose_place()
        key = self.chance.choice(keys)
        for _ in range(self.chance.choice((0, 1, 2, 2))):
            await self.page.keyboard.press(key)
        if self.chance.random() < PATIENT_PART:
            await self._wait_for_picture()
        scale = view["scale"]
        await self.page.mouse.click(left + view["x"] + scale * (x + 0.5), top + view["y"] + scale * (y + 0.5))
        return frame

    async def _wait_for_picture(self) -> None:
        with contextlib.suppress(Exception):
            await self.page.wait_for_function(DRAWN, timeout=10_000)

    def _choose_place(self) -> tuple[float, float]:
        """Anywhere below the number."""
        return self.chance.uniform(1, WIDTH - 2), self.chance.uniform(3 * STRIPE, HEIGHT - 2)

    async def _collect(self) -> None:
        with contextlib.suppress(Exception):
            noted = await self.page.evaluate("() => window.handloomGestures.splice(0)")
            self.gestures += [Gesture(**one) for one in noted]

    async def finish(self, seconds: float) -> None:
        """Wait until the page says that everything is saved; one that fell over is opened again first."""
        await self._collect()
        state = self.page.get_by_test_id("save-state")
        deadline = time.monotonic() + seconds
        said = None
        while said != "saved":
            if time.monotonic() > deadline:
                raise TimeoutError(f"A browser says {said!r} {seconds:g} s after the network was mended.")
            if await state.count() == 0:
                await self._open(self.frames[0])
            with contextlib.suppress(Exception):
                said = await state.text_content(timeout=1000)
            await asyncio.sleep(0.5)


def _is_of_the_browser(fault: Exception) -> bool:
    return type(fault).__module__.startswith("playwright")
