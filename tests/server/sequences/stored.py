"""Recordings with files and rows, without an app around them."""

from __future__ import annotations

import shutil
import uuid
from dataclasses import dataclass
from pathlib import Path

from server.access.models import LOCAL_ACCOUNT_ID
from server.database import Database
from server.sequences.models import SequenceRow
from server.sequences.service import AREA, add_sequence, describe_recording
from server.storage import Storage
from tracker import load_sequence


@dataclass(frozen=True)
class Shelf:
    """A database and the files beside it."""

    database: Database
    storage: Storage

    def put(self, folder: Path, **columns: object) -> SequenceRow:
        """The row of a recording whose folder is copied into its place."""
        id_ = uuid.uuid4()
        shutil.copytree(folder, self.storage.folder(AREA, id_))
        described = describe_recording(load_sequence(self.storage.folder(AREA, id_))) | columns
        with self.database.writing() as session:
            return add_sequence(session, id_, described, None, LOCAL_ACCOUNT_ID)
