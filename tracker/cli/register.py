"""`handloom register`: register a hand model to 3D scans."""

from __future__ import annotations

import argparse
import json
import os
import signal
import sys
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tracker.cli.command import add_json, run_guarded
from tracker.cli.progress import ProgressLine
from tracker.errors import RegistrationError, ScanError, TrackerError, say_count

if TYPE_CHECKING:
    from tracker.model.blend_model import BlendModel
    from tracker.registration.options import RegistrationOptions
    from tracker.registration.register import Registrar

Job = tuple[Path, Path, Path | None, Path | None, "RegistrationOptions", float | None]


NO_SCANS = ("truth.npz", "registration.npz", "registration.ply", "registration_surface.ply", "body.npz", "body.ply")
"""Files of other meaning that may lie among scans."""

UNIT_HELP = (
    "unit of the files, where no scans.json says it (metres and millimetres are recognised by the size; other units "
    "must be given)"
)


def add_command(subparsers: argparse._SubParsersAction) -> None:
    parser = subparsers.add_parser(
        "register",
        help="register a hand model to 3D scans",
        description="Register the mesh of a hand model to each scan, without a manual start, and judge the result. For "
        "each scan, OUT/NAME gets registration.npz, registration.ply and registration_surface.ply. Scans whose "
        "registration is there already, with the same scan and model, are skipped: an interrupted run continues where "
        "it stopped.",
    )
    parser.add_argument(
        "scans", type=Path, nargs="+", metavar="SCAN", help="PLY, OBJ, STL or npz; a folder means all scans in it"
    )
    parser.add_argument("--model", type=Path, metavar="FILE", help="the hand model (default: the untrained hand)")
    parser.add_argument("--out", type=Path, required=True, metavar="DIR", help="the folder for the registrations")
    parser.add_argument("--side", choices=("right", "left"), help="which hand, if known (both are tried)")
    parser.add_argument("--metres-per-unit", type=float, metavar="M", help=UNIT_HELP)
    parser.add_argument("--start", type=Path, metavar="DIR", help="begin with these earlier registrations of the scans")
    parser.add_argument("--no-colors", action="store_true", help="keep green points (else taken for an object)")
    parser.add_argument("--processes", type=int, default=1, metavar="N", help="scans at a time (1)")
    parser.add_argument("--again", action="store_true", help="register finished scans again")
    add_json(parser)
    parser.set_defaults(run=run_guarded(register, show))


def register(args: argparse.Namespace) -> list[dict[str, Any]]:
    from tracker.registration.options import RegistrationOptions

    if not 1 <= args.processes <= 256:
        raise TrackerError(f"--processes {args.processes}: needed 1 to 256.")
    paths = list_scans(args.scans)
    if args.model is not None:
        find_registrar(args.model)  # said before anything is begun
    options = RegistrationOptions(side=args.side, use_colors=not args.no_colors)
    jobs: list[Job] = []
    for path, name in name_scans(paths):
        begin = None if args.start is None else args.start / name
        jobs.append((path, args.out / name, args.model, begin, options, args.metres_per_unit))
    line = ProgressLine(f"registering {say_count(len(jobs), 'scan')}")
    results: list[dict[str, Any]] = []
    for result in run_jobs(jobs, args.processes, args.again):
        results.append(result)
        line.show(len(results) / len(jobs), f"{result['scan']}: {result['verdict']}")
    if all("error" in result for result in results):
        raise TrackerError("; ".join(str(result["error"]) for result in results[:5]))
    return results


def list_scans(given: list[Path]) -> list[Path]:
    """The scan files that are meant; those of a folder in the order of their names.

    Raises:
        TrackerError: There are none.
    """
    from tracker.capture.scan import SCAN_SUFFIXES

    paths: list[Path] = []
    for path in given:
        if path.is_dir():
            inside = (p for p in sorted(path.rglob("*")) if p.suffix.lower() in SCAN_SUFFIXES and p.is_file())
            paths += [p for p in inside if p.parent.name != "truth" and p.name not in NO_SCANS]
        else:
            paths.append(path)
    if not paths:
        raise TrackerError(f"No scans in {', '.join(map(str, given))}; needed {', '.join(SCAN_SUFFIXES)}.")
    return paths


def name_scans(paths: list[Path]) -> Iterator[tuple[Path, str]]:
    """Each scan with the name of its folder in OUT: that of the file, or of its folder too where files share names."""
    stems = [path.stem for path in paths]
    is_shared = len(set(stems)) < len(stems)
    taken: dict[str, Path] = {}
    for path in paths:
        name = f"{path.resolve().parent.name}_{path.stem}" if is_shared else path.stem
        if name in taken:
            raise TrackerError(
                f"{path} and {taken[name]} would share the name {name}; register them into separate folders."
            )
        taken[name] = path
        yield path, name


def run_jobs(jobs: list[Job], processes: int, again: bool) -> Iterator[dict[str, Any]]:
    if processes == 1:
        for job in jobs:
            yield register_one(job, again)
        return
    os.environ["OMP_NUM_THREADS"] = os.environ["NUMBA_NUM_THREADS"] = "1"
    with ProcessPoolExecutor(processes, initializer=_leave_interrupts_to_the_parent) as pool:
        try:
            yield from pool.map(register_one, jobs, [again] * len(jobs))
        except BaseException as reason:
            if isinstance(reason, KeyboardInterrupt):
                print("\nhandloom: stopping once the scans under way are registered", file=sys.stderr)
            pool.shutdown(wait=False, cancel_futures=True)
            raise


