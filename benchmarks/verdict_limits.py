"""Right and wrong registrations with what the verdict measures of them: `python -m benchmarks.verdict_limits FOLDER`.

Each scan (real ones of FOLDER, the same hand in other poses, generated people 1 to 31, generated fists, and last the
same hand in all 51 poses, on which no limit was chosen) is registered from where it truly lies, and from starts that
are wrong: a finger folded or stretched, fingers shifted by one, two fingers merged, the other side. What ends with a
fingertip elsewhere is a wrong hand. Prints how many right ones and how many wrong ones today's limits call good;
`--out` keeps the measures, from which limits are chosen, `--pictures` draws the wrong ones that are called good: the
registration, the truth below it, and how far each vertex is off (yellow 15 mm and more).
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import cycle, product
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import numpy.typing as npt

from benchmarks.hand_pictures import draw_beside_truth
from benchmarks.reposed_scans import find_pose, repose
from benchmarks.scan_rotations import MARKS, METRES_PER_UNIT, REPOSED, are_tips_right
from tracker.capture.scan import Scan, load_scan
from tracker.model.blend_limits import blend_limits
from tracker.model.untrained_hand import untrained_hand
from tracker.registration.hand_state import HandState
from tracker.registration.register import Registrar
from tracker.registration.registration import Registration, RegistrationStart
from tracker.registration.start_poses import FOLDED, HALF, STRAIGHT, curl_finger
from tracker.registration.verdict import turn_over
from tracker.registration.vertex_fit import fit_to_vertices
from tracker.synthesis.scans.generate import ScanOptions, generate_scan
from tracker.synthesis.scans.pose_list import FISTS, POSE_NAMES
from tracker.synthesis.scans.subject import TRAIN_SUBJECTS

Array = npt.NDArray[np.float64]

FINGERS = ("index", "middle", "ring", "little")
FIRST = {"thumb": 13, "index": 1, "middle": 4, "ring": 10, "little": 7}
"""A finger's first joint."""


@dataclass(frozen=True)
class Known:
    """A scan whose registration is known: vertices (V, 3), scan, m, and the tips (5, 3) that a right one has."""

    kind: str
    name: str
    scan: Scan
    side: str
    vertices: Array
    tips: Array


