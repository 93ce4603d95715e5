"""Does tracking get lost: fast motion, starts that are off, hands out of sight.

python -m benchmarks.studies.robustness FOLDER_OF_T16_DATA --twins FOLDER [--only fast perturbed out_of_sight]
"""

from __future__ import annotations

import argparse
import json
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.studies.blanked import blank_twin
from benchmarks.studies.true_pose import disturb_hands, find_true_pose
from benchmarks.studies.twin_runs import SEQUENCES, Run, Twin, measure, render_twin, run_twin, start_twin
from tracker.evaluation import evaluate_against_truth
from tracker.fitting.options import TrackOptions
from tracker.tracking.follow import track_frames
from tracker.tracking.state import TrackState
from tracker.tracking.track import join_chunks

TERMS = "LO+S"
STARTS = 50
FRAMES = 10
"""A start that is off has so many frames to come right."""
RIGHT_PX = 2.0
"""Mean over the joints of all hands below which a start has come right."""
TRACKED = 0.005
"""A hand whose joints are this near on average is tracked again, m."""
HIDDEN = range(40, 60)
"""Frames in which the hands are out of sight."""
AFTER = 40
"""Frames that are followed after them."""


@dataclass(frozen=True)
class Perturbed:
    """One start off by 15 degrees in every joint and the root and by 10 mm, and FRAMES frames from there.

    Attributes:
        sequence: Of the public ones.
        seed: Draws the frame and the disturbance.
        terms: Of the objective.
    """

    sequence: str
    seed: int
    terms: str = TERMS

    def __call__(self, data: Path, cache: Path) -> dict[str, Any]:
        """Disturb, track, measure."""
        twin = render_twin(data, cache, self.sequence, None, 1, 0)
        rng = np.random.default_rng([int(self.sequence), self.seed])
        first = int(rng.integers(0, twin.sequence.frame_count - FRAMES + 1))
        setup, _ = start_twin(twin, TrackOptions(terms=self.terms, calibrate=False))
        setup = replace(setup, options=replace(setup.options, first_frame=first), marks={})
        pose = disturb_hands(setup.scene, find_true_pose(twin, setup, first), rng)
        state = TrackState(first, pose, pose)
        _, chunk = track_frames(twin.sequence, setup, state, range(first, first + FRAMES))
        error = evaluate_against_truth(join_chunks(twin.sequence, setup, [chunk]), twin.truth)
        px = np.nanmean(error.error_px, axis=(1, 2, 3))
        return {
            **asdict(self),
            "first": first,
            "px": px.tolist(),
            "mm": (1e3 * error.hand_mean.max(axis=1)).tolist(),
            "status": list(error.status),
            "came_right": bool(px[-1] < RIGHT_PX),
            "is_silent": bool(px[-1] >= RIGHT_PX and error.status[-1] != "lost"),
        }


@dataclass(frozen=True)
class OutOfSight:
    """Hands out of sight in the frames HIDDEN, then back, without annotation.

    Attributes:
        sequence: Of the public ones.
        gone: What is out of sight.
        terms: Of the objective.
    """

    sequence: str
    gone: tuple[str, ...]
    terms: str = TERMS

    def __call__(self, data: Path, cache: Path) -> dict[str, Any]:
        """Blank, track, measure."""
        twin = blank_twin(render_twin(data, cache, self.sequence, None, 1, 0), HIDDEN, self.gone)
        last = min(HIDDEN.stop + AFTER, twin.sequence.frame_count) - 1
        setup, state = start_twin(twin, TrackOptions(terms=self.terms, calibrate=False, last_frame=last))
        track = run_twin(twin, setup, state)
        error = evaluate_against_truth(track, twin.truth)
        is_right = (error.hand_mean < TRACKED).all(axis=1) & (track.status != "lost")
        back = np.flatnonzero(is_right[HIDDEN.stop :])
        after = slice(HIDDEN.stop + 5, None)
        shown = np.r_[0 : HIDDEN.start, HIDDEN.stop + 5 : len(error.frame)]
        objects = measure(twin, track)["objects"]
        return {
            **asdict(self),
            "said_lost": int(np.count_nonzero(track.status[HIDDEN.start : HIDDEN.stop] == "lost")),
            "frames_to_recover": int(back[0]) + 1 if len(back) else None,
            "px_after": float(np.nanmean(error.error_px[after])),
            "worst_mm_after": float(1e3 * error.hand_mean[after].max()),
            "lost_after": int(error.is_lost[after].sum()),
            "false_lost": int(np.count_nonzero(track.status[shown] == "lost")),
            "objects": objects,
            "median_ms": 1e3 * float(np.median(track.seconds)),
        }


