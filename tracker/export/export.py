"""A track as one file of a kind that other programs read."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from tracker.capture.atomic_file import write_atomically
from tracker.capture.sequence import Sequence
from tracker.errors import TrackingError, say_count
from tracker.export.csv_files import write_csv
from tracker.export.gltf_animation import write_glb
from tracker.export.mano_parameters import find_mano_parameters
from tracker.tracking.arrays_file import save_arrays
from tracker.tracking.track import Track

EXPORT_KINDS: dict[str, str] = {"npz": "track.npz", "csv": "joints.csv", "glb": "animation.glb", "mano": "mano.npz"}
"""What a track can be exported as, and how such a file is best called."""


def export_track(track: Track, sequence: Sequence, kind: str, out_path: Path) -> None:
    """Write a track to a file, whole or not at all; one that is there is replaced. docs/tracking.md says what it holds.

    Args:
        track: What a run found.
        sequence: The recording it ran on.
        kind: One of EXPORT_KINDS.
        out_path: The file.

    Raises:
        TrackingError: The kind is unknown, the folder is missing, or the track does not fit the recording or the kind.
    """
    out_path = Path(out_path)
    if kind not in EXPORT_KINDS:
        raise TrackingError(f"A track cannot be exported as {kind!r}; there are {', '.join(EXPORT_KINDS)}.")
    if out_path.is_dir():
        raise TrackingError(f"{out_path}: is a folder; give the name of a file, for example {EXPORT_KINDS[kind]}.")
    if not out_path.parent.is_dir():
        raise TrackingError(f"{out_path.parent}: is not a folder; make it first.")
    _check(track, sequence)
    writers: dict[str, Callable[[], None]] = {
        "npz": lambda: save_arrays(out_path, track.arrays()),
        "csv": lambda: write_atomically(out_path, write_csv(track)),
        "glb": lambda: write_atomically(out_path, write_glb(track, sequence.fps)),
        "mano": lambda: save_arrays(out_path, find_mano_parameters(track)),
    }
    writers[kind]()


def _check(track: Track, sequence: Sequence) -> None:
    if len(track.frame) == 0:
        raise TrackingError("The track has no frames; there is nothing to export.")
    cameras = tuple(camera.id for camera in sequence.cameras)
    if track.camera_ids != cameras or track.frame[-1] >= sequence.frame_count:
        raise TrackingError(
            f"The track has the cameras {', '.join(track.camera_ids)} and frames up to {track.frame[-1]}; "
            f"{sequence.name} has {', '.join(cameras)} and {sequence.frame_count} frames. Give the recording it ran on."
        )
    bad = track.frame[~np.isfinite(track.pose).all(axis=1)]
    if len(bad):
        raise TrackingError(
            f"The track has no pose in {say_count(len(bad), 'frame')}, first in frame {bad[0]}; track it again."
        )
