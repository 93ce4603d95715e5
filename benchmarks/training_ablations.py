"""What each choice of training is worth: `python -m benchmarks.training_ablations [--real FOLDER] [--out FILE]`.

Models are trained from the true vertices of 31 generated people, each with one thing done otherwise, and judged on
scans of six other generated people and on the real scans of FOLDER, one hand in three poses (left out without it).
With `--choose`, models of people 1 to 25 are judged on people 26 to 31: choices are made there, not on test people.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np
import numpy.typing as npt

from benchmarks.model_training import LOCAL_SHAPES, SHAPES, keep_shapes, make_tests, make_truths, train
from benchmarks.scan_rotations import MARKS, METRES_PER_UNIT
from tracker.capture.scan import load_scan
from tracker.evaluation.model_study import TestHand, find_template, judge_model
from tracker.evaluation.scan_fit import without_pose_shapes
from tracker.model.blend_model import BlendModel
from tracker.model.untrained_hand import untrained_hand
from tracker.registration.register import Registrar
from tracker.synthesis.scans.subject import TEST_SUBJECTS, TRAIN_SUBJECTS
from tracker.training.options import TrainingOptions
from tracker.training.pose_shapes import REACH

Array = npt.NDArray[np.float64]
COMPONENTS = (6, 10, 15, None)
CHOOSERS = 25
LEARN = "tracker.training.learn"


def everywhere_alike(template: Array, regressor) -> Array:
    """(B-1, V) the distance at which the cost is the usual one, m: Eq. 10 left out."""
    return np.full((regressor.shape[0] - 1, len(template)), REACH)


def weigh_evenly(poses, owners) -> Array:
    """(N,) all registrations alike: Eq. 11 left out."""
    return np.ones(len(owners))


VARIANTS: dict[str, tuple[dict[str, Callable], dict[str, Any]]] = {
    "as it is": ({}, {}),
    "cost alike everywhere, without Eq. 10": ({"measure_from_joints": everywhere_alike}, {}),
    "without Eq. 11": ({"weigh_by_pose": weigh_evenly}, {}),
    "ridge 1e-3": ({}, {"ridge": 1e-3}),
    "ridge 1e-5": ({}, {"ridge": 1e-5}),
}
"""What is put in place of what, and which options."""


def make_real(folder: Path) -> list[TestHand]:
    """The real scans as right hands; their registration's vertices stand for the truth, which nobody knows."""
    hands, registrar = [], Registrar(untrained_hand())
    for name in MARKS:
        scan = load_scan(folder / f"{name}.obj", METRES_PER_UNIT)
        found = registrar.register(scan)
        flip = np.array([1.0 if found.side == "right" else -1.0, 1.0, 1.0])
        ids = np.random.default_rng(5).permutation(np.flatnonzero(np.isfinite(found.scan_to_mesh)))
        joints = untrained_hand().joints_of(found.vertices * flip)
        hands.append(
            TestHand("real", name, scan.points[ids] * flip, scan.normals[ids] * flip, found.vertices * flip, joints)
        )
    return hands


def judge(model: BlendModel, hands: list[TestHand], flats: dict[str, Array], real: list[TestHand]) -> dict[str, float]:
    """Errors, mm: people and real scans, their shape fitted and with a template of their own."""
    own = {who: find_template(model, flat) for who, flat in flats.items()}
    shaped, posed = judge_model(model, hands), judge_model(model, hands, own)
    row = {
        "people, shaped": shaped.scan_to_mesh.mean(),
        "vertices, shaped": shaped.vertices.mean(),
        "joints, shaped": shaped.joints.mean(),
        "people, own template": posed.scan_to_mesh.mean(),
        "vertices, own template": posed.vertices.mean(),
    }
    if real:
        own = {"real": find_template(model, real[0].vertices)}
        row["real, shaped"] = judge_model(model, real).scan_to_mesh.mean()
        row["real, own template"] = judge_model(model, real[1:], own).scan_to_mesh.mean()
    return {name: round(float(value), 4) for name, value in row.items()}


def judge_components(
    model: BlendModel, hands: list[TestHand], flats: dict[str, Array], real: list[TestHand]
) -> dict[str, dict[str, float]]:
    """Scan to mesh, mm, with own templates and so many components of the pose space."""
    own = {who: find_template(model, flat) for who, flat in flats.items()}
    rows = {}
    for count in COMPONENTS:
        row = {"people, own template": float(judge_model(model, hands, own, count).scan_to_mesh.mean())}
        if real:
            templates = {"real": find_template(model, real[0].vertices)}
            row["real, own template"] = float(judge_model(model, real[1:], templates, count).scan_to_mesh.mean())
        rows["all components" if count is None else f"{count} components"] = row
    return rows


def study(args: argparse.Namespace) -> dict[str, dict[str, float]]:
    real = make_real(args.real) if args.real else []
    people, subjects = (CHOOSERS, TRAIN_SUBJECTS[CHOOSERS:]) if args.choose else (args.people, TEST_SUBJECTS)
    truths, (hands, flats) = make_truths(people, args.poses), make_tests(args.test_poses, subjects)
    base = TrainingOptions(name="hand", threads=1, num_shapes=SHAPES, num_local_shapes=LOCAL_SHAPES)
    rows = {"untrained": judge(untrained_hand("right"), hands, flats, real)}
    print("untrained", rows["untrained"], flush=True)
    for name, (patches, options) in VARIANTS.items():
        with ExitStack() as stack:
            for place, other in patches.items():
                stack.enter_context(patch(f"{LEARN}.{place}", other))
            training, cost = train(truths, replace(base, **options))
        rows[name] = judge(training.model, hands, flats, real) | {"seconds": cost["cpu_seconds"]}
        print(name, rows[name], flush=True)
        if name == "as it is":
            rows["blend shapes off"] = judge(without_pose_shapes(training.model), hands, flats, real)
            rows["without shapes of parts"] = judge(keep_shapes(training.model, SHAPES), hands, flats, real)
            rows |= judge_components(training.model, hands, flats, real)
            print(rows, flush=True)
    return rows


def write_table(rows: dict[str, dict[str, float]]) -> str:
    columns = list(max(rows.values(), key=len))
    lines = ["| model | " + " | ".join(columns) + " |", "|---" * (len(columns) + 1) + "|"]
    for name, row in rows.items():
        lines.append(f"| {name} | " + " | ".join(f"{row[c]:.3f}" if c in row else "-" for c in columns) + " |")
    return "\n".join(lines)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--real", type=Path, metavar="FOLDER", help="holds the real scans (`real_scans`)")
    parser.add_argument("--choose", action="store_true", help="learn from people 1 to 25, judge on 26 to 31")
    parser.add_argument("--people", type=int, default=31)
    parser.add_argument("--poses", type=int, default=51)
    parser.add_argument("--test-poses", type=int, default=4, help="of each of six people")
    parser.add_argument("--out", type=Path, metavar="FILE", help="keeps the figures as JSON")
    args = parser.parse_args()
    rows = study(args)
    print(write_table(rows))
    if args.out:
        args.out.write_text(json.dumps(rows, indent=1))


if __name__ == "__main__":
    main()
