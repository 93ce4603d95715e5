"""The name a worker process runs under: the first that no living process on this machine holds.

DBOS gives the unfinished work of a name back to whoever starts under that name. A lock on a file holds the name: the
system lets go of it at the very moment the process dies, however it dies.
"""

from __future__ import annotations

import fcntl
from pathlib import Path
from typing import IO

MAX_WORKERS = 64


class WorkerName:
    """A held name; it lasts as long as this object."""

    def __init__(self, host: str, number: int, lock: IO[str]) -> None:
        self.host, self.name = host, f"{host}-{number}"
        self._lock = lock

    @classmethod
    def acquire(cls, folder: Path, host: str) -> WorkerName:
        """Take the first free name of this machine.

        Args:
            folder: Where the locks are; shared by the workers of one studio on this machine.
            host: Name of this machine. Two with different data folders must not share it.
        """
        folder.mkdir(parents=True, exist_ok=True)
        for number in range(MAX_WORKERS):
            lock = open(folder / f"{host}-{number}.lock", "w")  # noqa: SIM115 (held until the process ends)
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except OSError:
                lock.close()
                continue
            return cls(host, number, lock)
        raise RuntimeError(f"{MAX_WORKERS} workers run on this machine already; stop some of them.")
