"""Labels from files: what would become of each place is said before, and done as it was said or not at all."""

from __future__ import annotations

import hashlib
import json
import uuid
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from sqlalchemy import select

from server.access.models import Account, AuditRow
from server.access.project_models import AssignmentRow, ProjectRow
from server.annotations.bulk import find_annotations
from server.annotations.models import AnnotationRow
from server.annotations.snapshot_models import SnapshotRow
from server.database import Database
from server.errors import ConflictError, InvalidError
from server.exchange.importing import (
    MAX_TOLD,
    Imported,
    ImportPlan,
    ReadLabels,
    apply_import,
    find_problems,
    plan_import,
    read_files,
    write_check,
)
from server.sequences.models import SequenceRow
from server.storage import Storage
from tests.server.conftest import MakeRecording
from tests.server.exchange.labels import make_points
from tests.server.rows import keep, make_annotation, make_person, make_recording
from tracker import Annotation, Annotations
from tracker.capture import JointSource
from tracker.label_formats import ImportedLabels, ImportHints

FIT = JointSource("fit", "a fit")


@pytest.fixture
def database_kind() -> str:
    return "sqlite"


def make_item(frame: int, points: Any = None, sources: Any = None) -> Annotation:
    return Annotation(frame, "cam0", "right", np.array(make_points() if points is None else points), sources)


@dataclass
class Desk:
    """A recording whose frames 0 and 1 have labels, and whose frame 2 had."""

    database: Database
    storage: Storage
    recording: SequenceRow
    lead: Account

    def read(self, *items: Annotation, problems: tuple[str, ...] = ()) -> ReadLabels:
        found = ImportedLabels({str(self.recording.id): Annotations(items)}, problems)
        return ReadLabels("coco_keypoints", "0" * 64, found)

    def plan(self, labels: ReadLabels) -> ImportPlan:
        with self.database.reading() as session:
            [plan] = plan_import(session, [self.recording], labels, self.lead)
        return plan

    def apply(self, labels: ReadLabels, policy: Any = "replace", check: str | None = None) -> Imported:
        with self.database.writing() as session:
            [done] = apply_import(session, self.storage, [self.recording], labels, self.lead, policy, check)
        return done

    def labels(self) -> dict[int, tuple[int, Any]]:
        with self.database.reading() as session:
            rows = find_annotations(session, self.recording.id)
            return {frame: (row.revision, row.points) for (frame, _, _), row in sorted(rows.items())}

    def lock(self, frame: int) -> None:
        project = ProjectRow(id=uuid.uuid4(), name="Hands")
        work = AssignmentRow(project_id=project.id, sequence_id=self.recording.id, account_id=self.lead.id)
        work.frame_first, work.frame_last, work.state = frame, frame, "accepted"
        keep(self.database, project, work)


@pytest.fixture
def desk(database: Database, tmp_path: Path) -> Desk:
    recording, lead = make_recording(), make_person("lea", "lead")
    rows = [
        make_annotation(recording, n, points) for n, points in ((0, make_points()), (1, make_points(5.0)), (2, None))
    ]
    keep(database, recording, lead, *rows)
    return Desk(database, Storage(tmp_path / "files"), recording, lead)


def test_places_are_new_the_same_in_conflict_or_locked(desk: Desk) -> None:
    desk.lock(4)
    labels = desk.read(*(make_item(frame) for frame in range(5)))
    plan = desk.plan(labels)
    keys = {frame: (frame, "cam0", "right") for frame in range(5)}
    assert (plan.same, list(plan.conflicts), plan.new, plan.locked) == (
        [keys[0]],
        [keys[1]],
        [keys[2], keys[3]],
        [keys[4]],
    )
    assert plan.conflicts[keys[1]].max_shift_px == 5.0
    assert len(plan.reasons) == 1 and "Frame 4 is finished" in plan.reasons[0] and plan.problems == []
    assert plan.revisions == [[*keys[frame], int(frame < 3)] for frame in range(5)]


def test_joints_that_are_written_in_another_way_are_no_conflict(desk: Desk) -> None:
    points = np.array(make_points())
    points[:, 0] += 1e-12
    plan = desk.plan(desk.read(make_item(0, points)))
    assert plan.same == [(0, "cam0", "right")] and plan.conflicts == {} == plan.changes


@pytest.mark.parametrize(("policy", "first", "counts"), [("keep", 5.0, (2, 0, 1)), ("replace", 10.0, (2, 1, 0))])
def test_the_policy_decides_of_places_that_have_other_labels(
    desk: Desk, policy: str, first: float, counts: tuple[int, int, int]
) -> None:
    labels = desk.read(*(make_item(frame) for frame in range(4)))
    done = desk.apply(labels, policy)
    assert (done.added, done.replaced, done.kept) == counts and done.locked == 0
    now = desk.labels()
    assert now[0] == (1, make_points()) and now[1] == (1 + (policy == "replace"), make_points(first))
    assert now[2] == (2, make_points()) and now[3] == (1, make_points())
    assert done.before is not None and done.before.name == "Before an import of coco_keypoints"
    assert done.before.item_count == 2
    with desk.database.reading() as session:
        line = session.scalars(select(AuditRow).where(AuditRow.act == "labels.import")).one()
    assert line.detail | {"added": 2, "replaced": counts[1], "policy": policy, "sha256": "0" * 64} == line.detail


