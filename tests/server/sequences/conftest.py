"""A shelf to put recordings on."""

from __future__ import annotations

from pathlib import Path

import pytest

from server.database import Database
from server.storage import Storage
from tests.server.sequences.stored import Shelf


@pytest.fixture
def shelf(database: Database, tmp_path: Path) -> Shelf:
    return Shelf(database, Storage(tmp_path / "shelf"))
