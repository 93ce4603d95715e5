"""What a computation finds of the studio, in whichever process it runs."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, TypeVar

from server.database import Database
from server.storage import Storage

Thing = TypeVar("Thing")


@dataclass
class ComputeContext:
    """The studio's database and files, and what computations remember from one question to the next."""

    database: Database
    storage: Storage
    _kept: dict[Callable[..., Any], Any] = field(default_factory=dict)
    _lock: threading.Lock = field(default_factory=threading.Lock)

    def keep(self, make: Callable[[Storage], Thing]) -> Thing:
        """The one thing of this process that `make` makes, when it is first asked for."""
        with self._lock:
            if make not in self._kept:
                self._kept[make] = make(self.storage)
            return self._kept[make]
