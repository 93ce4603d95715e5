"""`handloom register-body-sequence`: register the body with hands to scans of a moving person."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from tracker.cli.command import add_json, choose_frames, parse_range, run_guarded
from tracker.cli.progress import ProgressLine
from tracker.cli.register import list_scans
from tracker.cli.register_body import load_body
from tracker.errors import TrackerError, say_count


def add_command(subparsers: argparse._SubParsersAction) -> None:
    parser = subparsers.add_parser(
        "register-body-sequence",
        help="register the body with hands to scans of a moving person",
        description="Register the scans of one person, frame after frame in the order of their names, to one template "
        "([R17] section 4.3): first the person's own template from the first frames, then every frame from the one "
        "before. OUT gets template.npz, frames/NNNNNN/body.npz and body.ply, motion.npz (156 numbers a frame) and "
        "summary.json. A stopped or killed run continues after its last frame. Hands that a scan does not show are "
        "guessed, and reported as guessed.",
    )
    parser.add_argument("scans", type=Path, nargs="+", metavar="SCAN", help="scans or a folder of them")
    parser.add_argument("--out", type=Path, required=True, metavar="DIR")
    parser.add_argument("--frames", type=parse_range, default=(None, None), metavar="A:B", help="A to B - 1 (all)")
    parser.add_argument("--model", type=Path, metavar="FILE", help="a body of SMPL-H's class, .npz or .pkl")
    parser.add_argument("--population", choices=("neutral", "male", "female"), default="neutral")
    parser.add_argument("--metres-per-unit", type=float, metavar="M", help="unit of the files (recognised by the size)")
    parser.add_argument("--fps", type=float, default=60.0, help="frames per second (60)")
    parser.add_argument(
        "--prior", choices=("mixture", "gaussian", "none"), default="mixture", help="prior of the hands (mixture)"
    )
    parser.add_argument("--no-hold", action="store_true", help="let hands that a scan does not show move (no E_r)")
    parser.add_argument("--no-velocity", action="store_true", help="without the velocity term")
    parser.add_argument("--chunk", type=int, default=0, metavar="N", help="frames of a chunk (all in one)")
    parser.add_argument("--processes", type=int, default=1, metavar="N", help="chunks at a time (1)")
    add_json(parser)
    parser.set_defaults(run=run_guarded(register_body_sequence, show))


def register_body_sequence(args: argparse.Namespace) -> dict[str, Any]:
    from tracker.bodies.body_sequence import Sequence, SequenceOptions, register_sequence
    from tracker.bodies.follow_body import FollowOptions

    checks = {"--chunk": (args.chunk, 0, 100_000), "--processes": (args.processes, 1, 256), "--fps": (args.fps, 1, 1e4)}
    for name, (value, least, most) in checks.items():
        if not least <= value <= most:
            raise TrackerError(f"{name} is {value}; needed {least:g} to {most:g}.")
    paths = list_scans(args.scans)
    frames = choose_frames(args.frames, len(paths))
    follow = FollowOptions(args.prior, not args.no_hold, not args.no_velocity)
    options = SequenceOptions(follow, chunk=args.chunk, metres_per_unit=args.metres_per_unit, fps=args.fps)
    sequence = Sequence(tuple(paths[t].resolve() for t in frames), args.out, options)
    line = ProgressLine(f"registering {say_count(len(sequence), 'frame')}")
    return register_sequence(sequence, load_body(args.model, args.population), args.processes, line.show)


def show(result: dict[str, Any]) -> str:
    guessed = ", ".join(f"{side} hand guessed in {len(frames)}" for side, frames in result["guessed"].items())
    counts = ", ".join(f"{count} {name}" for name, count in result["verdicts"].items())
    lines = [
        f"{result['registered']} of {say_count(result['frames'], 'frame')} registered: {counts}; {guessed}; "
        f"{result['scan_to_mesh_mm']:.2f} mm mean scan to mesh, {result['median_seconds']:.1f} s a frame"
    ]
    return "\n".join([*lines, *result["errors"]])
