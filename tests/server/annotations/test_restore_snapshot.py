"""A restored snapshot is the labels again: as new revisions, undone by the snapshot that was made before."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from sqlalchemy import select

from server.access.models import Account, AuditRow
from server.access.policy import LockedError
from server.access.project_models import AssignmentRow, ProjectRow
from server.annotations.bulk import find_annotations
from server.annotations.restore_snapshot import Restored, restore_snapshot
from server.annotations.snapshot_models import SnapshotRow
from server.annotations.snapshots import create_snapshot
from server.database import Database
from server.sequences.models import SequenceRow
from server.storage import Storage
from tests.server.exchange.labels import make_points
from tests.server.rows import keep, make_annotation, make_person, make_recording

FIT = {"kind": "fit", "label": "a fit"}


@pytest.fixture
def database_kind() -> str:
    return "sqlite"


@dataclass
class Desk:
    """A recording whose frames 0, 1 and 2 are in a snapshot; since then 1 has moved, 2 was deleted and 3 was made."""

    database: Database
    storage: Storage
    recording: SequenceRow
    lead: Account
    snapshot: SnapshotRow

    def restore(self, snapshot: SnapshotRow) -> Restored:
        with self.database.writing() as session:
            return restore_snapshot(session, self.storage, self.recording, snapshot, self.lead)

    def labels(self) -> dict[int, tuple[int, Any, Any]]:
        with self.database.reading() as session:
            rows = find_annotations(session, self.recording.id)
            return {frame: (row.revision, row.points, row.sources) for (frame, _, _), row in sorted(rows.items())}


@pytest.fixture
def desk(database: Database, tmp_path: Path) -> Desk:
    storage, recording, lead = Storage(tmp_path / "files"), make_recording(), make_person("lea", "lead")
    rows = [make_annotation(recording, n, make_points(float(n)), sources=[FIT] * 21) for n in range(3)]
    keep(database, recording, lead, *rows)
    with database.writing() as session:
        snapshot, _ = create_snapshot(session, storage, recording, "Good", lead.id)
        held = find_annotations(session, recording.id)
        moved, deleted = held[1, "cam0", "right"], held[2, "cam0", "right"]
        moved.points, moved.sources, moved.revision = make_points(9.0), [None] * 21, 2
        deleted.points, deleted.sources, deleted.revision = None, None, 2
        session.add(make_annotation(recording, 3, make_points(3.0)))
    return Desk(database, storage, recording, lead, snapshot)


def test_only_what_differs_is_written_again_and_what_was_not_in_it_is_deleted(desk: Desk) -> None:
    done = desk.restore(desk.snapshot)
    assert (done.changed, done.deleted) == (2, 1)
    assert desk.labels() == {
        0: (1, make_points(0.0), [FIT] * 21),
        1: (3, make_points(1.0), [FIT] * 21),
        2: (3, make_points(2.0), [FIT] * 21),
        3: (2, None, None),
    }
    with desk.database.reading() as session:
        line = session.scalars(select(AuditRow).where(AuditRow.act == "snapshot.restore")).one()
    assert (line.account_id, line.subject_id, line.detail) == (
        desk.lead.id,
        desk.snapshot.id,
        {"version": 1, "changed": 3},
    )


def test_the_snapshot_made_before_undoes_it(desk: Desk) -> None:
    was = {frame: points for frame, (_, points, _) in desk.labels().items()}
    before = desk.restore(desk.snapshot).before
    assert (before.name, before.version, before.item_count) == ("Before version 1 was restored", 2, 3)
    undone = desk.restore(before)
    assert (undone.changed, undone.deleted) == (2, 1)
    assert {frame: points for frame, (_, points, _) in desk.labels().items()} == was


def test_restoring_what_is_there_already_changes_nothing(desk: Desk) -> None:
    desk.restore(desk.snapshot)
    now = desk.labels()
    again = desk.restore(desk.snapshot)
    assert (again.changed, again.deleted) == (0, 0) and desk.labels() == now
    assert again.before.id == desk.snapshot.id, "the same labels are kept once"


def test_one_place_that_was_accepted_refuses_the_whole(desk: Desk) -> None:
    project, ann = ProjectRow(name="Hands"), make_person("ann")
    keep(desk.database, project, ann)
    work = AssignmentRow(project_id=project.id, sequence_id=desk.recording.id, account_id=ann.id, frame_first=3)
    work.frame_last, work.state = 3, "accepted"
    keep(desk.database, work)
    now = desk.labels()
    with pytest.raises(LockedError, match="Frame 3 is finished"):
        desk.restore(desk.snapshot)
    assert desk.labels() == now
