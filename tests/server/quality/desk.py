"""A recording with labels of a drawn hand in a studio's database, and what finds flags in it."""

from __future__ import annotations

import shutil
import uuid
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from server.access.models import LOCAL_ACCOUNT_ID
from server.access.places import Place
from server.annotations.changes import Change, change_annotation
from server.compute import ComputeContext
from server.database import Database
from server.sequences.service import AREA, add_sequence, describe_recording
from server.storage import Storage
from tests.server.quality.drawn_hands import HEIGHT, WIDTH, draw_hand
from tracker import load_sequence

SHARE = 0.25
SIZE = round(SHARE * WIDTH), round(SHARE * HEIGHT)
"""px; small images are quick to write and to read."""


@dataclass(frozen=True)
class Desk:
    """Where labels are made and looked at."""

    context: ComputeContext
    sequence_id: uuid.UUID

    @classmethod
    def open(cls, database: Database, storage: Storage, recording: Path) -> Desk:
        id_ = uuid.uuid4()
        shutil.copytree(recording, storage.folder(AREA, id_))
        columns = describe_recording(load_sequence(storage.folder(AREA, id_)))
        with database.writing() as session:
            add_sequence(session, id_, columns, None, LOCAL_ACCOUNT_ID)
        return cls(ComputeContext(database, storage), id_)

    def place(self, frame: int, hand: str = "right") -> Place:
        return Place(self.sequence_id, "cam0", frame, hand)

    def mark(self, frame: int, pixels: npt.NDArray | None = None, revision: int | None = None) -> None:
        """Label the hand of a frame, as drawn or otherwise."""
        points = np.column_stack([SHARE * draw_hand() if pixels is None else pixels, np.full(21, 2)]).tolist()
        change = Change("put", points, revision, uuid.uuid4(), LOCAL_ACCOUNT_ID)
        with self.context.database.writing() as session:
            change_annotation(session, self.place(frame), change)

    def spoil(self, frame: int, by: float, revision: int | None = None) -> None:
        """Label it with the tip of the index finger so far left of the image, px."""
        pixels = SHARE * draw_hand()
        pixels[8, 0] = -by
        self.mark(frame, pixels, revision)
