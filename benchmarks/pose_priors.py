"""Are fists found better when the pose of the protocol is known? `python -m benchmarks.pose_priors [--scans N]`.

Fists of the six test people with skin that deforms 2.5 times as much as in life are registered with the anatomical
prior, and again, from nothing, with a Gaussian for their pose ([R17] section 3.2), learnt from people 1 to 31 in it.
"""

from __future__ import annotations

import argparse
import json
from dataclasses import dataclass
from functools import cache
from itertools import cycle, islice
from pathlib import Path
from typing import Any

import numpy as np

from tracker.model.untrained_hand import untrained_hand
from tracker.registration.options import RegistrationOptions
from tracker.registration.pose_prior import PosePrior, make_gaussian_prior
from tracker.registration.register import prepare_tools, register_scan
from tracker.registration.vertex_fit import fit_to_vertices
from tracker.synthesis.scans.generate import ScanOptions, generate_scan, generate_truth
from tracker.synthesis.scans.pose_list import FISTS
from tracker.synthesis.scans.subject import TEST_SUBJECTS, TRAIN_SUBJECTS

RIGHT_P95_MM = 10.0


@dataclass(frozen=True)
class Fist:
    """Who, in which pose, which hand, and the number of the scan."""

    subject: int
    pose: str
    side: str
    seed: int


@cache
def learn_prior(pose: str) -> PosePrior:
    """The Gaussian of one pose, from the untrained hand laid onto the true vertices of everybody in it."""
    fit = prepare_tools(untrained_hand()).fit
    poses = [
        fit_to_vertices(fit, fit.neutral(), generate_truth(subject, pose, seed=50 + subject).vertices).pose[1:].ravel()
        for subject in TRAIN_SUBJECTS
    ]
    return make_gaussian_prior(fit.prior, np.mean(poses, axis=0), np.cov(np.array(poses).T))


def plan(count: int) -> list[Fist]:
    subjects, poses = islice(cycle(TEST_SUBJECTS), count), cycle(FISTS)
    return [
        Fist(subject, next(poses), ("right", "left")[number // 2 % 2], 3000 + number)
        for number, subject in enumerate(subjects)
    ]


def measure(fist: Fist, strength: float) -> dict[str, Any]:
    options = ScanOptions(strength=strength, has_forearm=fist.seed % 2 == 0)
    made = generate_scan(fist.subject, fist.pose, fist.side, fist.seed, options)
    row: dict[str, Any] = {"scan": made.scan.name}
    for name, prior in (("anatomical", None), ("of the pose", learn_prior(fist.pose))):
        found = register_scan(made.scan, untrained_hand(), RegistrationOptions(prior=prior))
        error = 1e3 * np.linalg.norm(found.vertices - made.true_vertices, axis=1)
        row[name] = {
            "is_right": bool(np.percentile(error, 95) < RIGHT_P95_MM and found.side == fist.side),
            "vertices_mm": float(error.mean()),
            "verdict": found.verdict,
            "seconds": sum(found.timings.values()),
        }
    return row


def summarize(rows: list[dict[str, Any]]) -> str:
    lines = [
        "| prior | wrong | called good, of these wrong | vertices of right ones, mm | seconds |",
        "|---|---|---|---|---|",
    ]
    for name in ("anatomical", "of the pose"):
        some = [row[name] for row in rows]
        good = [one for one in some if one["verdict"] == "good"]
        right = [one["vertices_mm"] for one in some if one["is_right"]]
        lines.append(
            f"| {name} | {len(some) - len(right)} of {len(some)} | {len(good)}, {sum(not o['is_right'] for o in good)} "
            f"| {np.mean(right):.2f} | {np.median([one['seconds'] for one in some]):.1f} |"
        )
    return "\n".join(lines)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scans", type=int, default=60)
    parser.add_argument("--strength", type=float, default=2.5, help="of skin deformation")
    parser.add_argument("--out", type=Path, metavar="FILE", help="keeps the figures as JSON")
    args = parser.parse_args()
    rows = []
    for fist in plan(args.scans):
        rows.append(measure(fist, args.strength))
        print(json.dumps(rows[-1]), flush=True)
        if args.out is not None:
            args.out.write_text(json.dumps(rows))
    print(summarize(rows))


if __name__ == "__main__":
    main()
