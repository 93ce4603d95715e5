"""What tests have computed: functions that another process finds by their name."""

from __future__ import annotations

import os
import sqlite3
import threading
import time
from pathlib import Path

from sqlalchemy import func, select
from sqlalchemy.exc import OperationalError

from server.compute import ComputeContext
from server.database.paging import UnknownCursorError
from server.errors import ConflictError
from server.evaluations.judge import Judge
from server.scans.service import ScanCache
from server.sequences.models import SequenceRow
from tracker.errors import FileError


def tell_process(_context: ComputeContext) -> tuple[int, int]:
    """Its id and its niceness."""
    return os.getpid(), os.nice(0)


def count(context: ComputeContext) -> int:
    """How often it was asked: 1, 2, ..."""
    asked = context.keep(make_list)
    asked.append(1)
    return len(asked)


def make_list(_storage: object) -> list[int]:
    return []


def die_once(_context: ComputeContext, mark: Path) -> int:
    """As if somebody killed the process in the middle of the first question."""
    if not mark.exists():
        mark.touch()
        os.kill(os.getpid(), 9)
    return os.getpid()


def die(_context: ComputeContext) -> None:
    os.kill(os.getpid(), 9)


def sleep(_context: ComputeContext, seconds: float, mark: Path) -> str:
    mark.touch()
    time.sleep(seconds)
    return "slept"


def burn(_context: ComputeContext, seconds: float) -> None:
    """Pure Python without a pause."""
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        pass


def fail(_context: ComputeContext, kind: str) -> None:
    raise make_error(kind)


def make_error(kind: str) -> Exception:
    """Errors whose constructors take something else than a message, and one that nobody can send."""
    if kind == "unsendable":
        error = ValueError("holds a lock")
        error.lock = threading.Lock()  # type: ignore[attr-defined]
        return error
    return {
        "api": ConflictError("somebody was first", headers={"ETag": '"3"'}, current={"revision": 3}),
        "cursor": UnknownCursorError("abc"),
        "tracker": FileError("hand.npz", "nothing", "a hand"),
        "system": FileNotFoundError(2, "No such file", "hand.npz"),
        "database": OperationalError("SELECT 1", {}, sqlite3.OperationalError("database is locked")),
    }[kind]


def count_recordings(context: ComputeContext) -> int:
    """In the studio's database."""
    with context.database.reading() as session:
        return session.scalar(select(func.count()).select_from(SequenceRow)) or 0


def count_verdicts(context: ComputeContext) -> int:
    """Tracks that were judged in the process that answers this."""
    return len(context.keep(Judge)._verdicts)


def count_scans(context: ComputeContext) -> int:
    """Scans that were opened in the process that answers this."""
    return len(context.keep(ScanCache)._scans)
