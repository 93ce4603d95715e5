"""`handloom refine-cameras`: better places of a recording's cameras from the joints that people marked."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from tracker.cli.command import add_json, run_guarded


def add_command(subparsers: argparse._SubParsersAction) -> None:
    parser = subparsers.add_parser(
        "refine-cameras",
        help="correct a recording's cameras from its labels",
        description="Move the cameras of a recording so that joints marked in two or more of them agree, and show the "
        "agreement before and after, also on labels that were left out. Nothing is changed without --take.",
    )
    parser.add_argument("recording", type=Path, metavar="RECORDING", help="a recording folder")
    parser.add_argument(
        "--annotations", type=Path, metavar="FILE", help="labels (by default the recording's own annotations.json)"
    )
    parser.add_argument("--lenses", action="store_true", help="let focal lengths and distortion change too")
    what = parser.add_mutually_exclusive_group()
    what.add_argument("--take", action="store_true", help="give the recording these cameras; the old ones are kept")
    what.add_argument("--put-back", action="store_true", help="give it the cameras it had before the last change")
    add_json(parser)
    parser.set_defaults(run=run_guarded(refine, show))


def refine(args: argparse.Namespace) -> dict[str, Any]:
    from tracker.calibration.refine_cameras import refine_cameras
    from tracker.capture.annotations import load_annotations
    from tracker.capture.kept_cameras import change_cameras, put_cameras_back
    from tracker.capture.sequence import load_sequence
    from tracker.errors import AnnotationError, CalibrationError

    sequence = load_sequence(args.recording)
    if args.put_back:
        put_cameras_back(sequence)
        return {"recording": str(args.recording), "change": "put back", "text": ""}
    labels = args.annotations or sequence.annotations_path
    if labels is None:
        raise AnnotationError(f"{args.recording}: names no annotations; needed --annotations FILE.")
    found = refine_cameras(sequence.cameras, load_annotations(labels), args.lenses)
    if args.take:
        if found.refusal:
            raise CalibrationError(f"The cameras stay as they are. {found.refusal}")
        change_cameras(sequence, found.cameras, "refined from labels")
    change = "taken" if args.take else "none"
    return {"recording": str(args.recording), "change": change, **found.to_json(), "text": found.say()}


def show(result: dict[str, Any]) -> str:
    if result["change"] == "put back":
        return f"{result['recording']} has the cameras it had before the last change."
    if result["change"] == "taken":
        end = "The recording has these cameras now; --put-back restores the old ones. Old tracks stay: track again."
    else:
        end = "" if result["refusal"] else "Nothing was changed. --take gives the recording these cameras."
    return f"{result['text']}\n{end}".rstrip()
