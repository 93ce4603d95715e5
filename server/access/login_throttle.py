"""Failed logins of the last minutes: who guesses passwords waits.

Kept in the memory of the one web process: a restart forgets them, and takes longer than a guess.
"""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field

from server.errors import TooManyTriesError

WINDOW = 300.0
"""s"""

MAX_BY_NAME_AND_ADDRESS = 5
MAX_BY_NAME = 50
"""From everywhere together. Higher, or anybody could lock somebody else out."""

MAX_BY_ADDRESS = 50
"""A proxy or a lab's router may stand for many people."""

MAX_KEYS = 20_000

Key = tuple[str, str]


@dataclass
class LoginThrottle:
    """Of one studio; used from any thread."""

    now: Callable[[], float] = time.monotonic
    _times: dict[Key, deque[float]] = field(default_factory=dict)
    _lock: threading.Lock = field(default_factory=threading.Lock)

    def begin(self, name: str, address: str) -> None:
        """Count a try as failed before it is known to be (many at once count too); raises when there were too many."""
        with self._lock:
            keys = _keys(name, address)
            wait = max(self._find_wait(key, most) for key, most in keys)
            if wait > 0:
                seconds = int(wait) + 1
                raise TooManyTriesError(
                    f"Too many failed logins. Wait {seconds} s, or ask a lead for a one-time code.",
                    headers={"Retry-After": str(seconds)},
                )
            if len(self._times) > MAX_KEYS:
                self._forget_old()
            for key, most in keys:
                self._times.setdefault(key, deque(maxlen=most)).append(self.now())

    def forget(self, name: str, address: str) -> None:
        """Somebody got in: the failures before were their own slips."""
        with self._lock:
            own, *others = (key for key, _ in _keys(name, address))
            self._times.pop(own, None)
            for key in others:
                if times := self._times.get(key):
                    times.pop()
                    if not times:
                        del self._times[key]

    def _find_wait(self, key: Key, most: int) -> float:
        times = self._times.get(key)
        if times is None or len(times) < most:
            return 0.0
        return times[0] + WINDOW - self.now()

    def _forget_old(self) -> None:
        now = self.now()
        kept = {key: times for key, times in self._times.items() if times[-1] + WINDOW > now}
        # a flood of made-up names: the oldest go
        newest = sorted(kept, key=lambda key: kept[key][-1])[-MAX_KEYS // 2 :]
        self._times = {key: kept[key] for key in newest}


def _keys(name: str, address: str) -> tuple[tuple[Key, int], ...]:
    name = name.casefold()[:200]
    return (
        ((name, address), MAX_BY_NAME_AND_ADDRESS),
        ((name, ""), MAX_BY_NAME),
        (("", address), MAX_BY_ADDRESS),
    )
