"""The kinds of things that are put into the bin: how each is shown, brought back and deleted for good."""

from __future__ import annotations

import uuid
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from sqlalchemy import SQLColumnExpression
from sqlalchemy.orm import Session

from server.access.audit import record_act
from server.access.models import Account
from server.access.project_models import ProjectRow, ReplicaSetRow
from server.calibrations.models import CalibrationRow
from server.calibrations.storing import AREA as CALIBRATION_AREA
from server.database import Base
from server.detectors.models import DetectorRow
from server.detectors.service import AREA as DETECTOR_AREA
from server.hand_models.models import HandModelRow
from server.hand_models.service import AREA as HAND_MODEL_AREA
from server.moving_scans.adding import AREA as MOVING_SCAN_AREA
from server.moving_scans.models import MovingScanRow
from server.scans.models import ScanRow
from server.scans.service import AREA as SCAN_AREA
from server.sequences.models import SequenceRow
from server.sequences.service import AREA as RECORDING_AREA
from server.teams import projects, replicas
from server.tracks.models import TrackRow
from server.tracks.service import AREA as TRACK_AREA


@dataclass(frozen=True)
class BinKind:
    """A kind of thing that is put into the bin instead of being destroyed.

    Attributes:
        kind: As the audit trail calls it, such as `scan`.
        word: For people, such as `hand model`.
        row: Its table, with `id` and `name`.
        deleted_at: Column with the time when it was deleted; None is not.
        restore: Brings it back; given its id and who wants it.
        parent: Kind of the thing that it is part of, and the column with the id of that one.
        area: Where its files lie; what has none of its own cannot be deleted for good.
    """

    kind: str
    word: str
    row: Any
    deleted_at: SQLColumnExpression[Any]
    restore: Callable[[Session, Account, uuid.UUID], object]
    parent: tuple[str, SQLColumnExpression[uuid.UUID]] | None = None
    area: str | None = None


def make_kind(
    kind: str,
    word: str,
    row: type[Base],
    area: str,
    parent: tuple[str, SQLColumnExpression[uuid.UUID]] | None = None,
) -> BinKind:
    """A thing with files of its own, which is back as soon as its row no longer says when it was deleted."""

    def restore(session: Session, account: Account, id_: uuid.UUID) -> None:
        found: Any = session.get_one(row, id_)
        found.deleted_at = None
        session.flush()
        record_act(session, account.id, f"{kind}.restore", kind, id_)

    return BinKind(kind, word, row, row.deleted_at, restore, parent, area)  # pyright: ignore[reportAttributeAccessIssue]


BIN_KINDS: tuple[BinKind, ...] = (
    make_kind("recording", "recording", SequenceRow, RECORDING_AREA),
    make_kind("track", "track", TrackRow, TRACK_AREA, ("recording", TrackRow.sequence_id)),
    make_kind("scan", "scan", ScanRow, SCAN_AREA),
    make_kind("moving_scan", "moving scan", MovingScanRow, MOVING_SCAN_AREA),
    make_kind("hand_model", "hand model", HandModelRow, HAND_MODEL_AREA),
    make_kind("detector", "fingertip detector", DetectorRow, DETECTOR_AREA),
    make_kind("calibration", "camera calibration", CalibrationRow, CALIBRATION_AREA),
    BinKind(
        kind="project",
        word="project",
        row=ProjectRow,
        deleted_at=ProjectRow.archived_at,
        restore=lambda session, account, id_: projects.archive_project(session, account, id_, is_archived=False),
    ),
    BinKind(
        kind="replica_set",
        word="blind replica",
        row=ReplicaSetRow,
        deleted_at=ReplicaSetRow.deleted_at,
        restore=lambda session, account, id_: replicas.withdraw_replica_set(
            session, account, replicas.get_replica_set(session, id_, hold=True, deleted_too=True), is_withdrawn=False
        ),
        parent=("project", ReplicaSetRow.project_id),
    ),
)
"""In the order in which a message lists them."""
