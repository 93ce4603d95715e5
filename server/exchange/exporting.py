"""Labels of recordings as a file in a format that others read."""

from __future__ import annotations

import uuid
from collections.abc import Sequence
from dataclasses import dataclass

from server.access.models import Account
from server.annotations.snapshots import get_snapshot
from server.compute import ComputeContext
from server.exchange.label_sets import check_track, keep_visible, open_label_set, read_labels
from server.sequences.service import get_sequence
from tracker.label_formats import LABEL_FORMATS, export_labels, pack_files


@dataclass(frozen=True)
class ExportChoice:
    """What is exported: a format, joints of some sources, labels of now or of a snapshot, joints in 3D of a track."""

    format: str
    source: Sequence[str]
    snapshot_id: uuid.UUID | None = None
    track_id: uuid.UUID | None = None


@dataclass(frozen=True)
class LabelFile:
    """A file of labels.

    Attributes:
        data: Its bytes, a zip where the format has several files.
        items: Hands in images that it holds.
        joints: Joints that it holds.
        notes: What was lost, sentences for people.
    """

    data: bytes
    items: int
    joints: int
    notes: tuple[str, ...]


def export(context: ComputeContext, account: Account, ids: Sequence[uuid.UUID], choice: ExportChoice) -> LabelFile:
    """The labels of recordings that the account may see, in a format."""
    labels = []
    with context.database.reading() as session:
        snapshot = None if choice.snapshot_id is None else get_snapshot(session, choice.snapshot_id)
        for sequence_id in ids:
            row = get_sequence(session, sequence_id)
            if choice.track_id is not None:
                check_track(session, sequence_id, choice.track_id)
            annotations = read_labels(session, context.storage, sequence_id, snapshot)
            labels.append((row, keep_visible(session, account, sequence_id, annotations)))
    sets = [open_label_set(context.storage, row, found, choice.track_id) for row, found in labels]
    made = export_labels(choice.format, sets, choice.source)
    is_packed = LABEL_FORMATS[choice.format].file.endswith(".zip")
    data = pack_files(made.files) if is_packed else next(iter(made.files.values()))
    return LabelFile(data, made.items, made.joints, tuple(made.notes))
