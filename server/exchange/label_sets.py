"""Labels of recordings as the formats take them: of now or of a snapshot, with the joints of a track if asked for."""

from __future__ import annotations

import uuid

import numpy as np
from sqlalchemy.orm import Session

from server.access.models import Account
from server.access.places import Place
from server.access.policy import find_hidden
from server.annotations.service import load_annotations
from server.annotations.snapshot_models import SnapshotRow
from server.annotations.snapshots import read_snapshot
from server.errors import ForbiddenError, InvalidError
from server.sequences.models import SequenceRow
from server.sequences.service import open_sequence
from server.storage import Storage
from server.tracks.service import get_track
from tracker import HAND_JOINTS, Annotations, load_track
from tracker.label_formats import LabelSet, list_image_names


def open_label_set(
    storage: Storage, row: SequenceRow, annotations: Annotations | None = None, track_id: uuid.UUID | None = None
) -> LabelSet:
    """Labels of a recording with what files need to know of it. Reads files: not for inside a transaction."""
    sequence = open_sequence(storage, row.id)
    joints = {}
    if track_id is not None:
        track = load_track(storage.folder("tracks", track_id))
        for side in ("right", "left"):
            names = [f"{side}/{joint}" for joint in HAND_JOINTS]
            if all(name in track.joint_names for name in names):
                columns = [track.joint_names.index(name) for name in names]
                for number, frame in enumerate(track.frame):
                    if str(track.status[number]) != "lost":
                        joints[int(frame), side] = np.asarray(track.joints_3d[number][columns], dtype=np.float64)
    return LabelSet(str(row.id), sequence, list_image_names(sequence), annotations or Annotations(), joints)


def check_track(session: Session, sequence_id: uuid.UUID, track_id: uuid.UUID) -> None:
    """Raise unless the track is one of the recording."""
    if get_track(session, track_id).sequence_id != sequence_id:
        raise InvalidError(f"The track {track_id} is of another recording.")


def read_labels(
    session: Session, storage: Storage, sequence_id: uuid.UUID, snapshot: SnapshotRow | None = None
) -> Annotations:
    """The labels of a recording, of now or of a snapshot."""
    if snapshot is None:
        return load_annotations(session, sequence_id)
    if snapshot.sequence_id != sequence_id:
        raise InvalidError(f"The snapshot {snapshot.name!r} is of another recording.")
    return read_snapshot(storage, snapshot)


def keep_visible(session: Session, account: Account, sequence_id: uuid.UUID, annotations: Annotations) -> Annotations:
    """The labels without those that the account must not see, since it marks the same places blindly itself."""
    hidden = find_hidden(session, account, sequence_id)
    if not hidden:
        return annotations
    kept = []
    for item in annotations.items:
        place = Place(sequence_id, item.camera, item.frame, item.hand)
        if not any(place in places for places in hidden):
            kept.append(item)
    return Annotations(tuple(kept))


def check_sees_all(session: Session, account: Account, sequence_id: uuid.UUID) -> None:
    """Raise when some of the labels are hidden from the account."""
    if find_hidden(session, account, sequence_id):
        raise ForbiddenError(
            "You are marking frames of this recording blind. You will see all its labels when your work is accepted."
        )
