"""Work on several views of one moment at the same time, where a run has threads."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from typing import TypeVar

T = TypeVar("T")
R = TypeVar("R")

HELPERS = 15
"""Threads beside the one that asks: with it, one for each of sixteen cameras."""


def map_views(work: Callable[[T], R], views: Iterable[T], threads: int) -> list[R]:
    """The work's result for each view, in their order; the same for any number of threads.

    The work is reading, networks, filters, kernels: it lets other threads run meanwhile. The thread that asks works
    too; a helper that is busy elsewhere is not waited for.
    """
    left = deque(enumerate(views))
    found: dict[int, R] = {}

    def take() -> None:
        while left:
            try:
                number, view = left.popleft()
            except IndexError:  # another thread was faster
                return
            found[number] = work(view)

    helpers = [_pool().submit(take) for _ in range(min(threads, HELPERS + 1, len(left)) - 1)]
    try:
        take()
    finally:
        left.clear()
        for helper in helpers:
            if not helper.cancel():
                helper.result()
    return [found[number] for number in range(len(found))]


@cache
def _pool() -> ThreadPoolExecutor:
    return ThreadPoolExecutor(HELPERS, "views")
