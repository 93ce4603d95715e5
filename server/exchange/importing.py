"""Labels from files into the studio: checked first, then imported, all of them or none."""

from __future__ import annotations

import hashlib
import json
import uuid
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

import numpy as np
from sqlalchemy.orm import Session

from server.access.audit import record_act
from server.access.models import Account
from server.access.places import Place
from server.access.policy import check_change
from server.annotations.bulk import BulkChange, Key, change_annotations, find_annotations
from server.annotations.models import AnnotationRow
from server.annotations.service import check_points
from server.annotations.snapshot_models import SnapshotRow
from server.annotations.snapshots import create_snapshot, hold_sequences
from server.annotations.sources import imported_sources, write_sources
from server.errors import ConflictError, ForbiddenError, InvalidError, NotFoundError
from server.exchange.comparison import HandChange, compare_hands
from server.exchange.label_sets import open_label_set
from server.sequences.models import SequenceRow
from server.storage import Storage
from tracker import Annotation, say_count
from tracker.label_formats import ImportedLabels, ImportHints, import_labels, read_label_files

Policy = Literal["keep", "replace"]
MAX_TOLD = 20


@dataclass(frozen=True)
class ReadLabels:
    """Labels in files.

    Attributes:
        format: Its name.
        digest: Of the files.
        found: What is in them.
    """

    format: str
    digest: str
    found: ImportedLabels


@dataclass
class ImportPlan:
    """What an import would do to one recording.

    Attributes:
        sequence: The recording.
        new: Places that have no labels yet.
        same: Places whose labels are those of the file already.
        conflicts: Places that have others, and how they differ.
        locked: Places that must not be changed now.
        reasons: Why not, in sentences.
        problems: Labels that cannot be stored.
        changes: New points of each place that is new or in conflict.
        sources: Where they came from, as the file says or because they are imported.
        revisions: Of the places in the file, to know whether somebody changed one meanwhile.
    """

    sequence: SequenceRow
    new: list[Key] = field(default_factory=list)
    same: list[Key] = field(default_factory=list)
    conflicts: dict[Key, HandChange] = field(default_factory=dict)
    locked: list[Key] = field(default_factory=list)
    reasons: list[str] = field(default_factory=list)
    problems: list[str] = field(default_factory=list)
    changes: dict[Key, list[Any]] = field(default_factory=dict)
    sources: dict[Key, list[Any]] = field(default_factory=dict)
    revisions: list[list[Any]] = field(default_factory=list)


@dataclass(frozen=True)
class Imported:
    """What an import did to one recording.

    Attributes:
        sequence: The recording.
        added: Places that had no labels.
        replaced: Places that had others.
        kept: Places that have others and kept them.
        locked: Places that must not be changed now.
        before: What undoes it; None when nothing was changed.
    """

    sequence: SequenceRow
    added: int
    replaced: int
    kept: int
    locked: int
    before: SnapshotRow | None


def read_files(
    storage: Storage, path: Path, rows: Sequence[SequenceRow], format_: str | None, hints: ImportHints
) -> ReadLabels:
    """Read a file, a folder or a zip. Takes seconds: not for inside a transaction."""
    files = read_label_files(path)
    digest = hashlib.sha256()
    for name in sorted(files):
        digest.update(f"{name}\0{len(files[name])}\0".encode(errors="surrogateescape") + files[name])
    name, found = import_labels(format_, files, [open_label_set(storage, row) for row in rows], hints)
    return ReadLabels(name, digest.hexdigest(), found)


def plan_import(
    session: Session,
    rows: Sequence[SequenceRow],
    labels: ReadLabels,
    account: Account,
    held: dict[uuid.UUID, dict[Key, AnnotationRow]] | None = None,
) -> list[ImportPlan]:
    """What would happen to each recording."""
    held = held if held is not None else {row.id: find_annotations(session, row.id) for row in rows}
    return [_plan(session, row, labels, account, held[row.id]) for row in rows]


