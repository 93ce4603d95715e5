"""`handloom calibrate`: fit a hand's shape to the first two seconds of a recording."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from tracker.cli.command import add_json, parse_hand, run_guarded
from tracker.cli.hands import load_hands
from tracker.cli.progress import ProgressLine
from tracker.errors import TrackerError
from tracker.model.built_in_hands import BUILT_IN_HANDS


def add_command(subparsers: argparse._SubParsersAction) -> None:
    parser = subparsers.add_parser(
        "calibrate",
        help="fit a hand's shape to a recording",
        description="Place a hand in the first frame of a recording folder, fit its shape to the first two seconds and "
        "its joints to the marks of the first frame, and write the model, for `handloom track --hand SIDE=MODEL`.",
    )
    parser.add_argument("recording", type=Path, metavar="PATH", help="a recording folder, with its sequence.json")
    parser.add_argument("--out", type=Path, required=True, metavar="MODEL", help="the model, an npz file")
    parser.add_argument(
        "--hand",
        type=parse_hand,
        action="append",
        default=[],
        metavar="SIDE[=FILE]",
        help="which hand, where the recording names two, and the model to begin with, or `trained`",
    )
    add_json(parser)
    parser.set_defaults(run=run_guarded(calibrate, show))


def calibrate(args: argparse.Namespace) -> dict[str, Any]:
    from dataclasses import replace

    from tracker.capture.annotations import load_annotations
    from tracker.capture.sequence import load_sequence
    from tracker.fitting.options import TrackOptions
    from tracker.model import save_model
    from tracker.tracking.start import start_tracking

    if args.out.suffix != ".npz":
        raise TrackerError(f"--out {args.out}: needed a file that ends in .npz.")
    sequence = load_sequence(args.recording)
    named = [name for name, _ in args.hand if name not in BUILT_IN_HANDS]
    side = named[0] if named else sequence.hands[0] if len(sequence.hands) == 1 else ""
    if side not in sequence.hands:
        raise TrackerError(f"Needed --hand with one of {list(sequence.hands)}.")
    path = sequence.annotations_path
    annotations = load_annotations(path) if path is not None and path.exists() else None
    line = ProgressLine(f"calibrating on {sequence.name}")
    setup, state = start_tracking(
        replace(sequence, hands=(side,), objects=()),
        TrackOptions(),
        load_hands([hand for hand in args.hand if hand[1] is not None or hand[0] in BUILT_IN_HANDS], (side,)),
        annotations,
        lambda stage, share: line.show(share, stage),
    )
    if state.is_lost:
        raise TrackerError(f"{sequence.name}: no {side} hand was found in the first frame; annotate it.")
    save_model(setup.models[0], args.out)
    return {"out": str(args.out), "hand": side}


def show(result: dict[str, Any]) -> str:
    return f"{result['hand']} hand: {result['out']}"
