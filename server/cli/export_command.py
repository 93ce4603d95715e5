"""`handloom export`: labels, a recording or a track out of the studio."""

from __future__ import annotations

import argparse
import json
import os
import shutil
import sys
import uuid
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from server.cli.guarded import CommandError, add_json, answer, run_guarded
from server.cli.open_studio import open_studio

if TYPE_CHECKING:
    from sqlalchemy.orm import Session

    from server.sequences.models import SequenceRow
    from server.storage import Storage
    from server.tracks.models import TrackRow

TRACK_FILES = ("npz", "csv", "glb", "mano")
LABELS = ("annotations", "coco_keypoints", "coco_wholebody", "freihand", "interhand", "deeplabcut", "t16")
"""A test holds them equal to the tracker's `LABEL_FORMATS`, which would take long to load here."""
FORMATS = (*LABELS, "recording", "track", *TRACK_FILES)


def add_command(subparsers: argparse._SubParsersAction) -> None:
    parser = subparsers.add_parser(
        "export",
        help="export labels, recordings or tracks",
        description="Copy a recording's labels (annotations.json or another format), the recording (a folder, with "
        "its annotations) or its newest track out of the studio: the folder that tracking wrote (track), its arrays "
        "(npz), a table of joints (csv), an animation (glb: glTF) or MANO-style parameters (mano: npz). What a "
        "label format cannot hold is listed on stderr.",
    )
    parser.add_argument(
        "name",
        metavar="NAME",
        nargs="+",
        help="name or id of a recording; for a track also the track's id; for COCO several recordings",
    )
    parser.add_argument("--format", choices=FORMATS, required=True)
    parser.add_argument("--out", type=Path, required=True, metavar="PATH", help="a name that does not exist yet")
    parser.add_argument(
        "--snapshot", type=int, metavar="V", help="labels: those of this snapshot version instead of today's"
    )
    parser.add_argument(
        "--sources",
        default="all",
        metavar="WORDS",
        help="labels: which joints, by their source: all, independent (no track had a part in them), or some "
        "of hand, unknown, import, triangulation, interpolation, copy, fit, track, separated by commas; default: all",
    )
    parser.add_argument("--track", metavar="ID", help="labels in 3D: take the joints in space from this track")
    add_json(parser)
    parser.set_defaults(run=run_guarded(run))


def run(args: argparse.Namespace) -> int:
    out: Path = args.out.expanduser().absolute()
    if out.exists():
        raise CommandError(f"{out}: is there already; give a name that does not exist yet.")
    if not out.parent.is_dir():
        raise CommandError(f"{out.parent}: is not a folder; make it first.")
    is_labels, names = args.format in LABELS, ", ".join(args.name)
    if not is_labels and (args.snapshot is not None or args.track is not None or args.sources != "all"):
        raise CommandError(
            f"--snapshot, --sources and --track are for labels ({', '.join(LABELS)}), not for {args.format}."
        )
    if len(args.name) > 1 and (not is_labels or args.snapshot is not None or args.track is not None):
        raise CommandError(f"{len(args.name)} names ({names}); this exports one thing at a time.")
    with open_studio() as studio, studio.database.reading() as session:
        if is_labels:
            result = _export_labels(session, studio.storage, args, out)
        elif args.format == "track":
            result = _export_track(session, studio.storage, args.name[0], out)
        elif args.format in TRACK_FILES:
            result = _export_track_file(session, studio.storage, args.name[0], args.format, out)
        else:
            result = _export_recording(session, studio.storage, find_recording(session, args.name[0]), out)
    return answer(args, {"out": str(out), "format": args.format, **result}, f"{args.format} of {names}: {out}")


def find_recording(session: Session, name: str) -> SequenceRow:
    """The recording of this id or name; raises when there is none, or more than one of that name."""
    from sqlalchemy import select

    from server.sequences.models import SequenceRow

    query = select(SequenceRow).where(SequenceRow.deleted_at.is_(None))
    id_ = _read_id(name)
    if id_ is not None and (row := session.scalar(query.where(SequenceRow.id == id_))) is not None:
        return row
    rows = session.scalars(query.where(SequenceRow.name == name)).all()
    if len(rows) == 1:
        return rows[0]
    if rows:
        ids = ", ".join(str(row.id) for row in rows)
        raise CommandError(f"{len(rows)} recordings are named {name!r}; give an id: {ids}.")
    names = session.scalars(select(SequenceRow.name).where(SequenceRow.deleted_at.is_(None)).limit(10)).all()
    known = f"there are {', '.join(map(repr, names))}" if names else "the studio has no recordings yet"
    raise CommandError(f"There is no recording {name!r}; {known}.")