def _plan(
    session: Session,
    sequence: SequenceRow,
    labels: ReadLabels,
    account: Account,
    held: dict[Key, AnnotationRow],
) -> ImportPlan:
    plan = ImportPlan(sequence)
    for item in labels.found.annotations[str(sequence.id)].items:
        key: Key = item.key
        place = Place(sequence.id, item.camera, item.frame, item.hand)
        try:
            points = check_points(sequence, place, item.points.tolist())
        except InvalidError as error:
            plan.problems.append(f"{place}: {error.detail}")
            continue
        row = held.get(key)
        plan.revisions.append([*key, 0 if row is None else row.revision])
        if row is not None and row.points == points:
            plan.same.append(key)
            continue
        try:
            check_change(session, account, place)
        except (ForbiddenError, NotFoundError) as error:
            plan.locked.append(key)
            if error.detail not in plan.reasons:
                plan.reasons.append(error.detail)
            continue
        plan.changes[key] = points
        plan.sources[key] = write_sources(item.sources) or imported_sources(points, labels.format)
        if row is None or row.points is None:
            plan.new.append(key)
            continue
        change = compare_hands(_annotation(key, row.points), item)
        if change is None:  # the same joints, written in another way
            plan.changes.pop(key)
            plan.same.append(key)
        else:
            plan.conflicts[key] = change
    return plan


def _annotation(key: Key, points: list[Any]) -> Annotation:
    return Annotation(*key, np.array(points, dtype=np.float64))


def write_check(labels: ReadLabels, plans: Sequence[ImportPlan]) -> str:
    """Stands for a report: these files, and the labels as they were when it was made."""
    state = [[str(plan.sequence.id), plan.revisions, sorted(plan.locked)] for plan in plans]
    return hashlib.sha256(json.dumps([labels.format, labels.digest, state]).encode()).hexdigest()


def find_problems(labels: ReadLabels, plans: Sequence[ImportPlan]) -> list[str]:
    """Why the files cannot be imported as they are."""
    problems = [*labels.found.problems]
    for plan in plans:
        problems += plan.problems[:MAX_TOLD]
        if len(plan.problems) > MAX_TOLD:
            problems.append(f"{say_count(len(plan.problems) - MAX_TOLD, 'further hand')} cannot be stored.")
    return problems


def apply_import(
    session: Session,
    storage: Storage,
    rows: Sequence[SequenceRow],
    labels: ReadLabels,
    account: Account,
    policy: Policy,
    check: str | None,
) -> list[Imported]:
    """Take the labels in. With `check`, only if everything is as it was when the report of that check was made."""
    hold_sequences(session, [row.id for row in rows])
    held = {row.id: find_annotations(session, row.id, hold=True) for row in rows}
    plans = plan_import(session, rows, labels, account, held)
    if problems := find_problems(labels, plans):
        raise InvalidError("Nothing was imported: " + " ".join(problems))
    if check is not None and check != write_check(labels, plans):
        raise ConflictError(
            "The files or the labels in these places changed since they were checked; nothing was imported. "
            "Look at the new report, then confirm it."
        )
    return [_apply(session, storage, plan, held[plan.sequence.id], labels, account, policy) for plan in plans]


def _apply(
    session: Session,
    storage: Storage,
    plan: ImportPlan,
    held: dict[Key, AnnotationRow],
    labels: ReadLabels,
    account: Account,
    policy: Policy,
) -> Imported:
    keys = [*plan.new, *(plan.conflicts if policy == "replace" else ())]
    before = None
    if keys:
        before, _ = create_snapshot(session, storage, plan.sequence, f"Before an import of {labels.format}", account.id)
        changes = [
            BulkChange(Place(plan.sequence.id, key[1], key[0], key[2]), "import", plan.changes[key], plan.sources[key])
            for key in keys
        ]
        change_annotations(session, held, changes, account.id)
        record_act(
            session,
            account.id,
            "labels.import",
            "sequence",
            plan.sequence.id,
            format=labels.format,
            sha256=labels.digest,
            policy=policy,
            added=len(plan.new),
            replaced=len(keys) - len(plan.new),
        )
    kept = len(plan.conflicts) if policy == "keep" else 0
    return Imported(plan.sequence, len(plan.new), len(keys) - len(plan.new), kept, len(plan.locked), before)
