"""People at browsers in a process of its own, as on computers of their own: what they do costs the studio no time."""

from __future__ import annotations

import asyncio
import os
import random
import shutil
import time
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
from multiprocessing import get_context

from benchmarks.load.browser_annotators import BrowserAnnotator, Gesture

CALM_SECONDS = 150.0
"""So long the browsers have to save everything once their people stop."""


@dataclass(frozen=True)
class Seen:
    """What the people at browsers did.

    Attributes:
        gestures: Every click on a picture.
        opened: A sentence for each time that somebody had to open the page.
    """

    gestures: list[Gesture] = field(default_factory=list)
    opened: list[str] = field(default_factory=list)


async def sit_elsewhere(url: str, frames: range, of_one: int, seconds: float, seed: int) -> Seen:
    """Have one person annotate at a browser for every `of_one` frames.

    The process and its browsers have the lowest priority: they take what the studio leaves of the processors.

    Args:
        url: Of the recording's annotator.
        frames: All that they work on; none: nobody sits there.
        seconds: How long they annotate.
    """
    if not frames:
        return Seen()
    loop = asyncio.get_running_loop()
    with ProcessPoolExecutor(1, mp_context=get_context("spawn"), initializer=_be_modest) as elsewhere:
        return await loop.run_in_executor(elsewhere, _sit, url, frames, of_one, seconds, seed)


def _be_modest() -> None:
    os.sched_setscheduler(0, os.SCHED_IDLE, os.sched_param(0))


def _sit(url: str, frames: range, of_one: int, seconds: float, seed: int) -> Seen:
    return asyncio.run(_annotate(url, frames, of_one, seconds, seed))


async def _annotate(url: str, frames: range, of_one: int, seconds: float, seed: int) -> Seen:
    from playwright.async_api import async_playwright

    chance = random.Random(seed)
    async with async_playwright() as playwright:
        browser = await playwright.chromium.launch(
            executable_path=shutil.which("chromium"), args=["--no-sandbox", "--disable-gpu"]
        )
        people = []
        for first in range(frames.start, frames.stop, of_one):
            context = await browser.new_context(viewport={"width": 1280, "height": 720}, locale="en-GB")
            own = range(first, first + of_one)
            people.append(BrowserAnnotator(await context.new_page(), url, own, 1.0, random.Random(chance.random())))
        until = time.monotonic() + seconds
        await asyncio.gather(*(person.work(until) for person in people))
        await asyncio.gather(*(person.finish(CALM_SECONDS) for person in people))
        await browser.close()
    opened = [
        f"{at:.1f} a browser at frames from {person.frames[0]} opened" for person in people for at in person.opened
    ]
    return Seen([gesture for person in people for gesture in person.gestures], opened)
