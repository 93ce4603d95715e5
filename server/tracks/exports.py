"""Tracks as files for other programs, kept on disk once they were written: a track never changes."""

from __future__ import annotations

from pathlib import Path

from server.compute import ComputeContext

STYLE = 1
"""Part of the folder's name; raise it when something is exported differently."""

MEDIA_TYPES = {
    "npz": "application/octet-stream",
    "csv": "text/csv; charset=utf-8",
    "glb": "model/gltf-binary",
    "mano": "application/octet-stream",
}
"""For each kind of export."""


def find_export(_context: ComputeContext, track_folder: Path, recording: Path, kind: str) -> Path:
    """The file of one kind, written now if need be below `tracks/<id>/exports/`."""
    from tracker import EXPORT_KINDS, export_track, load_sequence, load_track

    path = track_folder / "exports" / f"{STYLE}-{EXPORT_KINDS[kind]}"
    if not path.is_file():
        track, sequence = load_track(track_folder), load_sequence(recording)
        path.parent.mkdir(exist_ok=True)
        export_track(track, sequence, kind, path)
    return path
