"""The cameras a recording folder had before they were changed: `cameras_before.json`, newest last."""

from __future__ import annotations

import json
from collections.abc import Sequence as Many
from dataclasses import replace
from pathlib import Path
from typing import Any

from tracker.capture.atomic_file import write_atomically
from tracker.capture.camera import Camera
from tracker.capture.document import Node, load_json
from tracker.capture.recorded_camera import RecordedCamera, parse_camera
from tracker.capture.sequence import MAX_DOCUMENT_BYTES, Sequence, save_sequence_json
from tracker.errors import SequenceError

KEPT_FILE = "cameras_before.json"

MAX_CHANGES = 100
"""That are kept: the file of a recording with 64 cameras stays below the 8 MiB that are read of a document."""


def change_cameras(sequence: Sequence, cameras: Many[Camera], why: str) -> Sequence:
    """Give a recording other cameras, the same images; those it had are kept beside it.

    Args:
        sequence: As it is on the disk.
        cameras: As many, with the same ids in the same order.
        why: For people who read the file.
    """
    assert [camera.id for camera in cameras] == [camera.id for camera in sequence.cameras]
    changed = replace(sequence, cameras=give_places(sequence.cameras, cameras))
    entry = {"why": why, "cameras": [camera.to_json() for camera in sequence.cameras]}
    # First what was: whoever stops between the two has a copy too many, and no camera lost.
    _write(sequence.folder, [*(item.value for item in _read(sequence.folder)), entry])
    save_sequence_json(changed)
    return changed


def put_cameras_back(sequence: Sequence) -> Sequence:
    """Give a recording the cameras it had before the last change, which is forgotten."""
    path = sequence.folder / KEPT_FILE
    kept = _read(sequence.folder)
    if not kept:
        raise SequenceError(f"{sequence.folder}: its cameras were never changed; there are none to put back.")
    before = [parse_camera(item) for item in kept[-1].get("cameras").items(len(sequence.cameras))]
    if [camera.id for camera in before] != [camera.id for camera in sequence.cameras]:
        raise SequenceError(f"{path}: is of other cameras than those of the recording; it was copied from elsewhere.")
    changed = replace(sequence, cameras=give_places(sequence.cameras, before))
    save_sequence_json(changed)
    if len(kept) > 1:
        _write(sequence.folder, [item.value for item in kept[:-1]])
    else:
        path.unlink()
    return changed


def give_places(recorded: Many[RecordedCamera], cameras: Many[Camera]) -> tuple[RecordedCamera, ...]:
    """Recorded cameras with the lenses and places of others."""
    return tuple(
        replace(own, K=new.K, distortion=new.distortion, T_world_camera=new.T_world_camera)
        for own, new in zip(recorded, cameras, strict=True)
    )


def _read(folder: Path) -> list[Node]:
    if not (folder / KEPT_FILE).exists():
        return []
    node = load_json(folder / KEPT_FILE, MAX_DOCUMENT_BYTES, SequenceError)
    node.get("version").integer(1, 1)
    return list(node.get("changes").items(MAX_CHANGES))


def _write(folder: Path, changes: list[Any]) -> None:
    document = {"version": 1, "changes": changes[-MAX_CHANGES:]}
    write_atomically(folder / KEPT_FILE, (json.dumps(document, indent=1) + "\n").encode())