def fast(data: Path, cache: Path, sequences: tuple[str, ...] = SEQUENCES) -> list[dict[str, Any]]:
    """Every frame, every third and every fifth of the whole sequences."""
    return [Run(name, step, terms=TERMS)(data, cache) for name in sequences for step in (1, 3, 5)]


def perturbed(
    data: Path, cache: Path, sequences: tuple[str, ...] = SEQUENCES, starts: int = STARTS
) -> list[dict[str, Any]]:
    """So many starts, taking turns over the sequences."""
    return [Perturbed(sequences[i % len(sequences)], i // len(sequences))(data, cache) for i in range(starts)]


def out_of_sight(data: Path, cache: Path, sequences: tuple[str, ...] = SEQUENCES) -> list[dict[str, Any]]:
    """All hands gone, each hand of two gone, and hands and object gone."""
    found = []
    for name in sequences:
        twin = render_twin(data, cache, name, None, 1, 0)
        for gone in _casts(twin):
            found.append(OutOfSight(name, gone)(data, cache))
    return found


def _casts(twin: Twin) -> list[tuple[str, ...]]:
    hands = tuple(actor.name for actor in twin.performance.hands)
    objects = tuple(actor.name for actor in twin.performance.objects)
    single = [(hand,) for hand in hands] if len(hands) > 1 else []
    return [hands, *single, *([(*hands, *objects)] if objects else [])]


def _tell(kind: str, rows: list[dict[str, Any]]) -> None:
    if kind == "fast":
        print(
            "| sequence | step | px | mm | worst mm | lost | silent | said lost | recovered | median ms | objects mm |"
        )
        print("|---|---|---|---|---|---|---|---|---|---|---|")
        for r in rows:
            things = " ".join(f"{name} {found['mm']:.2f}" for name, found in r["objects"].items())
            print(
                f"| {r['sequence']} | {r['step']} | {r['px']:.2f} | {r['mm']:.2f} | {r['worst_mm']:.1f} | {r['lost']} "
                f"| {r['silent']} | {r['said_lost']} | {r['recovered']} | {r['median_ms']:.1f} | {things} |"
            )
    elif kind == "perturbed":
        print("| sequence | starts | came right | said lost | silent |\n|---|---|---|---|---|")
        for name in (*sorted({r["sequence"] for r in rows}), "all"):
            own = [r for r in rows if name in ("all", r["sequence"])]
            right, silent = sum(r["came_right"] for r in own), sum(r["is_silent"] for r in own)
            print(f"| {name} | {len(own)} | {right} | {len(own) - right - silent} | {silent} |")
    else:
        print("| sequence | gone | said lost of 20 | frames to recover | px after | worst mm after | objects mm |")
        print("|---|---|---|---|---|---|---|")
        for r in rows:
            things = " ".join(f"{name} {found['mm']:.2f}" for name, found in r["objects"].items())
            print(
                f"| {r['sequence']} | {', '.join(r['gone'])} | {r['said_lost']} | {r['frames_to_recover']} "
                f"| {r['px_after']:.2f} | {r['worst_mm_after']:.1f} | {things} |"
            )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("data", type=Path, help="T16's folders `models` and `seq`")
    parser.add_argument("--twins", type=Path, required=True, help="rendered recordings are kept here")
    parser.add_argument("--sequences", nargs="+", default=SEQUENCES, choices=SEQUENCES)
    parser.add_argument("--only", nargs="+", default=list(STUDIES), choices=STUDIES)
    parser.add_argument("--starts", type=int, default=STARTS)
    parser.add_argument("--json", type=Path, help="all rows, as JSON")
    given = parser.parse_args()
    found = {}
    for kind in given.only:
        more = {"starts": given.starts} if kind == "perturbed" else {}
        found[kind] = STUDIES[kind](given.data, given.twins, tuple(given.sequences), **more)
        _tell(kind, found[kind])
    if given.json:
        given.json.write_text(json.dumps(found, indent=1))


STUDIES = {"fast": fast, "perturbed": perturbed, "out_of_sight": out_of_sight}

if __name__ == "__main__":
    main()
