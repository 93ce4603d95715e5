"""`handloom bench`: where the time of a frame goes."""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path
from typing import Any

from tracker.cli.command import add_json, run_guarded
from tracker.cli.progress import ProgressLine
from tracker.errors import TrackerError


def add_command(subparsers: argparse._SubParsersAction) -> None:
    parser = subparsers.add_parser(
        "bench",
        help="where the time of a frame goes",
        description="Track a rendered recording on one thread and print the median time of a frame, of its stages, and "
        "the floor: the sum of its kernels run alone on the same inputs.",
    )
    parser.add_argument("subject", choices=("tracking",))
    parser.add_argument(
        "--twin", type=Path, metavar="FOLDER", help="render twins of T16's data (a default hand otherwise)"
    )
    parser.add_argument("--sequence", default="09", metavar="NN", help="with --twin: a sequence with one hand (09)")
    parser.add_argument("--frames", type=int, default=60, metavar="N", help="how many frames (60)")
    parser.add_argument("--iterations", type=int, default=10, metavar="N", help="iterations a frame (10)")
    add_json(parser)
    parser.set_defaults(run=run_guarded(bench, show))


def bench(args: argparse.Namespace) -> dict[str, Any]:
    from tracker.synthesis.motion import perform
    from tracker.synthesis.twin import load_twin

    if args.frames < 10:
        raise TrackerError(f"--frames {args.frames}: a median needs at least 10.")
    if args.twin is not None:
        performance = load_twin(args.twin, args.sequence, 1500)
        if len(performance.actors) != 1:
            raise TrackerError(
                f"--sequence {args.sequence}: has {len(performance.actors)} models; needed a single hand."
            )
    else:
        from tracker.model.default_hand import default_hand

        performance = perform({"right": default_hand("right")}, "open-close", args.frames)
    return {"one_hand": measure(performance, args.frames, args.iterations)}


def measure(performance, num_frames: int, iterations: int) -> dict[str, Any]:
    """Render, track from the true start and time a performance; ms a frame."""
    from tracker.capture.annotations import load_annotations
    from tracker.cli.floor import measure_floor
    from tracker.model import save_model
    from tracker.synthesis.recording import RecordingOptions, write_recording
    from tracker.tracking.follow import track_frames
    from tracker.tracking.options import TrackOptions
    from tracker.tracking.start import start_tracking
    from tracker.tracking.track import join_chunks

    line = ProgressLine(f"bench {performance.name}")
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary) / "recording"
        moments = range(min(num_frames, performance.num_moments))
        sequence = write_recording(
            performance,
            folder,
            RecordingOptions(moments),
            save_model,
            lambda share: line.show(0.5 * share, "rendering"),
        )
        options = TrackOptions(iterations=iterations, calibrate=False, threads=1)
        models = {actor.name: actor.model for actor in performance.hands}
        setup, state = start_tracking(sequence, options, models, load_annotations(folder / "annotations.json"))
        frames = options.frame_range(sequence.frame_count)
        _, chunk = track_frames(
            sequence, setup, state, frames, lambda frame, _: line.show(0.5 + 0.4 * frame / len(frames), "tracking")
        )
        track = join_chunks(sequence, setup, [chunk])
        floor = measure_floor(sequence, track)
        line.show(1.0)
    summary = track.summary()
    return {
        "median_ms": summary["median_ms"],
        "p95_ms": summary["p95_ms"],
        "floor_ms": round(sum(floor.values()), 3),
        "stages_ms": summary["stages_ms"],
        "floor_stages_ms": {name: round(value, 3) for name, value in floor.items()},
        "frames": summary["frames"],
        "lost": summary["lost"],
        "iterations": iterations,
    }


def show(result: dict[str, Any]) -> str:
    found = result["one_hand"]
    lines = [
        f"one hand: median {found['median_ms']:.1f} ms a frame (p95 {found['p95_ms']:.1f}), "
        f"floor {found['floor_ms']:.1f} ms; "
        f"{found['iterations']} iterations, {found['frames']} frames, {found['lost']} lost",
        f"  {'stage':<16} {'in the frame':>12} {'alone':>8}   ms",
    ]
    alone = found["floor_stages_ms"]
    for name, value in sorted(found["stages_ms"].items(), key=lambda item: -item[1]):
        lines.append(f"  {name:<16} {value:12.2f} {f'{alone[name]:8.2f}' if name in alone else ''}")
    return "\n".join(lines)
