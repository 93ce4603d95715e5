"""Each scan registered in several rotations: right fingers, distance, verdict, and how far rotations differ.

`python -m benchmarks.real_scans FOLDER --rotations 8` runs it on the real scans, on the same hand brought into poses
whose fingers touch (`reposed_scans`), and on generated people of poses like these.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.spatial.transform import Rotation

from benchmarks.reposed_scans import find_pose, repose
from tracker.capture.scan import Scan, load_scan
from tracker.model.untrained_hand import untrained_hand
from tracker.registration.register import Registrar
from tracker.registration.registration import Registration
from tracker.synthesis.scans.generate import ScanOptions, generate_scan

Array = npt.NDArray[np.float64]

METRES_PER_UNIT = 0.0285

MARKS = {
    "2_spread": ((-1.2, 0.9, 0.8), (-1.7, 3.1, -2.5), (-1.0, 3.4, -3.7), (0.4, 3.6, -3.7), (2.0, 3.0, -3.9)),
    "4_rest": ((-1.8, 2.2, 0.8), (-0.9, 3.9, -0.3), (-0.3, 4.2, -0.6), (0.3, 3.8, -0.7), (1.0, 3.1, -1.3)),
    "5_fist": ((1.1, 2.6, -0.9), (0.9, 1.2, -0.8), (0.5, 1.1, -0.8), (0.2, 1.0, -0.6), (-0.2, 1.1, -0.5)),
}
"""Tips of thumb, index, middle, ring and little finger of the real left hand, the scan's units, checked by eye."""

REPOSED = (
    ("2_spread", 2, "thumb_to_little"),
    ("2_spread", 8, "thumb_to_little"),
    ("4_rest", 14, "thumb_to_little"),
    ("4_rest", 20, "thumb_to_little"),
    ("2_spread", 5, "tip_pinch"),
    ("4_rest", 11, "ring"),
    ("2_spread", 3, "thumb_across"),
    ("2_spread", 9, "palmar_pinch"),
    ("4_rest", 9, "victory"),
    ("2_spread", 17, "point"),
    ("2_spread", 4, "flat_together"),
    ("2_spread", 6, "fist"),
)
"""Scan, and whose pose it is brought into."""

GENERATED = (
    (2, "thumb_to_little", "right", 1.0),
    (8, "thumb_to_little", "left", 1.0),
    (14, "thumb_to_little", "right", 2.5),
    (20, "thumb_to_little", "left", 2.5),
    (5, "tip_pinch", "right", 2.5),
    (11, "ring", "left", 2.5),
    (17, "fist", "right", 2.5),
    (23, "fist_thumb_inside", "left", 2.5),
    (29, "relaxed", "right", 2.5),
)
"""Person, pose, side and strength of skin deformation."""

NEAR, SURE = 0.012, 0.004
"""A finger is right when its tip lies this near to its mark, m, and nearer than to any other mark; within 4 mm it is
right whatever else is near, for fingertips that touch may be marked 3 mm apart."""


@dataclass(frozen=True)
class Case:
    """A scan, what kind it is, its side, and where its five fingertips are (5, 3), m."""

    kind: str
    name: str
    scan: Scan
    side: str
    tips: Array


def make_cases(folder: Path, registrar: Registrar) -> Iterator[Case]:
    """Real scans of a folder, the same hand in other poses, and generated people."""
    tips = untrained_hand().tips
    scans = {name: load_scan(folder / f"{name}.obj", METRES_PER_UNIT) for name in MARKS}
    for name, scan in scans.items():
        yield Case("real", name, scan, "left", METRES_PER_UNIT * np.array(MARKS[name]))
    first = {name: registrar.register(scans[name]) for name in {name for name, *_ in REPOSED}}
    for name, subject, pose in REPOSED:
        scan, truth = repose(scans[name], first[name], find_pose(registrar, subject, pose))
        yield Case("real, reposed", f"{name}: {pose} of {subject}", scan, "left", truth[tips])
    for subject, pose, side, strength in GENERATED:
        made = generate_scan(subject, pose, side, 100 + subject, ScanOptions(strength=strength))
        yield Case("generated", f"{pose} of {subject}, {strength:g}", made.scan, side, made.true_vertices[tips])