def _leave_interrupts_to_the_parent() -> None:
    """Ctrl-C reaches all processes of a terminal: what is under way ends first, so that nothing of it is lost."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def register_one(job: Job, again: bool) -> dict[str, Any]:
    """Register one scan to its folder, unless that is done; what `--json` lists of it."""
    from tracker.capture.scan import load_scan
    from tracker.capture.scan_size import measure_size
    from tracker.registration.registration import digest_scan
    from tracker.registration.registration_files import (
        REGISTRATION_FILE,
        load_registration,
        save_registration,
        save_surface,
        summarize_registration,
    )

    path, folder, model_path, start_folder, options, metres_per_unit = job
    try:
        row = _find_row(path)
        said = _read_unit(path, row, metres_per_unit)
        scan = load_scan(path, said)
        size = {"longest_m": round(float(measure_size(scan.points)[0]), 4), "is_unit_guessed": said is None}
        registrar = find_registrar(model_path)
        if not again and (folder / REGISTRATION_FILE).is_file():
            try:
                done = load_registration(folder)
                if (done.scan_digest, done.model_digest) == (digest_scan(scan), registrar.model_digest):
                    return summarize_registration(done) | size
            except RegistrationError:
                pass  # damaged: made anew
        start = None
        if start_folder is not None and (start_folder / REGISTRATION_FILE).is_file():
            earlier = load_registration(start_folder)
            start = earlier.as_start() if earlier.verdict == "good" else None
        registration = registrar.register(scan, options, start)
        labels = {"subject": str(row.get("subject", ""))[:100], "pose_name": str(row.get("pose", ""))[:100]}
        registration = replace(registration, **labels)
        save_surface(registration, folder)
        save_registration(registration, folder)
        return summarize_registration(registration) | size
    except (ScanError, RegistrationError) as error:
        nothing = {"mean": None, "median": None, "p95": None}
        return {
            "scan": path.stem,
            "seconds": 0.0,
            "verdict": "bad",
            "scan_to_mesh_mm": nothing,
            "reasons": [str(error)],
            "error": str(error),
        }


@lru_cache(maxsize=4)
def find_registrar(path: Path | None) -> Registrar:
    """What registers with the model of a file, or with the untrained hand; it is made once for all scans."""
    from tracker.registration.register import Registrar

    return Registrar(load_hand_model(path))


def load_hand_model(path: Path | None) -> BlendModel:
    """The model of a file, or the untrained hand."""
    from tracker.model.blend_files import load_blend_model
    from tracker.model.mano_files import is_mano_npz, load_mano
    from tracker.model.npz_arrays import list_npz_arrays
    from tracker.model.untrained_hand import untrained_hand

    if path is None:
        return untrained_hand()
    if path.suffix.lower() == ".pkl" or (path.suffix == ".npz" and is_mano_npz(list_npz_arrays(path))):
        return load_mano(path)
    return load_blend_model(path)


def _find_row(path: Path) -> dict[str, Any]:
    """The row of a scan in the `scans.json` beside it or one folder up; empty if neither names it."""
    for folder in (path.parent, path.parent.parent):
        row = _read_listing(folder / "scans.json").get(path.stem)
        if row is not None:
            return row
    return {}


def _read_unit(path: Path, row: dict[str, Any], given: float | None) -> float | None:
    """Metres per unit from the row of a scan, else from the command; None when neither gives it."""
    said = row.get("metres_per_unit")
    if said is None:
        return given
    if isinstance(said, bool) or not isinstance(said, int | float):
        raise ScanError(path, f"metres_per_unit {str(said)[:40]!r} in scans.json", "a positive number of metres")
    return float(said)


@lru_cache(maxsize=4)
def _read_listing(path: Path) -> dict[str, dict[str, Any]]:
    """Rows of a `scans.json` by the names of their files; none if there is no such list."""
    try:
        if path.stat().st_size > 64 * 2**20:
            return {}
        document = json.loads(path.read_text())
    except (OSError, ValueError):
        return {}
    rows = document.get("scans") if isinstance(document, dict) else document
    rows = [row for row in rows if isinstance(row, dict)] if isinstance(rows, list) else []
    return {Path(row["file"]).stem: row for row in rows if isinstance(row.get("file"), str)}


def show(results: list[dict[str, Any]]) -> str:
    lines = []
    for result in results:
        distance = result["scan_to_mesh_mm"]["median"]
        told = "" if distance is None else f"{distance:.2f} mm median scan to mesh, "
        why = f"; {result['reasons'][0]}" if result["verdict"] != "good" and result["reasons"] else ""
        length = _write_size(result)
        lines.append(f"{result['scan']}: {result['verdict']}, {told}{length}{result['seconds']:.1f} s{why}")
    counts = {name: sum(r["verdict"] == name for r in results) for name in ("good", "doubtful", "bad")}
    return "\n".join([*lines, ", ".join(f"{count} {name}" for name, count in counts.items())])


def _write_size(result: dict[str, Any]) -> str:
    """How long a scan is, and whether its unit is a guess."""
    if "longest_m" not in result:
        return ""
    guessed = " (its unit is a guess; --metres-per-unit says it)" if result["is_unit_guessed"] else ""
    return f"{100 * result['longest_m']:.1f} cm long{guessed}, "
