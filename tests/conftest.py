"""Fixtures that every test may use."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest
from hypothesis import settings

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


@pytest.fixture
def rng() -> np.random.Generator:
    return np.random.default_rng(0)
