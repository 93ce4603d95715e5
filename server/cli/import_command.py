"""`handloom import`: a recording from files on this machine into the studio."""

from __future__ import annotations

import argparse
import uuid
from pathlib import Path
from typing import TYPE_CHECKING, Any

from server.cli.guarded import CommandError, add_json, answer, load_settings, run_guarded

if TYPE_CHECKING:
    from server.database import Database
    from server.sequences.models import SequenceRow
    from server.storage import Storage
    from tracker import ImportOptions

NUMBERS = {
    "fps": "frames per second",
    "fx": "focal length along x, px",
    "fy": "focal length along y, px; as --fx when left out",
    "cx": "principal point x, px",
    "cy": "principal point y, px",
    "depth-scale": "metres per unit of the depth images, 0.001 for millimetres",
    "world-unit-m": "metres per unit of the calibration",
}
TEXTS = {
    "name": "name of the recording",
    "intrinsics": "TUM RGB-D: the camera it was recorded with",
    "depth-pattern": "where the depth images lie, such as 'depth/depth_*.png'",
    "color-pattern": "where the colour images lie; 'none' to import depth alone",
    "color-format": "how frames of videos are stored: jpeg or png",
}


def add_command(subparsers: argparse._SubParsersAction) -> None:
    parser = subparsers.add_parser(
        "import",
        help="bring a recording into the studio",
        description="Bring a recording into the studio: all of it, or nothing and why. The format is recognised "
        "when it can be.",
    )
    parser.add_argument("path", type=Path, metavar="PATH", help="a folder or file")
    parser.add_argument("--format", metavar="F", help="handloom, rgbd, tum or videos")
    for name, help_text in NUMBERS.items():
        parser.add_argument(f"--{name}", type=float, metavar="N", help=help_text)
    for name, help_text in TEXTS.items():
        parser.add_argument(f"--{name}", metavar="TEXT", help=help_text)
    parser.add_argument("--distortion", type=_split_numbers, metavar="K1,K2,...", help="OpenCV coefficients")
    parser.add_argument("--hands", type=_split, metavar="right,left", help="hands that are seen")
    parser.add_argument("--allow-gaps", action="store_true", default=None, help="import although frames are missing")
    add_json(parser)
    parser.set_defaults(run=run_guarded(run))


def run(args: argparse.Namespace) -> int:
    from server.database import Database
    from server.database.migrate import upgrade
    from server.storage import Storage
    from tracker import ImportOptions

    path: Path = args.path.expanduser().absolute()
    if not path.exists():
        raise CommandError(f"{args.path}: does not exist; needed a recording's folder or file.")
    names = (*NUMBERS, *TEXTS, "distortion", "hands", "allow-gaps")
    given = {name.replace("-", "_"): getattr(args, name.replace("-", "_")) for name in names}
    options = ImportOptions.from_json({name: value for name, value in given.items() if value is not None})
    settings = load_settings()
    database = Database(settings.sqlalchemy_url)
    try:
        upgrade(database)
        row, report = import_recording(database, Storage(settings.data_dir), path, args.format, options)
    finally:
        database.close()
    result = {"id": str(row.id), "name": row.name, "frames": row.frame_count, "report": report}
    return answer(args, result, f"{row.name}: {row.frame_count} frames imported as {row.id}")


def import_recording(
    database: Database, storage: Storage, path: Path, format_name: str | None, options: ImportOptions
) -> tuple[SequenceRow, dict[str, Any]]:
    """Bring a recording in with the annotations it has; its row and the import report. Raises when it is refused."""
    from server.accounts.models import LOCAL_ACCOUNT_ID
    from server.annotations.service import add_imported_annotations
    from server.sequences.service import AREA, add_sequence, describe_recording
    from tracker import ImportRefusedError, load_annotations, load_sequence, run_import

    id_ = uuid.uuid4()
    folder = storage.folder(AREA, id_)
    try:
        report = run_import(path, folder, format_name, options)
        if not report.ok:
            raise ImportRefusedError(f"{path} was refused: {'; '.join(str(problem) for problem in report.problems)}")
        recording = load_sequence(folder)
        columns = describe_recording(recording)
        annotated = recording.annotations_path
        with database.writing() as session:
            row = add_sequence(session, id_, columns, report.to_json(), LOCAL_ACCOUNT_ID)
            if annotated is not None and annotated.exists():
                add_imported_annotations(session, row, load_annotations(annotated), LOCAL_ACCOUNT_ID)
    except BaseException:
        storage.remove(AREA, id_)
        raise
    return row, report.to_json()


def _split(text: str) -> list[str]:
    return [part.strip() for part in text.split(",") if part.strip()]


def _split_numbers(text: str) -> list[float]:
    try:
        return [float(part) for part in _split(text)]
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r}: needed numbers separated by commas") from None
