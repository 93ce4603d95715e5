"""`handloom register-body`: register the body with hands to 3D scans of people."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tracker.cli.command import add_json, run_guarded
from tracker.cli.progress import ProgressLine
from tracker.cli.register import list_scans, name_scans
from tracker.errors import RegistrationError, ScanError, TrackerError, say_count

if TYPE_CHECKING:
    from tracker.bodies.register_body import Registrar


def add_command(subparsers: argparse._SubParsersAction) -> None:
    parser = subparsers.add_parser(
        "register-body",
        help="register the body with hands to 3D scans of people",
        description="Register the body with both hands to each scan of a whole person, without a manual start, and "
        "judge the result ([R17] section 4). For each scan, OUT/NAME gets body.npz and body.ply. Scans that were "
        "registered already, with the same points and model, are skipped, so an interrupted run continues.",
    )
    parser.add_argument(
        "scans", type=Path, nargs="+", metavar="SCAN", help="PLY, OBJ, STL or npz; a folder means all scans in it"
    )
    parser.add_argument("--out", type=Path, required=True, metavar="DIR", help="the folder for the registrations")
    parser.add_argument("--model", type=Path, metavar="FILE", help="a body of SMPL-H's class, .npz or .pkl")
    parser.add_argument(
        "--population", choices=("neutral", "male", "female"), default="neutral", help="population of the bundled body"
    )
    parser.add_argument(
        "--metres-per-unit", type=float, metavar="M", help="unit of the files (recognised by the size of a person)"
    )
    parser.add_argument("--again", action="store_true", help="register finished scans again")
    add_json(parser)
    parser.set_defaults(run=run_guarded(register_bodies, show))


def register_bodies(args: argparse.Namespace) -> list[dict[str, Any]]:
    from tracker.bodies.register_body import Registrar

    paths = list(name_scans(list_scans(args.scans)))
    registrar = Registrar(load_body(args.model, args.population))
    line = ProgressLine(f"registering {say_count(len(paths), 'scan')}")
    results: list[dict[str, Any]] = []
    for number, (path, name) in enumerate(paths):

        def tell(stage: str, share: float, number: int = number, name: str = name) -> None:
            line.show((number + share) / len(paths), f"{name}: {stage}")

        results.append(register_one(registrar, path, args.out / name, args.metres_per_unit, args.again, tell))
    line.show(1.0, "done")
    if all("error" in result for result in results):
        raise TrackerError("; ".join(str(result["error"]) for result in results[:5]))
    return results


def register_one(
    registrar: Registrar, path: Path, folder: Path, metres_per_unit: float | None, again: bool, tell
) -> dict[str, Any]:
    """Register one scan to its folder, unless that is done; a scan that cannot be is said by name, and no more."""
    from tracker.bodies.body_registration import BODY_FILE, load_body_registration, save_body_registration
    from tracker.bodies.body_scan_file import load_body_scan
    from tracker.registration.registration import digest_scan

    try:
        scan, is_guessed = load_body_scan(path, metres_per_unit)
        if not again and (folder / BODY_FILE).is_file():
            try:
                done = load_body_registration(folder)
                if (done.scan_digest, done.model_digest) == (digest_scan(scan), registrar.model_digest):
                    return done.summary() | {"is_unit_guessed": is_guessed}
            except RegistrationError:
                pass  # damaged: made anew
        registration = registrar.register(scan, progress=tell)
        save_body_registration(registration, registrar.model.faces, folder)
        return registration.summary() | {"is_unit_guessed": is_guessed}
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


def load_body(path: Path | None, population: str):
    """The body of a file, or the one that comes with Handloom.

    Raises:
        TrackerError: No model of a body.
    """
    from tracker.model.body_model import body_model, load_body_model
    from tracker.model.mano_files import is_mano_npz, load_mano
    from tracker.model.npz_arrays import list_npz_arrays

    if path is None:
        return body_model(population)
    if path.suffix.lower() == ".pkl" or (path.suffix == ".npz" and is_mano_npz(list_npz_arrays(path))):
        model = load_mano(path)
    else:
        return load_body_model(path).of(population)
    if model.side != "body" or model.num_bones != 52:
        raise TrackerError(
            f"{path}: a model of {model.num_bones} joints ({model.side}); needed a body of SMPL-H's class, 52 joints."
        )
    return model


def show(results: list[dict[str, Any]]) -> str:
    lines = []
    for result in results:
        median = result["scan_to_mesh_mm"]["median"]
        told = "" if median is None else f"{median:.2f} mm median scan to mesh, {result['seconds']:.1f} s"
        guessed = ", its unit is a guess" if result.get("is_unit_guessed") else ""
        why = f"; {'; '.join(result['reasons'])}" if result["reasons"] else ""
        lines.append(f"{result['scan']}: {result['verdict']}{', ' if told else ''}{told}{guessed}{why}")
    counts = {name: sum(r["verdict"] == name for r in results) for name in ("good", "doubtful", "bad")}
    return "\n".join([*lines, ", ".join(f"{count} {name}" for name, count in counts.items())])
