"""Fixtures that every test may use."""

from __future__ import annotations

import os
import re
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import mkdtemp

import numpy as np
import pytest
from hypothesis import settings

from tracker import find_physics_fault
from tracker.errors import TrackingError

ROOT = Path(__file__).resolve().parents[1]

settings.register_profile("handloom", deadline=None)  # how long an example takes says how busy the machine is
settings.load_profile("handloom")


MEMORY = Path("/dev/shm")
ROOM = 6_000_000_000
"""Bytes that must be free; a container may have far less of memory that looks like a disk."""


@pytest.hookimpl(tryfirst=True)
def pytest_configure(config: pytest.Config) -> None:
    """Files of tests lie in memory where there is room: a studio waits for the disk after every file and every row."""
    if config.option.basetemp or not MEMORY.is_dir() or os.statvfs(MEMORY).f_flag & os.ST_NOEXEC:
        return
    if min(shutil.disk_usage(MEMORY).free, _free_memory()) < ROOM:
        return
    for left in MEMORY.glob("handloom-tests-*"):  # by a run that was killed
        if not Path("/proc", left.name.split("-")[2]).exists():
            shutil.rmtree(left, ignore_errors=True)
    config.option.basetemp = folder = mkdtemp(prefix=f"handloom-tests-{os.getpid()}-", dir=MEMORY)
    config.add_cleanup(lambda: shutil.rmtree(folder, ignore_errors=True))


def _free_memory() -> int:
    """Bytes; none where the system does not say."""
    found = re.search(r"MemAvailable:\s*(\d+) kB", Path("/proc/meminfo").read_text())
    return 1024 * int(found[1]) if found else 0


@pytest.fixture(scope="session")
def shared_data() -> Path:
    """Folder of real recordings beside the project; tests that need it are skipped, with a line, where it is absent."""
    folder = Path(os.environ.get("HANDLOOM_SHARED_DATA", ROOT.parent / "shared" / "data")).resolve()
    if not (folder / "README.md").exists():
        pytest.skip(f"No shared recordings at {folder}; set HANDLOOM_SHARED_DATA to run this test.")
    return folder


@pytest.hookimpl(wrapper=True)
def pytest_runtest_setup(item: pytest.Item) -> Iterator[None]:
    with _skipping_physics():
        return (yield)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item: pytest.Item) -> Iterator[None]:
    with _skipping_physics():
        return (yield)


@contextmanager
def _skipping_physics() -> Iterator[None]:
    """What needs physics is skipped, with a line, where pybullet is not installed (Python 3.12 and newer)."""
    try:
        yield
    except TrackingError as error:
        fault = find_physics_fault()
        if fault is None or not str(error).endswith(fault):
            raise
        pytest.skip(str(error))


@pytest.fixture
def rng() -> np.random.Generator:
    return np.random.default_rng(0)
