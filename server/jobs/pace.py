"""How long the rest of a progress bar takes."""

from __future__ import annotations

import time
from collections.abc import Callable

LEAST_SHARE, LEAST_SECONDS = 0.03, 3.0
"""Of the bar that has gone by, and of time, before anything is said."""


class Pace:
    """Judges by how far the bar has come since it was first looked at."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._first: tuple[float, float] | None = None

    def estimate(self, progress: float) -> float | None:
        """Seconds until the bar is full; None while too little of it has gone by to tell.

        Args:
            progress: Share of the bar that is full, 0 to 1; shares of a bar take about as long as each other.
        """
        now = self._clock()
        if self._first is None:
            self._first = progress, now
        share, seconds = progress - self._first[0], now - self._first[1]
        if share < LEAST_SHARE or seconds < LEAST_SECONDS:
            return None
        return (1.0 - progress) * seconds / share
