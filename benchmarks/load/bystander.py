"""Somebody at the studio's own machine who saves now and then: only their times are the studio's, and nobody else's.

The network between browsers and studio is a program, and so are those who annotate through it: when all come back at
once after an outage their own processes are busy, and a time that they take would be the studio's and theirs together.
"""

from __future__ import annotations

import asyncio
import random
import time
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

import httpx

from server.cli.simulated_annotators import REQUEST_SECONDS, Ledger, SimulatedAnnotator

PAUSE = 0.4
"""Mean time between two of their saves, s: some 700 in five minutes, of which the slowest twentieth are 35."""


async def stand_by(url: str, base: str, frames: range, seconds: float, seed: int) -> Ledger:
    """Save on frames that nobody else works on, from a process of its own; `Ledger.seconds` has the times.

    Args:
        url: Of the studio itself.
        base: Address of the recording's annotations, up to the frame.
        seconds: How long.
    """
    loop = asyncio.get_running_loop()
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as elsewhere:
        return await loop.run_in_executor(elsewhere, _save_for, url, base, frames, seconds, seed)


def _save_for(url: str, base: str, frames: range, seconds: float, seed: int) -> Ledger:
    return asyncio.run(_save(url, base, frames, seconds, seed))


async def _save(url: str, base: str, frames: range, seconds: float, seed: int) -> Ledger:
    ledger = Ledger()
    async with httpx.AsyncClient(base_url=f"{url}/api/v1", timeout=REQUEST_SECONDS) as client:
        person = SimulatedAnnotator(client, base, frames, frames, PAUSE, ledger, random.Random(f"bystander {seed}"))
        await person.work(time.monotonic() + seconds)
    return ledger
