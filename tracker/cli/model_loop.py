"""`handloom model-loop`: register all scans, train a model from what was accepted, and again with that model."""

from __future__ import annotations

import argparse
import json
from collections import Counter
from pathlib import Path
from typing import Any

from tracker.cli.command import add_json, run_guarded
from tracker.cli.progress import ProgressLine
from tracker.cli.register import UNIT_HELP, list_scans, name_scans, run_jobs
from tracker.cli.train_model import add_training_options, read_accepted, train_from
from tracker.errors import TrackerError


def add_command(subparsers: argparse._SubParsersAction) -> None:
    parser = subparsers.add_parser(
        "model-loop",
        help="register scans and train a hand model, in several rounds",
        description="The loop of [R17] section 3.2: register all scans, take the registrations that are good or "
        "accepted, train a model, register again with that model, train again. OUT/round_1, round_2, ... get "
        "registrations, model.npz and model.json. What is there already is kept: an interrupted run continues where it "
        "stopped.",
    )
    parser.add_argument("scans", type=Path, nargs="+", metavar="SCAN", help="files, or folders with scans")
    parser.add_argument("--out", type=Path, required=True, metavar="DIR")
    parser.add_argument("--rounds", type=int, default=2, metavar="N", help="rounds of registering and training (2)")
    parser.add_argument("--model", type=Path, metavar="FILE", help="the first hand model (default: the untrained hand)")
    parser.add_argument("--metres-per-unit", type=float, metavar="M", help=UNIT_HELP)
    parser.add_argument("--processes", type=int, default=1, metavar="N", help="scans at a time (1)")
    add_training_options(parser)
    add_json(parser)
    parser.set_defaults(run=run_guarded(model_loop, show))


def model_loop(args: argparse.Namespace) -> dict[str, Any]:
    if not 1 <= args.rounds <= 10:
        raise TrackerError(f"--rounds is {args.rounds}; it must be from 1 to 10.")
    if not 1 <= args.processes <= 256:
        raise TrackerError(f"--processes {args.processes}: needed 1 to 256.")
    accepted = read_accepted(args.accepted)
    scans = list(name_scans(list_scans(args.scans)))
    rounds: list[dict[str, Any]] = []
    model = args.model
    for number in range(1, args.rounds + 1):
        folder = args.out / f"round_{number}"
        earlier = args.out / f"round_{number - 1}" / "registrations" if number > 1 else None
        registered = _register(scans, folder / "registrations", model, earlier, number, args)
        rounds.append({"registered": registered, **_train(folder, model, accepted, number, args)})
        model = folder / "model.npz"
    return {"out": str(model), "rounds": rounds}


def _register(
    scans: list[tuple[Path, str]], out: Path, model: Path | None, earlier: Path | None, number: int, args
) -> dict[str, int]:
    """How many registrations have which verdict."""
    from tracker.registration.options import RegistrationOptions

    jobs = [
        (
            path,
            out / name,
            model,
            None if earlier is None else earlier / name,
            RegistrationOptions(),
            args.metres_per_unit,
        )
        for path, name in scans
    ]
    line = ProgressLine(f"round {number}: registering {len(jobs)} scans")
    results: list[dict[str, Any]] = []
    for result in run_jobs(jobs, args.processes, again=False):
        results.append(result)
        line.show(len(results) / len(jobs), f"{result['scan']}: {result['verdict']}")
    if not out.exists():  # nothing was registered, now or earlier
        raise TrackerError("; ".join(str(result["error"]) for result in results[:5]))
    return dict(Counter(result["verdict"] for result in results))


def _train(folder: Path, model: Path | None, accepted: set[str] | None, number: int, args) -> dict[str, Any]:
    """Train, unless the model that is there was trained from just these registrations; what is said of it."""
    from tracker.model.blend_files import load_blend_model
    from tracker.model.untrained_hand import untrained_hand
    from tracker.training.training_set import load_training_set

    out, note = folder / "model.npz", folder / "training.json"
    digest = load_training_set(folder / "registrations", accepted).digest
    wanted = {
        "training_set": digest,
        "rounds": args.rounds_of_training,
        "shapes": args.shapes,
        "plain": args.no_pose_shapes,
        "right_only": args.no_mirrored,
    }
    if out.is_file() and note.is_file():
        try:
            done = json.loads(note.read_text())
            if done["wanted"] == wanted:
                return done["result"]
        except (OSError, ValueError, KeyError, TypeError):
            pass  # trained anew
    initial = load_blend_model(model) if model is not None else untrained_hand("right")
    result = train_from(folder / "registrations", initial, out, f"trained hand, round {number}", accepted, args)
    from tracker.capture.atomic_file import write_atomically

    write_atomically(note, json.dumps({"wanted": wanted, "result": result}, indent=1).encode())
    return result


def show(result: dict[str, Any]) -> str:
    lines = []
    for number, done in enumerate(result["rounds"], 1):
        verdicts = ", ".join(f"{count} {verdict}" for verdict, count in sorted(done["registered"].items()))
        lines.append(
            f"round {number}: {verdicts}; {done['registrations']} learnt from, {done['residual_mm']:.2f} mm from them"
        )
    return "\n".join([*lines, f"the model: {result['out']}"])
