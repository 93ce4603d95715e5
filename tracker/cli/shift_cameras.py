"""`handloom shift-cameras`: which cameras of a recording are out of step, and a recording in which they are not."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from tracker.cli.command import add_json, run_guarded
from tracker.errors import CalibrationError, ImportRefusedError

REACH_S = 2.0
"""How far videos may be out of step unless told: cameras that are started by hand differ by less."""


def add_command(subparsers: argparse._SubParsersAction) -> None:
    parser = subparsers.add_parser(
        "shift-cameras",
        help="find and correct cameras that are out of step",
        description="Make a new recording in which cameras are shifted by whole frames and cut to the frames that all "
        "have. Labels follow their pictures, tracks do not, and the old recording stays. With --find: say from the "
        "motion of detected hands how far cameras are out of step.",
    )
    parser.add_argument("recording", type=Path, metavar="RECORDING", help="a recording folder")
    parser.add_argument(
        "shifts", nargs="*", metavar="CAMERA=FRAMES", help="such as cam1=+3: a moment is 3 frames later in its video"
    )
    parser.add_argument("--out", type=Path, metavar="DIR", help="the new recording, a folder that does not exist yet")
    parser.add_argument("--find", action="store_true", help="find how far cameras are out of step, and change nothing")
    parser.add_argument(
        "--detections",
        type=Path,
        metavar="FILE",
        help="with --find: what `handloom detect` wrote (detections.json in the recording)",
    )
    parser.add_argument(
        "--reach", type=int, metavar="FRAMES", help=f"with --find: farthest shift tried ({REACH_S:g} s)"
    )
    add_json(parser)
    parser.set_defaults(run=run_guarded(shift, show))


def shift(args: argparse.Namespace) -> dict[str, Any]:
    from tracker.capture.import_options import ImportOptions
    from tracker.capture.import_run import run_import
    from tracker.capture.sequence import load_sequence

    sequence = load_sequence(args.recording)
    if args.find:
        if args.shifts or args.out is not None:
            raise ImportRefusedError("--find changes nothing: leave out the shifts and --out.")
        return _find(args, sequence)
    if not args.shifts or args.out is None:
        raise ImportRefusedError("Needed CAMERA=FRAMES and --out DIR; --find shows how far cameras are out of step.")
    options = ImportOptions(name=f"{sequence.name} in step"[:200], camera_shifts=" ".join(args.shifts))
    report = run_import(args.recording, args.out, "recording_folder", options)
    return {"out": str(args.out), "frames": report.frame_count, "warnings": list(report.warnings)}


def _find(args: argparse.Namespace, sequence: Any) -> dict[str, Any]:
    from tracker.calibration.hand_offsets import find_hand_offsets
    from tracker.capture.annotations import load_annotations
    from tracker.cli.detect import DEFAULT_FILE

    if len(sequence.cameras) < 2:
        raise CalibrationError(f"{args.recording}: has only one camera; needed two or more.")
    file = args.detections or args.recording / DEFAULT_FILE
    if not file.exists():
        raise CalibrationError(f"{file}: is not there; run `handloom detect {args.recording}` first.")
    reach = round(REACH_S * sequence.fps) if args.reach is None else args.reach
    if not 2 <= reach < sequence.frame_count:
        raise CalibrationError(f"--reach is {reach} frames; needed 2 to {sequence.frame_count - 1}.")
    found = find_hand_offsets(sequence.cameras, load_annotations(file), sequence.fps, reach)
    first = sequence.cameras[0].id
    return {"first": first, "cameras": [one.to_json() for one in found], "text": [one.say(first) for one in found]}


def show(result: dict[str, Any]) -> str:
    if "text" in result:
        return "\n".join(result["text"])
    return "\n".join([*result["warnings"], f"{result['frames']} frames: {result['out']}"])
