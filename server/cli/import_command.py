"""`handloom import`: a recording from files on this machine into the studio."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from server.cli.guarded import CommandError, add_json, answer, run_guarded
from server.cli.open_studio import open_studio

if TYPE_CHECKING:
    from server.cli.open_studio import OpenStudio
    from server.sequences.models import SequenceRow

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
    parser.add_argument("--format", metavar="F", help="recording_folder, rgbd_folder, tum_rgbd or synced_videos")
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
    path: Path = args.path.expanduser().absolute()
    if not path.exists():
        raise CommandError(f"{args.path}: does not exist; needed a recording's folder or a video.")
    names = ("format", *NUMBERS, *TEXTS, "distortion", "hands", "allow-gaps")
    given = {name.replace("-", "_"): getattr(args, name.replace("-", "_")) for name in names}
    options = {name: value for name, value in given.items() if value is not None}
    with open_studio() as studio:
        row = import_recording(studio, path, options)
    result = {"id": str(row.id), "name": row.name, "frames": row.frame_count, "report": row.report}
    return answer(args, result, f"{row.name}: {row.frame_count} frames imported as {row.id}")


def import_recording(studio: OpenStudio, path: Path, options: dict[str, Any]) -> SequenceRow:
    """Bring a recording in with the annotations it has. Raises when it is refused."""
    from server.accounts.models import LOCAL_ACCOUNT_ID
    from server.imports.service import ImportDesk, import_recording
    from server.sequences.service import get_sequence

    desk = ImportDesk(studio.database, studio.storage, studio.settings)
    id_ = import_recording(desk, path, options, LOCAL_ACCOUNT_ID)
    with studio.database.reading() as session:
        return get_sequence(session, id_)


def _split(text: str) -> list[str]:
    return [part.strip() for part in text.split(",") if part.strip()]


def _split_numbers(text: str) -> list[float]:
    try:
        return [float(part) for part in _split(text)]
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r}: needed numbers separated by commas") from None
