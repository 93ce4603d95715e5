"""The cache of encoded images."""

from __future__ import annotations

import threading
import time
from concurrent.futures import ThreadPoolExecutor

import pytest

from server.sequences.image_cache import ImageCache


def test_the_least_recently_used_image_leaves_first() -> None:
    cache, made = ImageCache(100), []

    def get(key: str) -> bytes:
        return cache.get(key, lambda: made.append(key) or key.encode() * 40)

    for key in ("a", "b", "a", "c", "a", "b"):
        get(key)
    assert made == ["a", "b", "c", "b"]


def test_an_image_is_made_once_for_all_who_ask_at_a_time() -> None:
    cache, made, together = ImageCache(1000), [], threading.Barrier(8)

    def make() -> bytes:
        time.sleep(0.02)
        made.append(1)
        return b"image"

    def get(_: int) -> bytes:
        together.wait()
        return cache.get("key", make)

    with ThreadPoolExecutor(8) as pool:
        assert set(pool.map(get, range(8))) == {b"image"}
    assert made == [1]


def test_an_image_that_could_not_be_made_is_tried_again() -> None:
    cache = ImageCache(1000)

    def fail() -> bytes:
        raise OSError("no such file")

    with pytest.raises(OSError, match="no such file"):
        cache.get("key", fail)
    assert cache.get("key", lambda: b"image") == b"image"


def test_an_image_larger_than_the_cache_is_not_kept() -> None:
    cache = ImageCache(3)
    assert cache.get("key", lambda: b"four") == b"four"
    assert cache.get("key", lambda: b"new") == b"new"
