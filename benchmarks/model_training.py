"""Train hand models from generated registrations and judge them on other people: `python -m benchmarks.model_training`.

Learnt from: 31 people x 51 poses of the generator, right and left by turns, true vertices as registrations. Judged on:
scans of six other people. With `--own DIR`, models from registrations of our own too: DIR/scans gets scans, DIR/loop
what `handloom model-loop` makes of them; an interrupted run goes on where it stopped. `--write` writes tables,
curves and figures to `benchmarks/results/model_training.*`.
"""

from __future__ import annotations

import argparse
import json
import resource
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.distance_weights import with_distance_weights
from benchmarks.result_page import RESULTS, write_result
from tracker.capture.atomic_file import write_atomically
from tracker.capture.scan import save_scan
from tracker.cli.__main__ import main as handloom
from tracker.evaluation.model_curves import draw_study
from tracker.evaluation.model_study import (
    TestHand,
    describe_compactness,
    find_template,
    generalize_poses,
    generalize_shapes,
    judge_model,
    measure_floor,
)
from tracker.evaluation.scan_fit import without_pose_shapes
from tracker.model.blend_files import load_blend_model
from tracker.model.blend_model import BlendModel
from tracker.model.untrained_hand import untrained_hand
from tracker.synthesis.scans.generate import generate_scan, generate_truth
from tracker.synthesis.scans.pose_list import POSE_NAMES
from tracker.synthesis.scans.subject import TEST_SUBJECTS, TRAIN_SUBJECTS
from tracker.training.options import TrainingOptions
from tracker.training.train import Training, train_model
from tracker.training.training_set import TrainingSet, make_training_set

COUNTS = (0, 1, 2, 3, 4, 6, 8, 10, 15, 20, 30, 45)
SHAPES, LOCAL_SHAPES = 10, 40
"""Directions of the whole hand, and of parts: chosen on people 26 to 31 with models of the 25 others."""
SHAPE_COUNTS = (0, 1, 2, 3, 4, 5, 6, 8, 10, 15, 20, 25)
FLAT = "flat_together"
UNTRAINED = ("weights by distance, size only", "untrained, size only", "untrained")
"""All shapes fitted where nothing is said."""


def make_truths(people: int, poses: int) -> TrainingSet:
    """True vertices of so many people in so many poses, right and left hands by turns."""
    rng = np.random.default_rng(0)
    truths = []
    for subject in TRAIN_SUBJECTS[:people]:
        others = rng.permutation(np.arange(1, len(POSE_NAMES)))[: poses - 1]
        for number, pose in enumerate([0, *sorted(others)]):
            truths.append(generate_truth(subject, int(pose), "right" if number % 2 == 0 else "left"))
    return make_training_set(
        [truth.vertices for truth in truths],
        [f"s{truth.subject:02d}" for truth in truths],
        [truth.pose_name for truth in truths],
        [truth.side == "left" for truth in truths],
    )


def make_tests(poses: int, subjects=TEST_SUBJECTS) -> tuple[list[TestHand], dict[str, np.ndarray]]:
    """Scans of people that nothing is learnt from, so many each, and true vertices of each one's flat hand."""
    rng = np.random.default_rng(5)
    hands, flats = [], {}
    for subject in subjects:
        flats[f"s{subject:02d}"] = generate_truth(subject, FLAT).vertices
        for pose in rng.choice(np.arange(1, len(POSE_NAMES)), poses, replace=False):
            made = generate_scan(subject, int(pose))
            ids = rng.permutation(np.flatnonzero(made.is_hand))[:15_000]
            hands.append(
                TestHand(
                    f"s{subject:02d}",
                    made.pose_name,
                    made.scan.points[ids],
                    made.scan.normals[ids],
                    made.true_vertices,
                    made.joints,
                )
            )
        print(f"scanned s{subject:02d}", flush=True)
    return hands, flats


def train(training_set: TrainingSet, options: TrainingOptions) -> tuple[Training, dict[str, float]]:
    """A model and what it took."""
    wall, cpu = time.monotonic(), time.process_time()
    training = train_model(training_set, untrained_hand("right"), options)
    cost = {
        "seconds": round(time.monotonic() - wall, 1),
        "cpu_seconds": round(time.process_time() - cpu, 1),
        "gigabytes": round(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20, 2),
    }
    print(
        f"{options.name}: {len(training_set)} registrations, {cost}, rounds {training.report['rounds_mm']}", flush=True
    )
    return training, cost


def judge(name: str, model: BlendModel, hands: list[TestHand], templates=None) -> dict[str, Any]:
    found = judge_model(model, hands, templates).summarize()
    print(name, found, flush=True)
    return {"model": name, "fitted": "pose and shape" if templates is None else "pose, own template", **found}


