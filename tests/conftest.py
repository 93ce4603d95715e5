"""Fixtures that every test may use."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
from hypothesis import settings

from tracker import find_physics_fault
from tracker.errors import TrackingError

ROOT = Path(__file__).resolve().parents[1]

settings.register_profile("handloom", deadline=None)  # how long an example takes says how busy the machine is
settings.load_profile("handloom")


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
        if str(error) != find_physics_fault():
            raise
        pytest.skip(str(error))


@pytest.fixture
def rng() -> np.random.Generator:
    return np.random.default_rng(0)