def register_turned(case: Case, rotations: Array, registrar: Registrar) -> list[dict[str, Any]]:
    """What becomes of a scan in each of the rotations (N, 3, 3), written with six digits as in a file."""
    rows, first = [], None
    for R in rotations:
        turned = replace(case.scan, points=np.round(case.scan.points @ R.T, 6), normals=case.scan.normals @ R.T)
        registration = registrar.register(turned)
        vertices = registration.vertices @ R
        first = vertices if first is None else first
        rows.append(
            {
                "kind": case.kind,
                "scan": case.name,
                "is_right": is_right(case, registration, vertices),
                "verdict": registration.verdict,
                "mean_mm": registration.scan_to_mesh_mm["mean"],
                "apart_mm": float(1e3 * np.linalg.norm(vertices - first, axis=1).mean()),
                "processor_seconds": sum(registration.timings.values()),
                "measures": registration.measures,
                "reasons": list(registration.reasons),
            }
        )
    return rows


def is_right(case: Case, registration: Registration, vertices: Array) -> bool:
    """Whether the side is right and every fingertip is at its own mark, of vertices (V, 3) turned back."""
    return registration.side == case.side and are_tips_right(vertices[untrained_hand().tips], case.tips)


def are_tips_right(tips: Array, marks: Array) -> bool:
    """Whether each of five tips (5, 3) is where it is marked (5, 3), m."""
    away = np.linalg.norm(tips[:, None] - marks, axis=2)
    own = away.diagonal()
    return bool((own < NEAR).all() and ((away.argmin(axis=1) == np.arange(5)) | (own < SURE)).all())


def describe(rows: list[dict[str, Any]]) -> str:
    """One scan's line of the table."""
    means = [row["mean_mm"] for row in rows]
    verdicts = ", ".join(
        f"{count} {name}" for name in ("good", "doubtful", "bad") if (count := sum(r["verdict"] == name for r in rows))
    )
    return (
        f"| {rows[0]['kind']} | {rows[0]['scan']} | {sum(row['is_right'] for row in rows)} of {len(rows)} "
        f"| {np.mean(means):.3f} | {max(means) - min(means):.3f} | {max(row['apart_mm'] for row in rows):.2f} "
        f"| {verdicts} | {np.median([row['processor_seconds'] for row in rows]):.1f} |"
    )


def summarize(rows: list[dict[str, Any]]) -> str:
    """The figures that have a bar, by kind."""
    lines = [
        "| kind | right (bar 95 %) | right ones called good (bar 80 %) | good ones wrong (bar 0) |",
        "|---|---|---|---|",
    ]
    for kind in dict.fromkeys(row["kind"] for row in rows):
        some = [row for row in rows if row["kind"] == kind]
        right = [row for row in some if row["is_right"]]
        good = [row for row in some if row["verdict"] == "good"]
        called, wrong = sum(row["is_right"] for row in good), sum(not row["is_right"] for row in good)
        lines.append(f"| {kind} | {len(right)} of {len(some)} | {called} of {len(right)} | {wrong} of {len(good)} |")
    return "\n".join(lines)


def study(folder: Path, count: int, out: Path | None) -> None:
    """Print a line a scan and the summary; keep every row in `out`."""
    rotations = Rotation.random(count, rng=np.random.default_rng(7)).as_matrix()
    print("| kind | scan | right | scan to mesh, mean, mm | spread, mm | vertices apart, mm | verdict | seconds |")
    print("|---|---|---|---|---|---|---|---|")
    rows: list[dict[str, Any]] = []
    registrar = Registrar(untrained_hand())
    for case in make_cases(folder, registrar):
        rows += register_turned(case, rotations, registrar)
        print(describe(rows[-count:]), flush=True)
        if out is not None:
            out.write_text(json.dumps(rows, indent=1))
    print(summarize(rows))
