"""Registration of generated scans of unseen subjects against their truth: `python -m benchmarks.registration_study`.

Round 1 registers scans of the six test subjects cold, with the untrained hand: every fifth a fist, every second
without forearm, left and right in turn. Then a model is trained from registrations of the training subjects, and round
2 registers the test scans again, warm and with it. Everything is kept in `--out`: run again, it goes on where it was
stopped; after a change to registration or training take a fresh folder. `--write` writes
`benchmarks/results/registration_study.md`.
"""

from __future__ import annotations

import argparse
import json
import os
import time
from itertools import cycle, islice
from pathlib import Path
from typing import Any

for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS"):
    os.environ.setdefault(variable, "1")

import numpy as np  # noqa: E402

from benchmarks.registration_trial import Trial, is_right, run_trials  # noqa: E402
from benchmarks.result_page import write_result  # noqa: E402
from tracker.cli.progress import ProgressLine  # noqa: E402
from tracker.model.blend_files import save_blend_model  # noqa: E402
from tracker.model.untrained_hand import untrained_hand  # noqa: E402
from tracker.registration.registration_files import load_registration  # noqa: E402
from tracker.synthesis.scans.generate import ScanOptions, generate_truth  # noqa: E402
from tracker.synthesis.scans.pose_list import FISTS, POSE_NAMES  # noqa: E402
from tracker.synthesis.scans.subject import TEST_SUBJECTS, TRAIN_SUBJECTS  # noqa: E402
from tracker.training.options import TrainingOptions  # noqa: E402
from tracker.training.train import train_model  # noqa: E402
from tracker.training.training_set import make_training_set  # noqa: E402

OTHERS = tuple(name for name in POSE_NAMES if name not in FISTS)
FIST_EVERY = 5
TEST_SEED, TRAIN_SEED = 1000, 0
ACCEPTED_P95_MM = 6.0
"""What the oracle on true vertices lets pass: nothing is farther off than about half a finger."""
CURATORS = {"oracle": "an oracle on the true vertices", "verdict": "the program's own verdict"}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, default=Path("out/registration_study"), metavar="DIR")
    parser.add_argument(
        "--processes", type=int, default=1, metavar="N", help="scans at a time; times are honest with 1"
    )
    parser.add_argument("--scans", type=int, default=120, metavar="N", help="of test subjects")
    parser.add_argument("--training-scans", type=int, default=527, metavar="N", help="of training subjects")
    parser.add_argument(
        "--train-on", choices=("own", "truth"), default="own", help="own registrations, or the true vertices"
    )
    parser.add_argument(
        "--curator", choices=("oracle", "verdict"), default="oracle", help="who accepts own registrations"
    )
    parser.add_argument("--strength", type=float, default=1.0, help="of the bulges")
    parser.add_argument("--rounds", type=int, choices=(1, 2), default=2)
    parser.add_argument("--write", action="store_true")
    args = parser.parse_args()
    args.out.mkdir(parents=True, exist_ok=True)
    tests = plan(TEST_SUBJECTS, args.scans, args.strength, args.out / "round1", TEST_SEED)
    first = run(tests, args.processes, "round 1")
    lines = [*describe_round(first, 1)]
    if args.rounds == 2:
        model = args.out / f"model_{args.train_on}_{args.curator}_{args.training_scans}.npz"
        if not model.exists():
            train(args, model)
        again = [t.again(args.out / f"round2_{model.stem}", model) for t in tests]
        lines += describe_round(run(again, args.processes, "round 2"), 2)
        lines += [f"| training of round 2's model | - | {json.loads(model.with_suffix('.json').read_text())['note']} |"]
    table = "\n".join(["| what | bar | measured |", "|---|---|---|", *lines])
    print(table)
    if args.write:
        command = "python -m benchmarks.registration_study --out DIR --write"
        write_result("registration_study", "Registration of generated scans", command, table)


