"""How long the rest of a progress bar takes."""

from __future__ import annotations

import math
import time
from collections import deque
from collections.abc import Callable
from uuid import UUID

LEAST_SHARE, LEAST_SECONDS = 0.03, 3.0
"""Of the bar that has gone by, and of time, before anything is said."""

WINDOW_SECONDS, WINDOW_SHARE = 20.0, 0.3
"""The pace is that of this many last seconds, or of this share of the time so far, whichever is longer."""

SETTLING_SECONDS = 15.0
"""Of the difference between what was said before and what is found now, two thirds are made up in this time."""

LARGEST_RISE = 1.1
"""What is said never grows by more than this factor from one time to the next."""

SAMPLE_SECONDS = 0.5


class Pace:
    """Judges by how far the bar has come lately. What it says runs down evenly: it does not leap, as stages change."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._samples: deque[tuple[float, float]] = deque()
        self._first: tuple[float, float] | None = None
        self._said: tuple[float, float] | None = None

    def estimate(self, progress: float) -> float | None:
        """Seconds until the bar is full; None while too little of it has gone by to tell.

        Args:
            progress: Share of the bar that is full, 0 to 1; shares of a bar take about as long as each other. One
                that is lower than before counts as that.
        """
        now = self._clock()
        if self._first is None:
            self._first = now, progress
            self._samples.append(self._first)
        progress = max(progress, self._samples[-1][1])
        began, first = self._first
        if now - self._samples[-1][0] >= SAMPLE_SECONDS:
            self._samples.append((now, progress))
        window = max(WINDOW_SECONDS, WINDOW_SHARE * (now - began))
        while len(self._samples) > 2 and now - self._samples[1][0] >= window:
            self._samples.popleft()
        if progress >= 1.0:
            return 0.0
        if self._said is None and (progress - first < LEAST_SHARE or now - began < LEAST_SECONDS):
            return None
        earlier, before = self._samples[0]
        gone = progress - before
        found = (1.0 - progress) * (now - earlier) / gone if gone > 0.0 else math.inf
        seconds = found if self._said is None else self._follow(found, now)
        self._said = now, seconds
        return seconds

    def _follow(self, found: float, now: float) -> float:
        """What is said next: what was said less the time since, drawn towards what is found."""
        assert self._said is not None
        before, said = self._said
        left = max(0.0, said - (now - before))
        drawn = left + (min(found, 1e9) - left) * (1.0 - math.exp(-(now - before) / SETTLING_SECONDS))
        return min(drawn, LARGEST_RISE * said)


MOST_PACES = 4


class Paces:
    """The paces of the jobs that this worker does, across their steps."""

    def __init__(self) -> None:
        self._paces: dict[tuple[UUID, int], Pace] = {}

    def find(self, job_id: UUID, attempt: int) -> Pace:
        """Of one attempt of a job; those of the last few are kept."""
        pace = self._paces.pop((job_id, attempt), None) or Pace()
        self._paces[job_id, attempt] = pace
        for oldest in list(self._paces)[:-MOST_PACES]:
            self._paces.pop(oldest, None)
        return pace