def test_nothing_to_change_makes_no_snapshot_and_no_line(desk: Desk) -> None:
    now = desk.labels()
    for labels, policy in (
        (desk.read(), "replace"),
        (desk.read(make_item(0)), "replace"),
        (desk.read(make_item(1)), "keep"),
    ):
        assert desk.apply(labels, policy).before is None
    assert desk.labels() == now
    with desk.database.reading() as session:
        assert session.scalars(select(SnapshotRow)).all() == [] == session.scalars(select(AuditRow)).all()


def test_joints_say_where_they_came_from_as_the_file_says_or_that_they_were_imported(desk: Desk) -> None:
    absent = make_points()
    absent[20] = [0.0, 0.0, 0]
    desk.apply(desk.read(make_item(3, absent), make_item(4, sources=(FIT, *[None] * 20))))
    with desk.database.reading() as session:
        three, four = session.scalars(
            select(AnnotationRow).where(AnnotationRow.frame > 2).order_by(AnnotationRow.frame)
        )
    assert three.sources == [{"kind": "import", "label": "coco_keypoints"}] * 20 + [None]
    assert four.sources == [{"kind": "fit", "label": "a fit"}] + [None] * 20


def test_one_label_that_cannot_be_stored_refuses_all_of_them(desk: Desk) -> None:
    now = desk.labels()
    with pytest.raises(InvalidError, match=r"Nothing was imported: the right hand in frame 4 .*far outside the image"):
        desk.apply(desk.read(make_item(3), make_item(4, make_points(5000.0))))
    with pytest.raises(InvalidError, match="Nothing was imported: The file is torn"):
        desk.apply(desk.read(make_item(3), problems=("The file is torn.",)))
    assert desk.labels() == now


@pytest.mark.parametrize("many", [MAX_TOLD, MAX_TOLD + 1, MAX_TOLD + 5])
def test_of_many_problems_the_first_are_told_and_the_others_counted(desk: Desk, many: int) -> None:
    labels = desk.read(problems=("The file is torn.",))
    plan = ImportPlan(desk.recording, problems=[f"hand {number}" for number in range(many)])
    told = find_problems(labels, [plan])
    assert told[: MAX_TOLD + 1] == ["The file is torn.", *plan.problems[:MAX_TOLD]]
    further = {0: [], 1: ["1 further hand cannot be stored."], 5: ["5 further hands cannot be stored."]}
    assert told[MAX_TOLD + 1 :] == further[many - MAX_TOLD]


@pytest.mark.parametrize("change", ["labels", "lock", "file"])
def test_what_is_not_as_it_was_looked_at_is_not_imported(desk: Desk, change: str) -> None:
    labels = desk.read(make_item(1), make_item(3))
    check = write_check(labels, [desk.plan(labels)])
    assert check == write_check(labels, [desk.plan(labels)])
    if change == "labels":
        keep(desk.database, make_annotation(desk.recording, 3, make_points(1.0)))
    elif change == "lock":
        desk.lock(3)
    else:
        labels = replace(labels, digest="1" * 64)
    now = desk.labels()
    with pytest.raises(ConflictError, match=r"changed since they were checked; nothing was imported. Look at the new"):
        desk.apply(labels, check=check)
    assert desk.labels() == now
    assert desk.apply(labels, check=write_check(labels, [desk.plan(labels)])).replaced >= 1


def test_a_change_elsewhere_does_not_hinder(desk: Desk) -> None:
    labels = desk.read(make_item(1))
    check = write_check(labels, [desk.plan(labels)])
    keep(desk.database, make_annotation(desk.recording, 7, make_points(1.0)))
    assert desk.apply(labels, check=check).replaced == 1


@pytest.fixture
def put_files(desk: Desk, make_recording: MakeRecording, tmp_path: Path) -> Callable[..., Path]:
    """Writes files of labels beside a recording that has files itself."""
    make_recording().rename(desk.storage.folder("sequences", desk.recording.id))

    def put(**files: Any) -> Path:
        folder = tmp_path / f"labels-{uuid.uuid4()}"
        folder.mkdir()
        for name, document in files.items():
            (folder / f"{name}.json").write_text(json.dumps(document))
        return folder

    return put


def test_the_digest_is_that_of_names_lengths_and_bytes_in_order(desk: Desk, put_files: Callable[..., Path]) -> None:
    document = Annotations((make_item(1),)).to_json()
    folder = put_files(annotations=document)
    read = read_files(desk.storage, folder / "annotations.json", [desk.recording], None, ImportHints())
    data = (folder / "annotations.json").read_bytes()
    assert read.digest == hashlib.sha256(f"annotations.json\0{len(data)}\0".encode() + data).hexdigest()
    assert read.format == "annotations"
    [item] = read.found.annotations[str(desk.recording.id)].items
    assert item.key == (1, "cam0", "right") and item.points.tolist() == make_points()
    again = put_files(annotations=document)
    assert read_files(desk.storage, again, [desk.recording], "annotations", ImportHints()).digest == read.digest
