"""Views are worked on by several threads, each once, and the first fault is told when nobody works any more."""

from __future__ import annotations

import threading
from concurrent.futures import ThreadPoolExecutor
from time import sleep

import pytest

from tracker.fitting.map_views import map_views


@pytest.mark.parametrize("threads", [1, 2, 5])
@pytest.mark.parametrize("count", [0, 1, 2, 16])
def test_every_view_is_worked_on_once_and_the_results_are_in_their_order(threads, count):
    asked: list[int] = []

    def square(number: int) -> int:
        asked.append(number)
        sleep(0.001 * (number % 3))
        return number**2

    assert map_views(square, range(count), threads) == [number**2 for number in range(count)]
    assert sorted(asked) == list(range(count))


def test_two_threads_work_at_the_same_time_and_one_thread_is_the_one_that_asks():
    both = threading.Barrier(2, timeout=5.0)
    assert len({*map_views(lambda _: (both.wait(), threading.get_ident())[1], range(2), 2)}) == 2
    assert map_views(lambda _: threading.get_ident(), range(3), 1) == [threading.get_ident()] * 3


def test_a_fault_is_told_after_all_threads_have_stopped():
    working, done = threading.Event(), threading.Event()

    def fail(number: int) -> None:
        if number == 0:
            working.wait(5.0)
            raise ValueError("view 0")
        working.set()
        sleep(0.05)
        done.set()

    with pytest.raises(ValueError, match="view 0"):
        map_views(fail, range(2), 2)
    assert done.is_set()


def test_many_may_ask_at_once():
    with ThreadPoolExecutor(8) as pool:
        found = list(pool.map(lambda k: map_views(lambda view: view * k, range(16), 2), range(40)))
    assert found == [[view * k for view in range(16)] for k in range(40)]
