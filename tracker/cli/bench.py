"""`handloom bench`: where the time of a frame goes."""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tracker.cli.bench_registration import add_registration
from tracker.cli.command import add_json, run_guarded
from tracker.cli.progress import ProgressLine
from tracker.errors import TrackerError
from tracker.fitting.options import TrackOptions

if TYPE_CHECKING:
    from tracker.synthesis.performance import Performance


CASES = {
    "one_hand": ("09", "LO+SC"),
    "two_hands": ("01", "LO+SC"),
    "two_hands_object_physics": ("17", "LO+SCP"),
}
"""Name to the twin that stands for it, and its terms."""


def add_command(subparsers: argparse._SubParsersAction) -> argparse._SubParsersAction:
    """Add `bench`; gives what further subjects are added to."""
    parser = subparsers.add_parser("bench", help="measure speed", description="Measure speed on this machine.")
    subjects = parser.add_subparsers(required=True, metavar="SUBJECT")
    _add_tracking(subjects)
    add_registration(subjects)
    return subjects


def _add_tracking(subjects: argparse._SubParsersAction) -> None:
    parser = subjects.add_parser(
        "tracking",
        help="where the time of a frame goes",
        description="Track rendered recordings of one hand, two hands, and two hands with an object and physics on "
        "every frame, and print the median time of a frame, of its stages, and the floor: the sum of its kernels run "
        "alone on the same inputs.",
    )
    parser.add_argument(
        "--twin", type=Path, metavar="FOLDER", help="render twins of T16's data (default hands and a ball otherwise)"
    )
    parser.add_argument("--case", nargs="+", choices=tuple(CASES), default=list(CASES), help="which (all)")
    parser.add_argument("--frames", type=int, default=60, metavar="N", help="how many frames (60)")
    parser.add_argument("--iterations", type=int, default=10, metavar="N", help="iterations a frame (10)")
    parser.add_argument("--threads", type=int, default=1, metavar="N", help="threads (1)")
    add_json(parser)
    parser.set_defaults(run=run_guarded(bench, show))


def bench(args: argparse.Namespace) -> dict[str, Any]:
    if args.frames < 10:
        raise TrackerError(f"--frames is {args.frames}; needed at least 10.")
    return {
        case: measure(
            _perform(case, args.twin, args.frames),
            args.frames,
            TrackOptions(terms=CASES[case][1], iterations=args.iterations, calibrate=False, threads=args.threads),
        )
        for case in _find_able(args.case)
    }


def _find_able(cases: list[str]) -> list[str]:
    """Those that this Python can run; says on stderr which it leaves out."""
    from tracker.physics import find_physics_fault

    if not (fault := find_physics_fault()):
        return cases
    with_physics = [case for case in cases if "P" in CASES[case][1]]
    if with_physics:
        sys.stderr.write(f"bench: {', '.join(with_physics)} is left out. {fault}\n")
    return [case for case in cases if case not in with_physics]


def _perform(case: str, twin: Path | None, num_frames: int) -> Performance:
    from tracker.model.default_hand import default_hand
    from tracker.synthesis.ball import with_ball
    from tracker.synthesis.motion import perform
    from tracker.synthesis.twin import load_twin

    if twin is not None:
        return load_twin(twin, CASES[case][0], 1500)
    sides = ("right",) if case == "one_hand" else ("right", "left")
    performance = perform({side: default_hand(side) for side in sides}, "open-close", num_frames)
    return with_ball(performance) if "object" in case else performance


def measure(performance: Performance, num_frames: int, options: TrackOptions) -> dict[str, Any]:
    """Render, track from the true start and time a performance; ms a frame."""
    from tracker.capture.annotations import load_annotations
    from tracker.cli.floor import measure_floor
    from tracker.model import save_model
    from tracker.synthesis.recording import RecordingOptions, write_recording
    from tracker.tracking.follow import track_frames
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
        models = {actor.name: actor.model for actor in performance.actors}
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
        "iterations": options.iterations,
        "terms": options.terms,
        "threads": options.threads,
    }


def show(result: dict[str, Any]) -> str:
    return "\n".join(_show_case(name.replace("_", " "), found) for name, found in result.items())


def _show_case(name: str, found: dict[str, Any]) -> str:
    ratio = found["median_ms"] / found["floor_ms"]
    lines = [
        f"{name}: median {found['median_ms']:.1f} ms a frame (p95 {found['p95_ms']:.1f}), "
        f"floor {found['floor_ms']:.1f} ms, ratio {ratio:.2f}; {found['terms']}, "
        f"{found['iterations']} iterations, {found['frames']} frames, {found['lost']} lost",
        f"  {'stage':<16} {'in the frame':>12} {'alone':>8}   ms",
    ]
    alone = found["floor_stages_ms"]
    for stage, value in sorted(found["stages_ms"].items(), key=lambda item: -item[1]):
        lines.append(f"  {stage:<16} {value:12.2f} {f'{alone[stage]:8.2f}' if stage in alone else ''}")
    return "\n".join(lines)
