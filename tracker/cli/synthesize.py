"""`handloom synthesize`: a recording whose every pose is exactly known."""

from __future__ import annotations

import argparse
import time
from pathlib import Path
from typing import Any

from tracker.cli.command import add_json, choose_frames, parse_hand, parse_range, run_guarded
from tracker.cli.hands import load_hands
from tracker.cli.progress import ProgressLine
from tracker.errors import TrackerError, say_count
from tracker.model.built_in_hands import BUILT_IN_HANDS

MOTION_FRAMES = 90
"""Where --frames is not given: three seconds."""


def add_command(subparsers: argparse._SubParsersAction) -> None:
    parser = subparsers.add_parser(
        "synthesize",
        help="render a recording with known pose",
        description="Render a recording with exactly known pose: a simple motion of a hand, or a twin of a sequence of "
        "T16. It holds colour, depth, annotations of every frame, truth.npz and the models that were rendered.",
    )
    source = parser.add_mutually_exclusive_group(required=True)
    source.add_argument(
        "--motion", metavar="NAME", help="open-close, wave, count or pinch; with two hands crossing or passing"
    )
    source.add_argument("--twin", type=Path, metavar="FOLDER", help="T16's models and motions")
    parser.add_argument("--sequence", metavar="NN", help="with --twin: which of its sequences, such as 09")
    parser.add_argument("--full-mesh", action="store_true", help="with --twin: the full meshes, not the tracker's size")
    parser.add_argument(
        "--hand",
        type=parse_hand,
        action="append",
        metavar="SIDE[=FILE]",
        help="with --motion: right or left, with a model of your own if you like; may be given twice (default: right)",
    )
    parser.add_argument(
        "--frames", type=parse_range, default=(None, None), metavar="A:B", help="frames A to B - 1 of the motion"
    )
    parser.add_argument("--step", type=int, default=1, help="use every Nth frame of the motion")
    parser.add_argument("--noise", choices=("structured-light", "none"), default="structured-light")
    parser.add_argument("--seed", type=int, default=0, help="seed of the noise")
    parser.add_argument(
        "--background", type=float, default=0.0, metavar="M", help="a wall at this depth, m; 0 for none"
    )
    parser.add_argument(
        "--cameras", type=int, default=1, metavar="N", help="with --motion: 1 to 8 cameras around the hands"
    )
    parser.add_argument(
        "--size", type=parse_size, default=(640, 480), metavar="WxH", help="with --motion: size of the images, px"
    )
    parser.add_argument("--texture", action="store_true", help="spots on skin and a still, spotted wall in the colour")
    parser.add_argument("--nails", action="store_true", help="with --texture: finger nails in the colour")
    parser.add_argument("--circles", type=int, default=0, metavar="N", help="discs that disturb each colour image")
    parser.add_argument("--out", type=Path, required=True, metavar="DIR", help="a folder that does not exist yet")
    add_json(parser)
    parser.set_defaults(run=run_guarded(synthesize, show))


def synthesize(args: argparse.Namespace) -> dict[str, Any]:
    from tracker.model import save_model
    from tracker.synthesis.nail_paint import NailPaint
    from tracker.synthesis.recording import RecordingOptions, write_recording
    from tracker.synthesis.sensor import StructuredLight
    from tracker.synthesis.texture import Texture
    from tracker.synthesis.view_noise import ViewNoise

    _check(args)
    began = time.monotonic()
    performance = _load_twin(args) if args.twin is not None else _perform(args)
    options = RecordingOptions(
        moments=choose_frames(args.frames, performance.num_moments, args.step),
        sensor=StructuredLight() if args.noise == "structured-light" else None,
        seed=args.seed,
        background=args.background,
        texture=Texture(args.seed, nails=NailPaint() if args.nails else None) if args.texture else None,
        view_noise=ViewNoise(circles=args.circles) if args.circles else None,
    )
    line = ProgressLine(f"rendering {performance.name}")
    sequence = write_recording(performance, args.out, options, save_model, line.show)
    return {
        "out": str(args.out),
        "name": sequence.name,
        "frames": sequence.frame_count,
        "hands": list(sequence.hands),
        "objects": [item.name for item in sequence.objects],
        "seconds": round(time.monotonic() - began, 2),
    }


def _check(args: argparse.Namespace) -> None:
    if not 1 <= args.cameras <= 8 or (args.twin is not None and (args.cameras, args.size) != (1, (640, 480))):
        raise TrackerError("--cameras must be 1 to 8; a twin (--twin) has the one camera of its recording, 640x480 px.")
    if args.step < 1 or args.seed < 0 or args.background < 0 or args.circles < 0:
        raise TrackerError("--step must be at least 1, --seed, --background and --circles at least 0.")
    if args.nails and not args.texture:
        raise TrackerError("--nails needs --texture: without it the colour images have plain skin.")


def show(result: dict[str, Any]) -> str:
    return f"{result['name']}: {say_count(result['frames'], 'frame')} in {result['out']} ({result['seconds']:.1f} s)"


def _load_twin(args: argparse.Namespace):
    from tracker.synthesis.twin import load_twin

    if args.sequence is None:
        raise TrackerError("--twin needs --sequence NN, the sequence to render, such as --sequence 09.")
    return load_twin(args.twin, args.sequence, None if args.full_mesh else 1500)


def _perform(args: argparse.Namespace):
    from tracker.synthesis.interplay import INTERPLAYS, play
    from tracker.synthesis.motion import MOTIONS, perform

    if args.motion not in {**MOTIONS, **INTERPLAYS}:
        names = ", ".join((*MOTIONS, *INTERPLAYS))
        raise TrackerError(f"There is no motion {args.motion!r}; choose one of {names}.")
    if args.motion in INTERPLAYS:
        models = load_hands(args.hand or [], ("right", "left"))
        return play(models, args.motion, args.frames[1] or MOTION_FRAMES, args.cameras, args.size)
    given = args.hand or [("right", None)]
    models = load_hands(given, tuple(name for name in dict(given) if name not in BUILT_IN_HANDS) or ("right",))
    return perform(models, args.motion, args.frames[1] or MOTION_FRAMES, args.cameras, args.size)


def parse_size(text: str) -> tuple[int, int]:
    """Width and height of `WxH`, px."""
    words = text.lower().split("x")
    if len(words) != 2 or not all(word.isdecimal() and 32 <= int(word) <= 4096 for word in words):
        raise argparse.ArgumentTypeError(f"{text!r} is not a size; needed WIDTHxHEIGHT, 32 to 4096 px each, as 640x480")
    return int(words[0]), int(words[1])
