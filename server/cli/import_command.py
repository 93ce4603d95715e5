"""`handloom import`: a recording, labels of one, or scans, from files on this machine into the studio."""

from __future__ import annotations

import argparse
import shlex
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from server.cli.export_command import LABELS, find_recording
from server.cli.guarded import CommandError, add_json, answer, run_guarded
from server.cli.open_studio import open_studio
from tracker import ImportRefusedError, say_count
from tracker.capture import IMPORT_FORMATS

if TYPE_CHECKING:
    from server.cli.open_studio import OpenStudio
    from server.sequences.models import SequenceRow

NUMBERS = {
    "fps": "frames per second",
    "fx": "focal length along x, px",
    "fy": "focal length along y, px; equal to --fx when left out",
    "cx": "principal point x, px",
    "cy": "principal point y, px",
    "depth-scale": "metres per unit of the depth images, 0.001 for millimetres",
    "world-unit-m": "metres per unit of the calibration",
}
SCANS = "scans"
TEXTS = {
    "name": "name of the recording",
    "preset": "a depth camera whose typical values replace those that are not given: "
    + "kinect_v1, kinect_v2, realsense_sr300, ...; the refusal of a recording lists those that fit it",
    "intrinsics": "TUM RGB-D: the camera it was recorded with",
    "depth-pattern": "pattern of the depth images, such as 'depth/depth_*.png'",
    "color-pattern": "pattern of the colour images; 'none' to import depth alone",
    "color-format": "how frames of videos are stored: jpeg or png",
}


def add_command(subparsers: argparse._SubParsersAction) -> None:
    parser = subparsers.add_parser(
        "import",
        help="import a recording, labels, or scans into the studio",
        description="Import a recording into the studio, or with --into labels of recordings that are there. "
        "Everything is imported, or nothing, with the reason. The format is recognised when it can be.",
    )
    parser.add_argument("path", type=Path, metavar="PATH", help="a folder or file")
    parser.add_argument(
        "--format",
        metavar="F",
        help=f"of recordings: {', '.join(IMPORT_FORMATS)}; {SCANS}; of labels: {', '.join(LABELS)}",
    )
    scans = parser.add_argument_group("scans: PLY, OBJ or STL files, or a folder of them, perhaps with a scans.json")
    scans.add_argument("--collection", metavar="NAME", help="what they belong to (the folder's name)")
    scans.add_argument("--subject", metavar="NAME", help="scans: whose hand, if no scans.json says it")
    scans.add_argument("--pose", metavar="NAME", help="scans: which pose, if no scans.json says it")
    scans.add_argument("--side", choices=("right", "left"), help="scans: which hand, if no scans.json says it")
    scans.add_argument("--metres-per-unit", type=float, metavar="N", help="of the files; guessed when left out")
    labels = parser.add_argument_group("labels")
    labels.add_argument("--into", nargs="+", metavar="NAME", help="labels: names or ids of the recordings they are of")
    labels.add_argument(
        "--policy",
        choices=("keep", "replace"),
        help="labels: what to do with hands that have other labels already; without it such labels are refused",
    )
    labels.add_argument("--hand", choices=("right", "left"), help="labels: the hand, for files that hold only one")
    labels.add_argument("--camera", metavar="ID", help="labels: the camera, for files that do not name one")
    labels.add_argument(
        "--pixel-centre", type=float, metavar="N", help="labels: centre of the top-left pixel in the file, 0 or 0.5"
    )
    labels.add_argument(
        "--joint-order", metavar="ORDER", help="labels: order of the joints, for files that number them"
    )
    for name, help_text in NUMBERS.items():
        parser.add_argument(f"--{name}", type=float, metavar="N", help=help_text)
    for name, help_text in TEXTS.items():
        parser.add_argument(f"--{name}", metavar="TEXT", help=help_text)
    parser.add_argument("--distortion", type=_split_numbers, metavar="K1,K2,...", help="OpenCV coefficients")
    parser.add_argument("--hands", type=_split, metavar="right,left", help="hands that are seen")
    parser.add_argument("--allow-gaps", action="store_true", default=None, help="import although frames are missing")
    add_json(parser)
    parser.set_defaults(run=run_guarded(run))