def judge_untrained(crude: BlendModel, hands: list[TestHand]) -> list[dict[str, Any]]:
    """What trained models are compared with, the crudest last."""
    return [
        judge("untrained", crude, hands),
        judge("untrained, size only", size_only(crude), hands),
        judge("weights by distance, size only", size_only(with_distance_weights(crude)), hands),
    ]


def size_only(model: BlendModel) -> BlendModel:
    """The model with nothing but its overall size to fit."""
    return replace(model, shape_directions=0.1 * model.template[:, :, None])


def keep_shapes(model: BlendModel, count: int) -> BlendModel:
    """The model with its first shape directions alone."""
    return replace(model, shape_directions=np.ascontiguousarray(model.shape_directions[:, :, :count]))


def study(args: argparse.Namespace) -> dict[str, Any]:
    truths = make_truths(args.people, args.poses)
    hands, flats = make_tests(args.test_poses)
    options = TrainingOptions(name="learned", threads=2, num_shapes=SHAPES, num_local_shapes=LOCAL_SHAPES)
    train(truths.select(np.arange(2 * args.poses)), replace(options, name="warm-up", rounds=1))
    learned, cost = train(truths, options)
    plain, _ = train(truths, replace(options, name="plain skinning", with_pose_shapes=False))
    right_only, _ = train(truths, replace(options, name="right hands only", with_mirrored=False))
    crude = untrained_hand("right")
    models = {"learned": learned.model, "plain skinning": plain.model, "right hands only": right_only.model}
    templates = {
        name: {who: find_template(model, flat) for who, flat in flats.items()} for name, model in models.items()
    }
    rows = [
        *judge_untrained(crude, hands),
        *(judge(name, model, hands) for name, model in models.items()),
        judge("learned, whole hand's shapes alone", keep_shapes(learned.model, SHAPES), hands),
        *(judge(name, model, hands, templates[name]) for name, model in models.items()),
        judge("learned, blend shapes off", without_pose_shapes(learned.model), hands, templates["learned"]),
    ]
    few = hands[:: max(1, len(hands) // 24)]
    people = np.array([hand.split(" ")[0] for hand in learned.report["by_hand"]])
    return {
        "registrations": len(truths),
        "test_scans": len(hands),
        "floor_mm": round(measure_floor(crude, hands), 4),
        "training": {**cost, **{k: learned.report[k] for k in ("residual_mm", "rounds_mm")}},
        "rows": rows,
        "compactness": describe_compactness(learned.report),
        "pose_space": {
            "left and right hands": generalize_poses(learned.model, few, templates["learned"], COUNTS),
            "right hands only": generalize_poses(right_only.model, few, templates["right hands only"], COUNTS),
        },
        "shape_space": {"people left out": generalize_shapes(learned.templates, people, SHAPE_COUNTS)},
        "own": study_own(args, hands, crude) if args.own else None,
    }


def study_own(args: argparse.Namespace, hands: list[TestHand], crude: BlendModel) -> list[dict[str, Any]]:
    """Models of the loop's rounds, from scans alone."""
    write_own_scans(args.own / "scans", args.own_people, args.own_poses)
    command = ["model-loop", str(args.own / "scans"), "--out", str(args.own / "loop"), "--shapes", str(SHAPES)]
    command += ["--local-shapes", str(LOCAL_SHAPES)]
    if handloom([*command, "--processes", str(args.processes)]) != 0:
        raise SystemExit("the loop failed")
    rows = []
    for number in (1, 2):
        folder = args.own / "loop" / f"round_{number}"
        report = json.loads((folder / "model.json").read_text())
        rows.append(judge(f"own registrations, round {number}", load_blend_model(folder / "model.npz"), hands))
        rows[-1]["registrations"] = report["registrations"]
    return rows


def write_own_scans(folder: Path, people: int, poses: int) -> None:
    """PLY files with `scans.json`; each person's flat hand and other poses of their own."""
    folder.mkdir(parents=True, exist_ok=True)
    rng = np.random.default_rng(11)
    listing = []
    for subject in TRAIN_SUBJECTS[:people]:
        flat = "flat_together" if rng.random() < 0.5 else "flat_spread"
        others = [POSE_NAMES[n] for n in rng.choice(np.arange(2, len(POSE_NAMES)), poses - 1, replace=False)]
        for pose in (flat, *others):
            path = folder / f"s{subject:02d}_{POSE_NAMES.index(pose):02d}.ply"
            if not path.is_file():
                save_scan(generate_scan(subject, pose).scan, path)
            listing.append({"file": path.name, "subject": f"s{subject:02d}", "pose": pose})
    (folder / "scans.json").write_text(json.dumps({"scans": listing}))


def find_ratios(found: dict[str, Any]) -> list[tuple[str, float, float]]:
    """What is measured against a bar: its name, the figure, the bar."""
    rows = {(row["model"], row["fitted"][4:8]): row for row in found["rows"]}
    shaped, own = " and", ", ow"

    def ratio(measure: str, a: tuple[str, str], b: tuple[str, str]) -> float:
        return rows[a][measure] / rows[b][measure]

    learned, s2m = ("learned", own), "scan_to_mesh_mm"
    ratios = [
        ("learned / its blend shapes switched off, scan to mesh, own template",
         ratio(s2m, learned, ("learned, blend shapes off", own)), 0.62),
        ("learned / plain skinning trained by itself, vertices, own template",
         ratio("vertices_mm", learned, ("plain skinning", own)), 0.55),
        *((f"learned / {name}, scan to mesh", ratio(s2m, ("learned", shaped), (name, shaped)), 0.31)
          for name in UNTRAINED),
        ("posed joints, pose and shape fitted to vertices, mm", rows["learned", shaped]["joints_mm"], 2.5),
        ("posed joints, pose and shape fitted to scans, mm", rows["learned", shaped]["scan_joints_mm"], 2.5),
        ("training, seconds", found["training"]["seconds"], 240.0),
        ("training, memory, GB", found["training"]["gigabytes"], 4.0),
    ]  # fmt: skip
    if found["own"]:
        own_rows = {row["model"]: row for row in found["own"]}
        second, first = own_rows["own registrations, round 2"], own_rows["own registrations, round 1"]
        for name in UNTRAINED:
            untrained = rows[name, shaped][s2m]
            ratios.append((f"own registrations / {name}, scan to mesh", second[s2m] / untrained, 0.38))
        ratios.append(("own registrations, round 2 / round 1, scan to mesh", second[s2m] / first[s2m], 1.0))
        ratios.append(("own registrations, round 2 / round 1, vertices",
                       second["vertices_mm"] / first["vertices_mm"], 1.0))  # fmt: skip
    return ratios


def write_tables(found: dict[str, Any]) -> list[str]:
    lines = ["| what | measured | bar |", "|---|---|---|"]
    lines += [f"| {name} | {value:.3g} | {bar:g} |" for name, value, bar in find_ratios(found)]
    lines += ["", "| model | fitted | scan to mesh, mm | vertices, mm | joints, mm | joints, fitted to scans, mm |"]
    lines += ["|---|---|---|---|---|---|"]
    for row in [*found["rows"], *(found["own"] or [])]:
        name = row["model"] + (f" ({row['registrations']})" if "registrations" in row else "")
        lines.append(
            f"| {name} | {row['fitted']} | {row['scan_to_mesh_mm']:.3f} ± {row['scan_to_mesh_sd_mm']:.3f} "
            f"| {row['vertices_mm']:.3f} | {row['joints_mm']:.2f} | {row['scan_joints_mm']:.2f} |"
        )
    training = found["training"]
    lines += [
        "",
        f"{found['registrations']} registrations, {found['test_scans']} test scans; training took "
        f"{training['seconds']:.0f} s ({training['cpu_seconds']:.0f} s of processor time, two threads) and "
        f"{training['gigabytes']:.2f} GB. The true vertices themselves are {found['floor_mm']:.3f} mm from the scans: "
        "sensor noise, and skin between vertices that bulging triangles do not follow.",
    ]
    return lines


def write_results(found: dict[str, Any]) -> None:
    drawings = {f"model_{name}.svg": drawing for name, drawing in draw_study(found).items()}
    shown = [f"![{name}]({name})" for name in drawings]
    text = "\n".join([*write_tables(found), "", *shown])
    write_result("model_training", "Training of a hand model", "python -m benchmarks.model_training --write", text)
    write_atomically(RESULTS / "model_training.json", (json.dumps(found, indent=1) + "\n").encode())
    for name, drawing in drawings.items():
        write_atomically(RESULTS / name, drawing.encode())


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--people", type=int, default=31)
    parser.add_argument("--poses", type=int, default=51)
    parser.add_argument("--test-poses", type=int, default=8, help="of each of six people")
    parser.add_argument("--own", type=Path, metavar="DIR", help="train from registrations of our own too, kept in DIR")
    parser.add_argument("--own-people", type=int, default=30)
    parser.add_argument("--own-poses", type=int, default=12)
    parser.add_argument("--processes", type=int, default=2, help="registrations at a time")
    parser.add_argument("--write", action="store_true", help="write benchmarks/results/model_training.*")
    args = parser.parse_args()
    found = study(args)
    print("\n".join(write_tables(found)))
    if args.write:
        write_results(found)


if __name__ == "__main__":
    main()
