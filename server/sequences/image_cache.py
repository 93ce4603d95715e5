"""Encoded images in memory, the least recently used leave first."""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Callable, Hashable


class ImageCache:
    """Keeps up to `capacity` bytes. An image is made once, however many ask for it at a time.

    Args:
        capacity: Bytes.
    """

    def __init__(self, capacity: int) -> None:
        self._capacity = capacity
        self._images: OrderedDict[Hashable, bytes] = OrderedDict()
        self._size = 0
        self._lock = threading.Lock()
        self._locks: dict[Hashable, threading.Lock] = {}

    def get(self, key: Hashable, make: Callable[[], bytes]) -> bytes:
        """The image of a key, made when it is not there."""
        with self._lock:
            if (image := self._find(key)) is not None:
                return image
            lock = self._locks.setdefault(key, threading.Lock())
        with lock:
            with self._lock:
                if (image := self._find(key)) is not None:
                    return image
            try:
                image = make()
            finally:
                with self._lock:
                    self._locks.pop(key, None)
            self._keep(key, image)
            return image

    def _find(self, key: Hashable) -> bytes | None:
        image = self._images.get(key)
        if image is not None:
            self._images.move_to_end(key)
        return image

    def _keep(self, key: Hashable, image: bytes) -> None:
        with self._lock:
            if len(image) > self._capacity or key in self._images:
                return
            self._images[key] = image
            self._size += len(image)
            while self._size > self._capacity:
                self._size -= len(self._images.popitem(last=False)[1])