def _export_labels(session: Session, storage: Storage, args: argparse.Namespace, out: Path) -> dict[str, Any]:
    from server.annotations.snapshots import find_snapshot
    from server.exchange.label_sets import check_track, open_label_set, read_labels
    from tracker.capture import choose_sources
    from tracker.label_formats import export_labels, save_label_files

    sources = choose_sources(args.sources)
    rows = [find_recording(session, name) for name in args.name]
    if len({row.id for row in rows}) != len(rows):
        raise CommandError("A recording is named twice.")
    track_id = _read_id(args.track) if args.track is not None else None
    if args.track is not None:
        if track_id is None:
            raise CommandError(f"--track {args.track!r} is not the id of a track.")
        check_track(session, rows[0].id, track_id)
    snapshot = None if args.snapshot is None else find_snapshot(session, rows[0].id, args.snapshot)
    sets = [open_label_set(storage, row, read_labels(session, storage, row.id, snapshot), track_id) for row in rows]
    made = export_labels(args.format, sets, sources)
    for note in made.notes:
        sys.stderr.write(f"handloom: {note}\n")
    _appear(out, lambda path: save_label_files(path, made.files))
    return {"items": made.items, "joints": made.joints, "notes": list(made.notes)}


def _export_recording(session: Session, storage: Storage, sequence: SequenceRow, out: Path) -> dict[str, Any]:
    import dataclasses

    from server.annotations.service import export_annotations
    from tracker import load_sequence, save_sequence_json

    document = export_annotations(session, sequence.id)

    def save(folder: Path) -> None:
        shutil.copytree(storage.folder("sequences", sequence.id), folder)
        named = dataclasses.replace(load_sequence(folder), name=sequence.name, hands=tuple(sequence.hands))
        save_sequence_json(dataclasses.replace(named, annotations="annotations.json"))
        (folder / "annotations.json").write_text(json.dumps(document) + "\n")

    _appear(out, save)
    return {"frames": sequence.frame_count}


def _export_track(session: Session, storage: Storage, name: str, out: Path) -> dict[str, Any]:
    track = _find_track(session, name)
    folder = storage.folder("tracks", track.id)
    _appear(out, lambda path: shutil.copytree(folder, path, ignore=shutil.ignore_patterns("overlays", "exports")))
    return {"track": str(track.id), "frames": track.frame_count}


def _export_track_file(session: Session, storage: Storage, name: str, kind: str, out: Path) -> dict[str, Any]:
    from tracker import export_track, load_sequence, load_track

    track = _find_track(session, name)
    sequence = load_sequence(storage.folder("sequences", track.sequence_id))
    found = load_track(storage.folder("tracks", track.id))
    _appear(out, lambda path: export_track(found, sequence, kind, path))
    return {"track": str(track.id), "frames": track.frame_count}


def _find_track(session: Session, name: str) -> TrackRow:
    """The track of this id, or the newest one of the recording of this id or name."""
    from server.tracks.models import TrackRow
    from server.tracks.service import list_tracks

    id_ = _read_id(name)
    track = session.get(TrackRow, id_) if id_ is not None else None
    if track is not None and track.deleted_at is None:
        return track
    sequence = find_recording(session, name)
    tracks, _ = list_tracks(session, sequence.id, None, 1)
    if not tracks:
        raise CommandError(f"The recording {sequence.name!r} has no track yet; start a tracking job first.")
    return tracks[0]


def _appear(out: Path, save: Callable[[Path], Any]) -> None:
    """Have `save` write a sibling that then gets its name, so that nothing half-written is ever at `out`."""
    unfinished = out.with_name(f".{uuid.uuid4().hex}-{out.name}")
    try:
        save(unfinished)
        os.rename(unfinished, out)
    finally:
        if unfinished.is_dir():
            shutil.rmtree(unfinished, ignore_errors=True)
        else:
            unfinished.unlink(missing_ok=True)


def _read_id(text: str) -> uuid.UUID | None:
    try:
        return uuid.UUID(text)
    except ValueError:
        return None