def run(args: argparse.Namespace) -> int:
    path: Path = args.path.expanduser().absolute()
    if not path.exists():
        raise CommandError(f"{args.path}: does not exist; needed a recording's folder or a video.")
    if args.into or args.format in LABELS:
        return _import_labels(args, path)
    if args.format == SCANS or (args.format is None and holds_scans(path)):
        return _import_scans(args, path)
    names = ("format", *NUMBERS, *TEXTS, "distortion", "hands", "allow-gaps")
    given = {name.replace("-", "_"): getattr(args, name.replace("-", "_")) for name in names}
    options = {name: value for name, value in given.items() if value is not None}
    with open_studio() as studio:
        try:
            row = import_recording(studio, path, options)
        except ImportRefusedError as refusal:
            raise CommandError(describe_refusal(args.path, path, options) or str(refusal)) from None
    result = {"id": str(row.id), "name": row.name, "frames": row.frame_count, "report": row.report}
    return answer(args, result, f"{row.name}: {say_count(row.frame_count, 'frame')} imported as {row.id}")


def describe_refusal(told: Path, path: Path, options: dict[str, Any]) -> str:
    """What is wrong, every option that is needed, and a command that has them all; empty when no option would help."""
    from server.imports.service import measure_mesh
    from tracker.capture import ImportOptions, check_import

    report = check_import(path, options.get("format"), ImportOptions.from_json(options), measure=measure_mesh)
    needed = [question for question in report.questions if question.is_required]
    if not needed:
        return ""
    lines = [f"{told}: nothing was imported.", *(f"  {problem}" for problem in report.problems), "Needed:"]
    for question in needed:
        name = f"--{question.field.replace('_', '-')}"
        lines.append(f"  {name:<16} {question.label}: {question.ask}")
        lines += [f"  {'':<16}   {choice.value}  ({choice.detail})" for choice in question.choices if choice.count]
    if report.sensors:
        lines.append("Or --preset with a kind of camera; its values are typical ones, not this camera's calibration:")
        lines += [f"  {fit.name:<22} {fit.label}{', a guess' if fit.is_guess else ''}" for fit in report.sensors]
    lines.append(f"For example: {_write_example(told, options, needed, [fit.name for fit in report.sensors])}")
    return "\n".join(lines)


def _write_example(told: Path, options: dict[str, Any], needed: list[Any], presets: list[str]) -> str:
    """A command with everything that is needed, the proposals where there are some."""
    values = {name: value for name, value in options.items() if name not in {question.field for question in needed}}
    if presets and any(question.field in ("fx", "cx", "cy", "preset") for question in needed):
        values["preset"] = presets[0]
        needed = [q for q in needed if q.field not in ("fx", "fy", "cx", "cy", "depth_scale", "preset")]
    for question in needed:
        values[question.field] = True if question.kind == "boolean" else question.proposal
        if question.proposal is None and question.kind == "choice" and question.choices:
            values[question.field] = question.choices[0].value
    return " ".join(["handloom", "import", shlex.quote(str(told)), *_write_options(values)])


def _write_options(values: dict[str, Any]) -> list[str]:
    """Options of a command; what is not known is an `N`, and True needs no value."""
    words = []
    for name, value in values.items():
        words.append(f"--{name.replace('_', '-')}")
        if value is None:
            words.append("N")
        elif value is not True:
            text = ",".join(map(str, value)) if isinstance(value, (list, tuple)) else str(value)
            words.append(shlex.quote(text))
    return words


def holds_scans(path: Path) -> bool:
    """Whether a path is a scan or a folder of scans, and no recording."""
    suffixes = (".ply", ".obj", ".stl")
    if path.is_file():
        return path.suffix.lower() in suffixes
    if (path / "scans.json").is_file():
        return True
    files = [file for file in path.iterdir() if file.is_file()]
    return any(file.suffix.lower() in suffixes for file in files) and not (path / "sequence.json").exists()


