"""How long each stage of a registration takes."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import contextmanager


class StageClock:
    """Seconds by stage.

    Args:
        now: Tells the time, s: `time.thread_time` of the processor, `time.perf_counter` of the wall.
    """

    def __init__(self, now: Callable[[], float]) -> None:
        self.now = now
        self.seconds: dict[str, float] = {}

    @contextmanager
    def measure(self, stage: str):
        began = self.now()
        yield
        self.seconds[stage] = self.seconds.get(stage, 0.0) + self.now() - began
