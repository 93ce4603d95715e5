"""Rows and results as the API gives them."""

from __future__ import annotations

from collections.abc import Sequence

from sqlalchemy.orm import Session

from server.access.service import find_names
from server.annotations.snapshot_models import SnapshotRow
from server.exchange.comparison import HandChange
from server.exchange.importing import Imported, ImportPlan, ReadLabels, find_problems, write_check
from server.exchange.schemas import (
    HandChangeOut,
    LabelComparison,
    LabelImportReport,
    RecordingImport,
    RecordingImported,
    SnapshotOut,
)
from tracker.label_formats import LABEL_FORMATS

MAX_LISTED = 500
MAX_CONFLICTS = 200


def describe_snapshots(session: Session, rows: Sequence[SnapshotRow]) -> list[SnapshotOut]:
    names = find_names(session, [row.created_by for row in rows])
    return [
        SnapshotOut(
            id=row.id,
            sequence_id=row.sequence_id,
            version=row.version,
            name=row.name,
            content_hash=row.content_hash,
            item_count=row.item_count,
            joint_count=row.joint_count,
            created_at=row.created_at,
            author=names.get(row.created_by),
        )
        for row in rows
    ]


def describe_comparison(changes: Sequence[HandChange]) -> LabelComparison:
    shifts = [shift for change in changes for shift in change.joints_moved.values()]
    kinds = [change.kind for change in changes]
    return LabelComparison(
        hands_added=kinds.count("added"),
        hands_removed=kinds.count("removed"),
        hands_changed=kinds.count("changed"),
        joints_added=sum(len(change.joints_added) for change in changes),
        joints_removed=sum(len(change.joints_removed) for change in changes),
        joints_moved=len(shifts),
        joints_restated=sum(len(change.joints_restated) for change in changes),
        mean_shift_px=sum(shifts) / len(shifts) if shifts else None,
        max_shift_px=max(shifts, default=None),
        items=[HandChangeOut.model_validate(change) for change in changes[:MAX_LISTED]],
        is_cut=len(changes) > MAX_LISTED,
    )


def describe_report(labels: ReadLabels, plans: Sequence[ImportPlan]) -> LabelImportReport:
    problems = find_problems(labels, plans)
    return LabelImportReport(
        format=labels.format,
        title=LABEL_FORMATS[labels.format].title,
        problems=problems,
        warnings=list(labels.found.warnings),
        recordings=[
            RecordingImport(
                sequence_id=plan.sequence.id,
                name=plan.sequence.name,
                new=len(plan.new),
                same=len(plan.same),
                conflict_count=len(plan.conflicts),
                conflicts=[HandChangeOut.model_validate(c) for c in list(plan.conflicts.values())[:MAX_CONFLICTS]],
                locked=len(plan.locked),
                reasons=plan.reasons[:20],
            )
            for plan in plans
        ],
        check=None if problems else write_check(labels, plans),
    )


def describe_imported(session: Session, done: Sequence[Imported]) -> list[RecordingImported]:
    return [
        RecordingImported(
            sequence_id=item.sequence.id,
            added=item.added,
            replaced=item.replaced,
            kept=item.kept,
            locked=item.locked,
            before=describe_snapshots(session, [item.before])[0] if item.before else None,
        )
        for item in done
    ]
