"""Work on several views of one moment, two at a time where a run has two threads."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from typing import TypeVar

T = TypeVar("T")
R = TypeVar("R")


def map_views(work: Callable[[T], R], views: Iterable[T], threads: int) -> list[R]:
    """The work's result for each view, in their order; the same for any number of threads.

    The work is reading, networks, filters: it lets other threads run meanwhile.
    """
    return [work(view) for view in views] if threads == 1 else list(_pool().map(work, views))


@cache
def _pool() -> ThreadPoolExecutor:
    return ThreadPoolExecutor(2, "views")
