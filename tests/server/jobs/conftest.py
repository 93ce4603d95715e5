"""A recording's row to hang jobs on."""

from __future__ import annotations

import uuid

import pytest

from server.database import Database
from server.sequences.models import SequenceRow


@pytest.fixture
def sequence_id(database: Database) -> uuid.UUID:
    row = SequenceRow(
        name="wave", fps=30.0, frame_count=40, cameras=[], hands=["right"], objects=[], report=None, content_key="x"
    )
    with database.writing() as session:
        session.add(row)
    return row.id
