"""Which recording a command works on: a recording folder, or videos as they are."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tracker.capture.sequence import Sequence

PATH_HELP = "a recording folder, with its sequence.json; or a folder of videos, one for each camera, with a calibration"

NUMBERS = {
    "fps": "frames per second, where the videos differ",
    "fx": "of one video without a calibration: focal length along x, px",
    "fy": "focal length along y, px; equal to --fx when left out",
    "cx": "principal point x, px",
    "cy": "principal point y, px",
    "world-unit-m": "metres per unit of the calibration, such as the side of a square",
}


def add_recording(parser: argparse.ArgumentParser, metavar: str) -> None:
    """The path, and what only videos need to be told."""
    parser.add_argument("recording", type=Path, metavar=metavar, help=PATH_HELP)
    videos = parser.add_argument_group("a folder of videos, which `handloom import` would ask the same of")
    for name, help_text in NUMBERS.items():
        videos.add_argument(f"--{name}", type=float, metavar="N", help=help_text)
    videos.add_argument(
        "--hands", type=lambda text: tuple(text.split(",")), metavar="right,left", help="hands that are seen (right)"
    )
    videos.add_argument(
        "--allow-gaps",
        action="store_true",
        default=None,
        help="accept videos of different length; use the frames that all have",
    )


def load_recording(args: argparse.Namespace) -> Sequence:
    """The recording that the arguments of `add_recording` name.

    Raises:
        TrackerError: It cannot be used.
    """
    from tracker.capture.film_recording import open_recording
    from tracker.capture.import_options import ImportOptions

    names = [*(name.replace("-", "_") for name in NUMBERS), "hands", "allow_gaps"]
    told = {name: getattr(args, name) for name in names if getattr(args, name) is not None}
    if "hands" in told:
        told["hands"] = list(told["hands"])
    return open_recording(args.recording, ImportOptions.from_json(told))