def make_known(folder: Path, people: int, registrar: Registrar) -> Iterator[Known]:
    tips = untrained_hand().tips
    scans = {name: load_scan(folder / f"{name}.obj", METRES_PER_UNIT) for name in MARKS}
    first = {name: registrar.register(scan) for name, scan in scans.items()}
    for name, scan in scans.items():
        yield Known("real", name, scan, "left", first[name].vertices, METRES_PER_UNIT * np.array(MARKS[name]))
    for name, subject, pose in REPOSED:
        scan, truth = repose(scans[name], first[name], find_pose(registrar, subject, pose))
        yield Known("reposed", f"{name}: {pose} of {subject}", scan, "left", truth, truth[tips])
    rng = np.random.default_rng(9)
    for number, subject in enumerate(TRAIN_SUBJECTS[:people]):
        pose, strength = POSE_NAMES[rng.integers(len(POSE_NAMES))], (1.0, 2.5)[number % 2]
        side = ("right", "left")[number // 2 % 2]
        made = generate_scan(subject, pose, side, 900 + subject, ScanOptions(strength=strength))
        name = f"{pose} of {subject}, {strength:g}"
        yield Known("generated", name, made.scan, side, made.true_vertices, made.true_vertices[tips])
    for number, (pose, strength) in enumerate(product(FISTS, (1.0, 2.5))):
        subject, side = (32 + number // 2 % 6, 10 + number // 2)[number % 2], ("right", "left")[number // 2 % 2]
        made = generate_scan(subject, pose, side, 3000 + subject, ScanOptions(strength=strength))
        name = f"{pose} of {subject}, {strength:g}"
        yield Known("generated fists", name, made.scan, side, made.true_vertices, made.true_vertices[tips])
    kept = np.random.default_rng(77).permutation(POSE_NAMES).tolist()
    for number, (subject, pose) in enumerate(zip(cycle(reversed(TRAIN_SUBJECTS)), kept, strict=False)):
        name = ("2_spread", "4_rest")[number % 2]
        scan, truth = repose(scans[name], first[name], find_pose(registrar, subject, pose))
        yield Known("reposed, kept aside", f"{name}: {pose} of {subject}", scan, "left", truth, truth[tips])


def make_starts(known: Known, registrar: Registrar) -> Iterator[tuple[str, RegistrationStart]]:
    """The true start, and wrong ones."""
    fit, limits = registrar.fit, blend_limits(untrained_hand())
    flip = np.array([1.0 if known.side == "right" else -1.0, 1.0, 1.0])
    state = fit_to_vertices(fit, fit.neutral(), known.vertices * flip)
    yield "true", _start(known.side, state)
    rng = np.random.default_rng(len(known.name))
    for finger in rng.choice(FINGERS, 2, replace=False):
        curled = float(np.linalg.norm(state.pose[FIRST[finger] : FIRST[finger] + 3], axis=1).sum()) > 1.5
        yield f"{finger} elsewhere", _start(known.side, _curl(limits, state, (str(finger),), curled))
    curled = float(np.linalg.norm(state.pose[1:13], axis=1).sum()) > 6.0
    yield "all elsewhere", _start(known.side, _curl(limits, state, FINGERS, curled))
    a, b = [FIRST[finger] for finger in ("index", "middle", "ring", "little")][rng.integers(3) :][:2]
    pose = state.pose.copy()
    pose[b : b + 3] = pose[a : a + 3] + 0.35 * (1 if a < b else -1) * limits.axes[b - 1 : b + 2, 1] * [[1], [0], [0]]
    yield "merged", _start(known.side, replace(state, pose=pose))
    pose = state.pose.copy()
    for one, other in (("index", "middle"), ("middle", "ring"), ("ring", "little")):
        pose[FIRST[one] : FIRST[one] + 3] = state.pose[FIRST[other] : FIRST[other] + 3]
    yield "shifted by one", _start(known.side, replace(state, pose=pose, translation=state.translation + 0.012))
    pose = state.pose.copy()
    pose[13:16] = limits.pose_at(limits.mean)[13:16] * (-1.0 if np.linalg.norm(pose[13:16]) < 0.6 else 1.0)
    yield "thumb elsewhere", _start(known.side, replace(state, pose=pose))
    yield "other side", _start("right" if known.side == "left" else "left", turn_over(fit.model, state))


def _curl(limits, state: HandState, fingers: tuple[str, ...], is_curled: bool) -> HandState:
    pose = state.pose
    for finger in fingers:
        pose = curl_finger(limits, pose, finger, STRAIGHT if is_curled else FOLDED if len(fingers) == 1 else HALF)
    return replace(state, pose=pose)


def _start(side: str, state: HandState) -> RegistrationStart:
    return RegistrationStart(side, state.pose, state.translation, state.shape)


def is_right(known: Known, found: Registration) -> bool:
    return found.side == known.side and are_tips_right(found.vertices[untrained_hand().tips], known.tips)


def describe(known: Known, what: str, found: Registration) -> dict[str, Any]:
    """Verdict and measures of a registration from one start, and how far it is from the truth."""
    tips = np.linalg.norm(found.vertices[untrained_hand().tips] - known.tips, axis=1)
    return {
        "kind": known.kind,
        "scan": known.name,
        "start": what,
        "is_right": is_right(known, found),
        "tips_mm": (1e3 * tips).round(2).tolist(),
        "vertices_p95_mm": float(1e3 * np.percentile(np.linalg.norm(found.vertices - known.vertices, axis=1), 95)),
        "verdict": found.verdict,
        "score": found.score,
        "measures": found.measures,
    }


def draw(path: Path, known: Known, found: Registration) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    cv2.imwrite(str(path), draw_beside_truth(found.vertices, known.vertices, found.faces, 0.015))


def collect(folder: Path, people: int, out: Path | None, pictures: Path | None) -> list[dict[str, Any]]:
    rows: list[dict[str, Any]] = []
    registrar = Registrar(untrained_hand())
    for known in make_known(folder, people, registrar):
        starts = make_starts(known, registrar)
        found = [(what, registrar.register(known.scan, start=start)) for what, start in starts]
        for what, one in found:
            rows.append(describe(known, what, one))
            if pictures is not None and one.verdict == "good" and not rows[-1]["is_right"]:
                draw(pictures / f"{known.name} {what}.png".replace(" ", "_"), known, one)
        print(f"{known.kind}, {known.name}: " + ", ".join(
            f"{row['start']} {'right' if row['is_right'] else 'wrong'} {row['verdict']}" for row in rows[-len(found) :]
        ), flush=True)  # fmt: skip
        if out is not None:
            out.write_text(json.dumps(rows))
    return rows


def summarize(rows: list[dict[str, Any]]) -> str:
    lines = ["| kind | right ones called good | wrong ones called good |", "|---|---|---|"]
    for kind in dict.fromkeys(row["kind"] for row in rows):
        right = [row for row in rows if row["kind"] == kind and row["is_right"]]
        wrong = [row for row in rows if row["kind"] == kind and not row["is_right"]]
        good = [sum(row["verdict"] == "good" for row in some) for some in (right, wrong)]
        lines.append(f"| {kind} | {good[0]} of {len(right)} | {good[1]} of {len(wrong)} |")
    return "\n".join(lines)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--people", type=int, default=31, help="generated ones, a scan each")
    parser.add_argument("--out", type=Path, metavar="FILE", help="keeps all measures as JSON")
    parser.add_argument("--pictures", type=Path, metavar="DIR", help="draws the wrong ones that are called good")
    args = parser.parse_args()
    print(summarize(collect(args.folder, args.people, args.out, args.pictures)))


if __name__ == "__main__":
    main()
