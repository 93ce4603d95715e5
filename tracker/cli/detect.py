"""`handloom detect`: the hands in the images of a recording, by the hand detector."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from tracker.cli.command import add_json, choose_frames, parse_range, run_guarded
from tracker.cli.progress import ProgressLine
from tracker.cli.recording import add_recording, load_recording
from tracker.errors import TrackerError, say_count

DEFAULT_FILE = "detections.json"


def add_command(subparsers: argparse._SubParsersAction) -> None:
    parser = subparsers.add_parser(
        "detect",
        help="find the hands in a recording's images",
        description="Find the hands in the colour, grey and infrared images of a recording, followed from frame to "
        "frame, and write their joints as an annotations.json whose items also have a score.",
    )
    add_recording(parser, "RECORDING")
    parser.add_argument(
        "--view", action="append", default=[], metavar="ID", help="a camera to look at; several times for several (all)"
    )
    parser.add_argument(
        "--frames", type=parse_range, default=(None, None), metavar="A:B", help="frames A to B - 1 (all)"
    )
    parser.add_argument(
        "--out", type=Path, metavar="FILE", help=f"file for the joints ({DEFAULT_FILE} in the recording's folder)"
    )
    add_json(parser)
    parser.set_defaults(run=run_guarded(detect, show))


def detect(args: argparse.Namespace) -> dict[str, Any]:
    import numpy as np

    from tracker.detection.recorded_hands import choose_views, detect_hands
    from tracker.landmarks import default_hand_detector

    recording = load_recording(args)
    views = choose_views(recording, args.view)
    frames = choose_frames(args.frames, recording.frame_count)
    out = args.out or recording.folder / DEFAULT_FILE
    if out.is_dir():
        raise TrackerError(f"{out}: is a folder; --out needs the name of a file.")
    if recording.annotations_path is not None and out.resolve() == recording.annotations_path.resolve():
        raise TrackerError(f"{out}: holds the recording's own annotations; give --out another name.")
    line = ProgressLine(f"looking for hands in {recording.name}")
    found, _ = detect_hands(
        recording,
        default_hand_detector(),
        views,
        frames,
        {},
        lambda frame: line.show((frame - frames.start + 1) / len(frames), f"frame {frame}"),
    )
    out.parent.mkdir(parents=True, exist_ok=True)
    found.save(out)
    return {
        "out": str(out),
        "frames": len(frames),
        "views": list(views),
        "left_out_views": [camera.id for camera in recording.cameras if camera.id not in views],
        "frames_with": {
            side: count for side, count in found.count_frames().items() if count or side in recording.hands
        },
        "hidden_joints": int(sum(np.count_nonzero(item.points[:, 2] == 1) for item in found.hands.items)),
        "median_ms": round(1000.0 * float(np.median(found.seconds)), 1),
    }


def show(result: dict[str, Any]) -> str:
    hands = [f"the {side} hand in {count}" for side, count in result["frames_with"].items()] or ["no hand"]
    lines = [
        f"{say_count(result['frames'], 'frame')} of {say_count(len(result['views']), 'view')}: {', '.join(hands)}; "
        f"{result['hidden_joints']} joints hidden by something; median {result['median_ms']:.1f} ms an image"
    ]
    if result["left_out_views"]:
        lines.append(f"not looked at: {', '.join(result['left_out_views'])}")
    return "\n".join([*lines, result["out"]])
