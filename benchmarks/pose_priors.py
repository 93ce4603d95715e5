"""What a Gaussian for each pose of a protocol is worth ([R17] 3.2, round 2): `python -m benchmarks.pose_priors`.

Fists are the hard poses. Those of generated people 26 to 37, skin deforming 2.5 times as in life, are registered with
the trained hand that comes with Handloom, which knows people 1 to 25 only: with the anatomical prior, and with a
Gaussian of each pose. The Gaussians are learnt from true vertices of people 1 to 25, which is the best that accepted
registrations could be: what they don't mend, Gaussians of a lab's own registrations would not either.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.registration_trial import is_right, measure
from tracker.model.trained_hand import trained_hand
from tracker.registration.anatomy import make_anatomical_prior
from tracker.registration.pose_prior import PosePrior, make_gaussian_prior
from tracker.registration.register import Registrar
from tracker.registration.vertex_fit import fit_to_vertices
from tracker.synthesis.scans.generate import ScanOptions, generate_scan, generate_truth
from tracker.synthesis.scans.pose_list import FISTS
from tracker.synthesis.scans.subject import TEST_SUBJECTS, TRAIN_SUBJECTS

KNOWN = TRAIN_SUBJECTS[:25]
JUDGED = (*TRAIN_SUBJECTS[25:], *TEST_SUBJECTS)
STRENGTH = 2.5


def learn_prior(pose: str) -> PosePrior:
    """The Gaussian of one pose, from the true vertices of the people whom the model knows."""
    model = trained_hand()
    fit = Registrar(model).fit
    truths = [generate_truth(subject, pose).vertices for subject in KNOWN]
    found = np.array([fit_to_vertices(fit, fit.neutral(), truth).pose[1:].ravel() for truth in truths])
    return make_gaussian_prior(make_anatomical_prior(model), found.mean(axis=0), np.cov(found.T))


def judge(priors: dict[str, PosePrior | None], people: int) -> list[dict[str, Any]]:
    rows = []
    registrars = {pose: Registrar(trained_hand(), prior) for pose, prior in priors.items()}
    for number, subject in enumerate(JUDGED[:people]):
        for turn, pose in enumerate(FISTS):
            side = ("right", "left")[(number + turn) % 2]
            made = generate_scan(subject, pose, side, 7000 + subject, ScanOptions(strength=STRENGTH))
            found = registrars[pose].register(made.scan)
            rows.append({"scan": f"{pose} of {subject}", "side": side, **measure(found, made, trained_hand())})
            rows[-1]["is_right"] = is_right(rows[-1])
            print(f"{rows[-1]['scan']}: {'right' if rows[-1]['is_right'] else 'WRONG'}, {found.verdict}", flush=True)
    return rows


def describe(name: str, rows: list[dict[str, Any]]) -> str:
    wrong = [row for row in rows if not row["is_right"]]
    good = [row for row in rows if row["verdict"] == "good"]
    return (
        f"| {name} | {len(wrong)} of {len(rows)} | {len(good)} | {sum(not row['is_right'] for row in good)} "
        f"| {np.mean([row['vertices_mm'] for row in rows if row['is_right']]):.3f} "
        f"| {np.median([row['processor_seconds'] for row in rows]):.1f} |"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--people", type=int, default=len(JUDGED), help="of those judged (12)")
    parser.add_argument("--out", type=Path, metavar="FILE", help="keeps all figures as JSON")
    args = parser.parse_args()
    found = {"anatomical prior": judge(dict.fromkeys(FISTS), args.people)}
    found["a Gaussian for each pose"] = judge({pose: learn_prior(pose) for pose in FISTS}, args.people)
    print("| prior | wrong fists | called good | good ones wrong | vertices of right ones, mm | seconds |")
    print("|---|---|---|---|---|---|")
    for name, rows in found.items():
        print(describe(name, rows))
    if args.out:
        args.out.write_text(json.dumps(found, indent=1))


if __name__ == "__main__":
    main()
