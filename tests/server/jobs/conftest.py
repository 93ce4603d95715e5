"""A recording's row to hang jobs on, and what a worker has to do them."""

from __future__ import annotations

import uuid
from pathlib import Path

import pytest

from server.database import Database
from server.jobs.run import WorkerContext
from server.sequences.models import SequenceRow
from server.storage import Storage


@pytest.fixture
def sequence_id(database: Database) -> uuid.UUID:
    row = SequenceRow(
        name="wave", fps=30.0, frame_count=40, cameras=[], hands=["right"], objects=[], report=None, content_key="x"
    )
    with database.writing() as session:
        session.add(row)
    return row.id


@pytest.fixture
def context(database: Database, tmp_path: Path) -> WorkerContext:
    """What a worker would have, with files of its own."""
    return WorkerContext(database, Storage(tmp_path / "studio"), uuid.uuid4())