def _import_scans(args: argparse.Namespace, path: Path) -> int:
    import server.app.parts  # the tables that those of scans name
    from server.access.models import LOCAL_ACCOUNT_ID
    from server.scans.adding import add_scans, make_options

    assert server.app.parts.ROUTERS
    names = ("collection", "subject", "pose", "side", "metres_per_unit")
    given = {name: value for name in names if (value := getattr(args, name)) is not None}
    own_name = path.stem if path.is_file() else path.name
    with open_studio() as studio:
        options = make_options({"collection": own_name or "scans"} | given)
        done = add_scans(studio.database, studio.storage, path, options, LOCAL_ACCOUNT_ID, moves=False)
    for refusal in done.refused:
        sys.stderr.write(f"handloom: {refusal.file}: not imported. {refusal.detail}\n")
    for note in done.notes:
        sys.stderr.write(f"handloom: {note}\n")
    if not done.added and not done.known:
        raise CommandError(f"{args.path}: none of {say_count(len(done.refused), 'scan')} could be imported.")
    result = {
        "collection": options.collection,
        "added": [{"id": str(row.id), "name": row.name} for row in done.added],
        "known": [{"id": str(row.id), "name": row.name} for row in done.known],
        "refused": [refusal.model_dump() for refusal in done.refused],
    }
    told = (
        f"{say_count(len(done.added), 'scan')} imported into {options.collection}, {len(done.known)} were there already"
    )
    return answer(args, result, told)


def _import_labels(args: argparse.Namespace, path: Path) -> int:
    from server.access.models import LOCAL_ACCOUNT_ID, Account
    from server.exchange.importing import apply_import, find_problems, plan_import, read_files
    from tracker.label_formats import ImportHints

    if not args.into:
        raise CommandError(f"Labels in {args.format} belong to a recording; say which with --into NAME.")
    hints = ImportHints(args.hand, args.camera, args.pixel_centre, args.joint_order)
    with open_studio() as studio:
        with studio.database.reading() as session:
            rows = [find_recording(session, name) for name in dict.fromkeys(args.into)]
            account = session.get(Account, LOCAL_ACCOUNT_ID)
            assert account is not None
        labels = read_files(studio.storage, path, rows, args.format, hints)
        for warning in labels.found.warnings:
            sys.stderr.write(f"handloom: {warning}\n")
        with studio.database.writing() as session:
            plans = plan_import(session, rows, labels, account)
            if problems := find_problems(labels, plans):
                raise CommandError(f"{args.path}: nothing was imported. {' '.join(problems)}")
            conflicts = [f"frame {c.frame} of {c.camera}, {c.hand}" for p in plans for c in p.conflicts.values()]
            if conflicts and args.policy is None:
                hands = say_count(len(conflicts), "hand is", "hands are")
                raise CommandError(
                    f"{args.path}: {hands} labelled otherwise already ({'; '.join(conflicts[:5])}); "
                    "nothing was imported. Say --policy keep to leave those as they are, or --policy replace."
                )
            done = apply_import(session, studio.storage, rows, labels, account, args.policy or "keep", None)
    recordings = [
        {
            "id": str(item.sequence.id),
            "name": item.sequence.name,
            "added": item.added,
            "replaced": item.replaced,
            "kept": item.kept,
            "locked": item.locked,
            "before": item.before.version if item.before else None,
        }
        for item in done
    ]
    told = "; ".join(
        f"{item['name']}: {say_count(item['added'], 'hand')} added, {item['replaced']} replaced, "
        f"{item['kept']} kept as they were" + (f", {item['locked']} locked" if item["locked"] else "")
        for item in recordings
    )
    result = {"format": labels.format, "warnings": list(labels.found.warnings), "recordings": recordings}
    return answer(args, result, told)


def import_recording(studio: OpenStudio, path: Path, options: dict[str, Any]) -> SequenceRow:
    """Bring a recording in with the annotations it has. Raises when it is refused."""
    from server.access.models import LOCAL_ACCOUNT_ID
    from server.imports.service import ImportContext, import_recording
    from server.sequences.service import get_sequence

    context = ImportContext(studio.database, studio.storage, studio.settings)
    id_ = import_recording(context, path, options, LOCAL_ACCOUNT_ID)
    with studio.database.reading() as session:
        return get_sequence(session, id_)


def _split(text: str) -> list[str]:
    return [part.strip() for part in text.split(",") if part.strip()]


def _split_numbers(text: str) -> list[float]:
    try:
        return [float(part) for part in _split(text)]
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r}: needed numbers separated by commas") from None