def plan(subjects: tuple[int, ...], count: int, strength: float, folder: Path, seed: int) -> list[Trial]:
    """Scans in turn of all subjects, sides, with and without forearm, every fifth a fist; always the same."""
    fists, others = cycle(FISTS), cycle(OTHERS)
    poses = [next(fists) if number % FIST_EVERY == FIST_EVERY - 1 else next(others) for number in range(count)]
    trials = []
    for number, (pose, subject) in enumerate(zip(poses, islice(cycle(subjects), count), strict=True)):
        turn = number // len(subjects) + number
        side, has_forearm = ("right", "left")[turn % 2], (turn // 2) % 2 == 0
        trials.append(Trial(subject, pose, side, seed + number, has_forearm, strength, folder))
    return trials


def run(trials: list[Trial], processes: int, what: str) -> list[dict[str, Any]]:
    return run_trials(trials, processes, ProgressLine(f"{what}: {len(trials)} scans").show)


def train(args: argparse.Namespace, path: Path) -> None:
    """Train a model and keep it with a note on what it was trained from."""
    trials = plan(TRAIN_SUBJECTS, args.training_scans, args.strength, args.out / "training", TRAIN_SEED)
    if args.train_on == "truth":
        options = ScanOptions(strength=args.strength)
        vertices = [generate_truth(t.subject, t.pose, t.side, t.seed, options).vertices for t in trials]
        kept, note = trials, f"{len(trials)} true registrations"
    else:
        rows = run(trials, args.processes, "training scans")
        kept = [t for t, row in zip(trials, rows, strict=True) if is_accepted(row, args.curator)]
        vertices = [load_registration(t.folder / t.name).vertices for t in kept]
        errors = [row["vertices_mm"] for row in rows if is_accepted(row, args.curator)]
        note = f"{len(kept)} of {len(trials)} own registrations, accepted by {CURATORS[args.curator]}"
        note += f": {np.mean(errors):.2f} mm"
    chosen = make_training_set(
        vertices, [str(t.subject) for t in kept], [t.pose for t in kept], [t.side == "left" for t in kept]
    )
    began = time.process_time()
    training = train_model(chosen, untrained_hand("right"), TrainingOptions(), _show_training())
    note += f"; {time.process_time() - began:.0f} s of processor time"
    path.with_suffix(".json").write_text(json.dumps({"note": note}))
    save_blend_model(training.model, path)


def _show_training():
    line = ProgressLine("training")
    return lambda stage, share: line.show(share, stage)


def is_accepted(row: dict[str, Any], curator: str) -> bool:
    """Whether a curator lets a registration pass: an oracle on the true vertices, or the program itself."""
    if curator == "verdict":
        return row["verdict"] == "good"
    return row["vertices_p95_mm"] < ACCEPTED_P95_MM and row["found_side"] == row["side"]


def describe_round(rows: list[dict[str, Any]], number: int) -> list[str]:
    """Lines of the table for the first or second registration of the test scans."""
    right = [row for row in rows if is_right(row)]
    fists = [row for row in rows if row["pose"] in FISTS]
    cut = [row for row in rows if not row["has_forearm"]]
    good = [row for row in rows if row["verdict"] == "good"]
    accepted_wrong = sum(not is_right(row) for row in good)
    sided = sum(row["found_side"] == row["side"] for row in rows)

    def share(some: list[dict[str, Any]]) -> str:
        return f"{sum(map(is_right, some))} of {len(some)}, {100 * np.mean([is_right(r) for r in some]):.1f} %"

    def mean(key: str, some: list[dict[str, Any]]) -> str:
        values = [row[key] for row in some if row[key] is not None]
        return f"{np.mean(values):.3f}" if values else "-"

    seconds = [row["seconds"] for row in rows]
    processor = [row["processor_seconds"] for row in rows]
    bars = {1: ("4 s", "1.0 mm"), 2: ("0.8 s", "0.7 mm")}[number]
    lines = [
        f"| round {number}, {('cold', 'warm')[number - 1]}: seconds a scan, median (95th percentile); processor time | "
        f"{bars[0]} | {np.median(seconds):.2f} ({np.percentile(seconds, 95):.2f}); {np.median(processor):.2f} |",
        f"| round {number}: true surface to registration, mean over right ones (all), mm | 0.25 mm | "
        f"{mean('surface_mm', right)} ({mean('surface_mm', rows)}) |",
        f"| round {number}: scan to mesh on hand points (noise alone: 0.16), mm | - | "
        f"{mean('scan_to_mesh_mm', right)} ({mean('scan_to_mesh_mm', rows)}) |",
        f"| round {number}: true vertices, mean over right ones (all), mm | {bars[1]} | "
        f"{mean('vertices_mm', right)} ({mean('vertices_mm', rows)}) |",
        f"| round {number}: right (95th percentile below 10 mm) | 95 % | {share(rows)} |",
        f"| round {number}: right among fists; among scans cut at the wrist | - | {share(fists)}; {share(cut)} |",
        f"| round {number}: called good; of those wrong | 2 % | {len(good)} of {len(rows)}; {accepted_wrong}, "
        f"{100 * accepted_wrong / max(len(good), 1):.1f} % |",
        f"| round {number}: left and right told apart | all | {sided} of {len(rows)} |",
    ]
    if number == 2:
        lines.append(f"| round 2: posed joints, mean over right ones, mm | 2.5 mm | {mean('joints_mm', right)} |")
    return lines


if __name__ == "__main__":
    main()
