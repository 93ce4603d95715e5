"""`handloom evaluate`: a track against annotations, and against the truth where it is known."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from tracker.cli.command import add_json, run_guarded
from tracker.errors import TrackerError


def add_command(subparsers: argparse._SubParsersAction) -> None:
    parser = subparsers.add_parser(
        "evaluate",
        help="errors of a track",
        description="Errors of a track: in px against annotations ([T16] section 4.1), in mm against the truth of a "
        "synthetic recording.",
    )
    parser.add_argument("track", type=Path, metavar="DIR", help="a folder that `handloom track` wrote")
    parser.add_argument("--annotations", type=Path, metavar="FILE", help="an annotations.json")
    parser.add_argument("--truth", type=Path, metavar="FILE", help="a truth.npz of `handloom synthesize`")
    add_json(parser)
    parser.set_defaults(run=run_guarded(evaluate, show))


def evaluate(args: argparse.Namespace) -> dict[str, Any]:
    from tracker.capture.annotations import load_annotations
    from tracker.capture.truth import load_truth
    from tracker.evaluation import evaluate_against_truth, evaluate_track
    from tracker.tracking.track import load_track

    if args.annotations is None and args.truth is None:
        raise TrackerError("Nothing to compare with: give --annotations FILE, --truth FILE or both.")
    track = load_track(args.track)
    result: dict[str, Any] = {"track": str(args.track)}
    if args.annotations is not None:
        result["annotations"] = evaluate_track(track, load_annotations(args.annotations)).to_json()
    if args.truth is not None:
        result["truth"] = evaluate_against_truth(track, load_truth(args.truth)).to_json()
    return result


def show(result: dict[str, Any]) -> str:
    lines = []
    if "annotations" in result:
        found = result["annotations"]
        lines.append(f"against {found['evaluated']} annotated hands ({len(found['untracked'])} not in the track)")
        lines += [
            _row("all joints", found["joint_error_px"], "px"),
            _row("visible", found["visible_error_px"], "px"),
            _row("occluded", found["occluded_error_px"], "px"),
        ]
        lines += [
            f"  worst: frame {item['frame']}, {item['hand']} hand, {item['mean_px']:.2f} px"
            for item in found["worst"][:3]
        ]
    if "truth" in result:
        found = result["truth"]
        lines.append(f"against the truth of {found['frames']} frames")
        lines += [_row("all joints", found["joint_error_mm"], "mm"), _row("all joints", found["joint_error_px"], "px")]
        lines.append(
            f"  worst frame {found['worst_frame_mm']:.2f} mm; lost {len(found['lost'])}, "
            f"of them unnoticed {len(found['silently_lost'])}"
        )
    return "\n".join(lines)


def _row(name: str, errors: dict[str, Any], unit: str) -> str:
    if errors["count"] == 0:
        return f"  {name:<11} none"
    return (
        f"  {name:<11} mean {errors['mean']:6.2f} {unit}, std {errors['std']:6.2f}, median {errors['median']:6.2f}, "
        f"p95 {errors['p95']:6.2f}, max {errors['max']:7.2f}  ({errors['count']} joints)"
    )
