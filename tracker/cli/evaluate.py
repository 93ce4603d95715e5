"""`handloom evaluate`: a track against annotations, and against the truth where it is known."""

from __future__ import annotations

import argparse
import hashlib
import json
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tracker.cli.command import add_json, run_guarded
from tracker.errors import TrackerError

if TYPE_CHECKING:
    from tracker.capture.sequence import Sequence
    from tracker.evaluation.evaluation import Evaluation
    from tracker.tracking.track import Track

REPORTS = (".html", ".csv", ".json")


def add_command(subparsers: argparse._SubParsersAction) -> None:
    parser = subparsers.add_parser(
        "evaluate",
        help="errors of a track",
        description="Errors of a track: in px against annotations ([T16] section 4.1), in mm against the truth of a "
        "synthetic recording.",
    )
    parser.add_argument("track", type=Path, metavar="DIR", help="a folder that `handloom track` wrote")
    parser.add_argument("--annotations", type=Path, metavar="FILE", help="an annotations.json")
    parser.add_argument(
        "--sources",
        default="independent",
        metavar="WORDS",
        help="annotations: which joints count, by their source: independent (no track had a part in them), "
        "all, or some of hand, unknown, import, triangulation, interpolation, copy, fit, detector, track, separated "
        "by commas; default: independent",
    )
    parser.add_argument("--truth", type=Path, metavar="FILE", help="a truth.npz of `handloom synthesize`")
    parser.add_argument(
        "--report", type=Path, metavar="FILE", help="write the errors against annotations as .html, .csv or .json"
    )
    parser.add_argument(
        "--recording",
        type=Path,
        metavar="PATH",
        help="the recording, for pictures of the worst frames in an .html report; usually beside the annotations",
    )
    add_json(parser)
    parser.set_defaults(run=run_guarded(evaluate, show))


def evaluate(args: argparse.Namespace) -> dict[str, Any]:
    from tracker.capture.annotations import load_annotations
    from tracker.capture.source_choice import choose_sources
    from tracker.capture.truth import load_truth
    from tracker.evaluation import evaluate_against_truth, evaluate_track
    from tracker.tracking.track import load_track

    if args.annotations is None and args.truth is None:
        raise TrackerError("Nothing to compare with: give --annotations FILE, --truth FILE or both.")
    if args.report is not None and args.annotations is None:
        raise TrackerError("A report is about annotations: give --annotations FILE too.")
    sources = choose_sources(args.sources)
    track = load_track(args.track)
    result: dict[str, Any] = {"track": str(args.track)}
    if args.annotations is not None:
        evaluation = evaluate_track(track, load_annotations(args.annotations), sources)
        result["annotations"] = evaluation.to_json()
        if args.report is not None:
            write_report(args, track, evaluation)
            result["report"] = str(args.report)
    if args.truth is not None:
        result["truth"] = evaluate_against_truth(track, load_truth(args.truth)).to_json()
    return result


def write_report(args: argparse.Namespace, track: Track, evaluation: Evaluation) -> None:
    """The file that `--report` names."""
    from tracker.capture.atomic_file import write_atomically
    from tracker.evaluation.comparison import JudgedTrack, compare_tracks
    from tracker.evaluation.report_csv import write_csv
    from tracker.evaluation.report_html import write_html

    kind = args.report.suffix.lower()
    if kind not in REPORTS:
        raise TrackerError(f"The report {args.report} ends in {kind or 'nothing'}; needed one of {', '.join(REPORTS)}.")
    recording = _find_recording(args)
    judged = JudgedTrack(
        key="track",
        name=args.track.resolve().name,
        recording_key="recording",
        recording=recording.name if recording is not None else args.annotations.resolve().parent.name,
        parameters=track.setup.options.to_json(),
        evaluation=evaluation,
        labels={"file": args.annotations.name, "sha256": hashlib.sha256(args.annotations.read_bytes()).hexdigest()},
        origin={"sha256": hashlib.sha256((args.track / "track.npz").read_bytes()).hexdigest()},
    )
    document = compare_tracks([judged])
    if kind == ".json":
        text = json.dumps(document, indent=1)
    elif kind == ".csv":
        text = write_csv([judged])
    else:
        pictures = {} if recording is None else _draw_pictures(recording, evaluation)
        now = datetime.now(UTC).strftime("%Y-%m-%d %H:%M UTC")
        text = write_html(document, pictures, title=f"{judged.name} of {judged.recording}", made_at=now)
    write_atomically(args.report, text.encode())


def _find_recording(args: argparse.Namespace) -> Sequence | None:
    from tracker.capture.sequence import load_sequence

    if args.recording is not None:
        return load_sequence(args.recording)
    beside = args.annotations.resolve().parent
    return load_sequence(beside) if (beside / "sequence.json").is_file() else None


def _draw_pictures(recording: Sequence, evaluation: Evaluation) -> dict[tuple[str, int], bytes]:
    from tracker.evaluation.comparison import WORST
    from tracker.evaluation.worst_picture import draw_item, encode_jpeg

    return {
        ("track", place): encode_jpeg(draw_item(recording, evaluation, item))
        for place, item in enumerate(evaluation.worst_items(WORST))
    }


def show(result: dict[str, Any]) -> str:
    from tracker.capture.source_choice import say_left_out

    lines = []
    if "annotations" in result:
        found = result["annotations"]
        lines.append(f"against {found['evaluated']} annotated hands ({len(found['untracked'])} not in the track)")
        counted, left_out = (
            [(one["words"], one["joints"]) for one in found["sources"] if one["is_counted"] == is_counted]
            for is_counted in (True, False)
        )
        lines.append("judged by " + (", ".join(f"{count} joints {words}" for words, count in counted) or "no joint"))
        lines += [f"{say_left_out(left_out)} --sources all counts them too."] if left_out else []
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
    if "report" in result:
        lines.append(f"report: {result['report']}")
    return "\n".join(lines)


def _row(name: str, errors: dict[str, Any], unit: str) -> str:
    if errors["count"] == 0:
        return f"  {name:<11} none"
    return (
        f"  {name:<11} mean {errors['mean']:6.2f} {unit}, std {errors['std']:6.2f}, median {errors['median']:6.2f}, "
        f"p95 {errors['p95']:6.2f}, max {errors['max']:7.2f}  ({errors['count']} joints)"
    )
