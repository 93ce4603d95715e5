"""`handloom calibrate-cameras`: lenses, places and time offsets of several cameras from a filmed board."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from tracker.cli.command import add_json, run_guarded
from tracker.cli.progress import ProgressLine
from tracker.errors import TrackerError

LOOKING = 0.8
"""Share of the time that looking for the board takes."""


def add_command(subparsers: argparse._SubParsersAction) -> None:
    parser = subparsers.add_parser(
        "calibrate-cameras",
        help="calibrate several cameras from a filmed board",
        description="Find lenses, places and time offsets of 2 to 16 cameras that filmed a board, judge them on frames "
        "that were left out, and write the cameras (Anipose's .toml, OpenCV's .yaml, or a folder of COLMAP's text) and "
        "a report. Or print a board: --print-board board.pdf.",
    )
    parser.add_argument(
        "paths",
        type=Path,
        nargs="*",
        metavar="PATH",
        help="a video or a folder of images for each camera, or one folder that holds them",
    )
    parser.add_argument(
        "--board",
        required=True,
        metavar="BOARD",
        help="a file (ours or caliscope's charuco.toml), or KIND:COLUMNSxROWS:SQUARE_MM[:MARKER_MM[:DICTIONARY]] with "
        "KIND charuco, apriltag or checkerboard, squares counted with the outer ones, such as "
        "charuco:5x7:30:22.5:5X5_100",
    )
    parser.add_argument("--out", type=Path, metavar="FILE", help="the cameras: .toml, .yaml, or a folder")
    parser.add_argument(
        "--print-board", type=Path, metavar="PDF", help="write the board as a page of true size, and stop"
    )
    parser.add_argument(
        "--lenses",
        type=Path,
        metavar="FILE",
        help="known lenses, from a calibration with the same names; kept as they are",
    )
    parser.add_argument(
        "--no-offset",
        action="store_true",
        help="frames with the same number show the same moment; do not look for time offsets",
    )
    parser.add_argument("--max-offset", type=float, default=10.0, metavar="SECONDS", help="largest time offset, s (10)")
    parser.add_argument("--fps", type=float, metavar="N", help="frames a second of folders of images")
    parser.add_argument(
        "--left-out",
        type=float,
        default=0.2,
        metavar="SHARE",
        help="share of the time used to judge the cameras, not to fit them (0.2)",
    )
    add_json(parser)
    parser.set_defaults(run=run_guarded(calibrate, show))


def calibrate(args: argparse.Namespace) -> dict[str, Any]:
    from tracker.calibration.board_file import read_board
    from tracker.calibration.board_pdf import make_board_pdf
    from tracker.capture.atomic_file import write_atomically

    board = read_board(args.board)
    if args.print_board is not None:
        if args.print_board.suffix.lower() != ".pdf" or args.print_board.is_dir():
            raise TrackerError(f"--print-board {args.print_board}: needed the name of a file that ends in .pdf.")
        args.print_board.parent.mkdir(parents=True, exist_ok=True)
        write_atomically(args.print_board, make_board_pdf(board))
        width, height = board.size_m
        return {"out": str(args.print_board), "board": board.describe(), "size_mm": [1000 * width, 1000 * height]}
    return _calibrate(args, board)


def _calibrate(args: argparse.Namespace, board: Any) -> dict[str, Any]:
    from tracker.calibration.calibrate import CalibrationOptions, calibrate_cameras
    from tracker.calibration.calibration_output import choose_format, write_calibration
    from tracker.calibration.calibration_report import describe_calibration, say_calibration
    from tracker.calibration.camera_source import find_sources
    from tracker.calibration.known_lenses import load_lenses
    from tracker.calibration.sightings import find_sightings

    if args.out is None:
        raise TrackerError("Needed --out FILE for the cameras, or --print-board PDF.")
    for name, value, low, high in (
        ("--max-offset", args.max_offset, 0.0, 600.0),
        ("--left-out", args.left_out, 0.0, 0.5),
    ):
        if not low <= value <= high:
            raise TrackerError(f"{name} is {value:g}; needed {low:g} to {high:g}.")
    if args.fps is not None and not 0.001 <= args.fps <= 100_000:
        raise TrackerError(f"--fps is {args.fps:g}; needed 0.001 to 100000.")
    choose_format(args.out)
    sources = find_sources(args.paths, args.fps)
    lenses = load_lenses(args.lenses) if args.lenses is not None else None
    is_still = any(source.images for source in sources) and args.fps is None
    line = ProgressLine("calibrating cameras")
    sightings = []
    for number, source in enumerate(sources):
        done = LOOKING * number / len(sources)
        sightings.append(
            find_sightings(
                source, board, lambda what, share, done=done: line.show(done + LOOKING * share / len(sources), what)
            )
        )
    options = CalibrationOptions(
        find_offsets=not args.no_offset and not is_still,
        max_offset_s=args.max_offset,
        lenses=lenses,
        left_out=args.left_out,
    )
    result = calibrate_cameras(sightings, board, options, lambda what, share: line.show(LOOKING, what))
    line.show(1.0)
    written = write_calibration(result, args.out)
    told = describe_calibration(result)
    del told["boards"]
    return {**written, **told, "text": say_calibration(result)}


def show(result: dict[str, Any]) -> str:
    if "size_mm" in result:
        width, height = result["size_mm"]
        return f"{result['board']}: {width:g} x {height:g} mm\n{result['out']}"
    return f"{result['text']}\n\n{result['out']}\n{result['report']}"
