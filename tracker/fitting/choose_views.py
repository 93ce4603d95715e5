"""Which of many views look for the hands in a frame."""

from __future__ import annotations

PLENTY = 6
"""With this many views or more, every second one looks for the hands in a frame, the others in the next. Half of them
are still three views of a hand, by which a false joint is outvoted."""


def choose_views(count: int, frame: int) -> range:
    """Which views a hand that is followed is looked for in: of many every other one, in turn."""
    return range(count) if count < PLENTY else range(frame % 2, count, 2)
