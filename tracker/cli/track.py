"""`handloom track`: fit hands to every frame of a recording."""

from __future__ import annotations

import argparse
import json
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tracker.cli.command import add_json, choose_frames, parse_hand, parse_named_file, parse_range, run_guarded
from tracker.cli.hands import load_hands, load_objects
from tracker.cli.progress import ProgressLine
from tracker.cli.recording import add_recording, load_recording
from tracker.errors import TrackerError, say_count
from tracker.fitting.presets import PRESETS, find_preset

if TYPE_CHECKING:
    from tracker.capture.annotations import Annotations
    from tracker.capture.sequence import Sequence


def add_command(subparsers: argparse._SubParsersAction) -> None:
    parser = subparsers.add_parser(
        "track",
        help="fit hands to every frame of a recording",
        description="Fit hands to every frame of a recording folder and write track.npz and summary.json. A hand "
        "starts from the annotation of the first frame if there is one, otherwise from the hand detector in the colour "
        "image; without colour the depth image is searched. Recordings of one to sixteen colour cameras without depth "
        "use the hand detector in every view.",
    )
    add_recording(parser, "PATH")
    parser.add_argument("--out", type=Path, required=True, metavar="DIR", help="folder for the track")
    parser.add_argument(
        "--hand",
        type=parse_hand,
        action="append",
        default=[],
        metavar="SIDE=FILE",
        help="model of the right or left hand (npz, MANO's files, T16 .OFF, skinned glTF), or 'trained' for the hand "
        "learnt from scans; the default hand otherwise",
    )
    parser.add_argument(
        "--annotations", type=Path, metavar="FILE", help="annotations instead of the recording's own; 'none' for none"
    )
    parser.add_argument(
        "--object",
        type=parse_named_file,
        action="append",
        default=[],
        metavar="NAME=FILE",
        help="model of an object that the recording names, in place of the recording's own",
    )
    parser.add_argument(
        "--preset",
        choices=tuple(preset.name for preset in PRESETS),
        help="a set of options; options given explicitly override it: "
        + ", ".join(
            f"{preset.name} ({preset.values['terms']}, {preset.values['iterations']} iterations)" for preset in PRESETS
        ),
    )
    parser.add_argument("--terms", metavar="LO+SC", help="LO, or LO+ and any of S, C, P, such as LO+SC (LO)")
    parser.add_argument("--iterations", type=int, metavar="N", help="Gauss-Newton iterations a frame (10)")
    parser.add_argument("--first-iterations", type=int, metavar="N", help="iterations on the first frame (50)")
    parser.add_argument(
        "--frames", type=parse_range, default=(None, None), metavar="A:B", help="frames A to B - 1 only"
    )
    parser.add_argument("--camera", metavar="ID", help="the depth camera to track in (the first)")
    parser.add_argument(
        "--cameras",
        metavar="A,B,...",
        help="cameras to track in together; a recording without depth is tracked in all of its cameras",
    )
    turn_off = partial(parser.add_argument, action="store_const", const=False)
    turn_off("--no-depth", dest="use_depth", help="with --cameras: use the colour of all, no depth")
    turn_off("--no-calibration", dest="calibrate", help="keep the models' size and shape as they are")
    turn_off("--no-detector", dest="use_detector", help="do not look for hands in the colour images")
    parser.add_argument(
        "--detector",
        type=Path,
        metavar="FILE",
        help="a fingertip detector that `handloom train-detector` wrote (.npz): it looks for fingertips in every "
        "frame, for terms with S; otherwise the bundled one is used where a frame goes badly. With --cameras a "
        "detector of finger nails",
    )
    turn_off("--no-skin", dest="use_skin", help="do not use colour to distinguish hands from other things")
    turn_off("--no-recovery", dest="recover", help="do not look for a lost hand")
    parser.add_argument(
        "--static-scene",
        choices=("find", "recording", "none"),
        help="tables and walls for physics: from the recording, otherwise found in depth (find)",
    )
    parser.add_argument(
        "--stop-below",
        dest="stop_below_mm",
        type=float,
        metavar="MM",
        help="stop iterating when the mean joint moves less than this (never)",
    )
    parser.add_argument("--threads", type=int, metavar="N", help="threads; the second prepares the next frame (1)")
    add_json(parser)
    parser.set_defaults(run=run_guarded(track, show))


OPTIONS = (
    *("terms", "iterations", "first_iterations", "camera", "cameras", "use_depth", "calibrate", "use_detector"),
    *("use_skin", "recover", "static_scene", "stop_below_mm", "threads"),
)
"""Arguments that are options of the tracker, under the same names."""


def track(args: argparse.Namespace) -> dict[str, Any]:
    from tracker.detection import load_detector
    from tracker.fitting.options import TrackOptions
    from tracker.tracking.follow import track_frames
    from tracker.tracking.start import start_tracking
    from tracker.tracking.track import join_chunks

    sequence = load_recording(args)
    frames = choose_frames(args.frames, sequence.frame_count)
    given = {name: value for name in OPTIONS if (value := getattr(args, name)) is not None}
    given |= {"first_frame": frames.start, "last_frame": frames.stop - 1}
    preset = find_preset(args.preset).values if args.preset else {}
    options = TrackOptions.from_json(preset | given)
    annotations = _load_annotations(args, sequence)
    detector = None if args.detector is None else load_detector(args.detector)
    if args.out.exists() and not args.out.is_dir():
        raise TrackerError(f"{args.out}: is a file; --out needs a folder.")
    line = ProgressLine(f"tracking {sequence.name}")
    setup, state = start_tracking(
        sequence,
        options,
        {
            **load_hands(args.hand, sequence.hands, options.max_faces),
            **load_objects(args.object, tuple(item.name for item in sequence.objects), options.max_faces),
        },
        annotations,
        lambda stage, share: line.show(0.0, stage),
        detector,
    )
    state, chunk = track_frames(
        sequence,
        setup,
        state,
        frames,
        lambda frame, result: line.show((frame - frames.start + 1) / len(frames), f"frame {frame} {result.status}"),
    )
    track = join_chunks(sequence, setup, [chunk])
    track.save(args.out)
    return {"out": str(args.out), **json.loads((args.out / "summary.json").read_text())}


def _load_annotations(args: argparse.Namespace, sequence: Sequence) -> Annotations | None:
    """The marks to start from: those that were named, else the recording's own if it has some."""
    from tracker.capture.annotations import load_annotations

    path = args.annotations or sequence.annotations_path
    if path is None or str(args.annotations) == "none":
        return None
    return load_annotations(path) if args.annotations or path.exists() else None


def show(result: dict[str, Any]) -> str:
    counts = f"{say_count(result['frames'], 'frame')}, {result['lost']} lost"
    for name, found in result["objects"].items():
        counts += f", {name} lost in {found['lost']}"
    guessed = (
        "\nOne colour camera alone was tracked in: the hands' size and distance are guesses."
        if result["is_distance_guessed"]
        else ""
    )
    guessed += "".join(f"\n{doubt}" for doubt in result["doubts"])
    return f"{counts}, median {result['median_ms']:.1f} ms a frame: {result['out']}{guessed}"
