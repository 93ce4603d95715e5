"""A moving scan of 200 frames, hands missing in a fifth of them, and the switches of its terms side by side.

    OPENBLAS_NUM_THREADS=1 python -m benchmarks.body_sequences --out DIR [--frames 200] [--compared 60] [--json]

One generated person (number 300) moves before a scanner at 60 fps. The whole motion is registered with everything
switched on; then its first `--compared` frames with one Gaussian, without a prior of the hands, without E_r for hidden
hands, without the velocity term, and without either, from the same template. Registered frames are kept in DIR.
Bars: vertices 5 mm on the body, 4 mm on hands that are shown; hands right again (6 mm) within 5 frames; in gaps no
finger joint turns more than 20 degrees a frame; 20 s a frame. Exit code 1 when one is missed.
"""

from __future__ import annotations

import argparse
import json
import shutil
import sys
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.spatial.transform import Rotation

from tracker.bodies.body_registration import load_body_registration
from tracker.bodies.body_sequence import TEMPLATE, TEMPLATES, Sequence, SequenceOptions, register_sequence
from tracker.bodies.follow_body import FollowOptions
from tracker.model.body_hands import body_hand
from tracker.model.body_model import body_model
from tracker.synthesis.bodies.body_set import truth_of, write_motion
from tracker.synthesis.bodies.generate import BODY_SCANNER, SIDES
from tracker.synthesis.bodies.moving import MovingPerson, make_motion

Array = npt.NDArray[np.float64]

PERSON = 300
RIGHT_MM = 6.0

VARIANTS: dict[str, FollowOptions] = {
    "mixture": FollowOptions(),
    "one Gaussian": FollowOptions(prior="gaussian"),
    "no prior": FollowOptions(prior="none"),
    "without E_r of hidden hands": FollowOptions(holds_hands=False),
    "without velocity": FollowOptions(has_velocity=False),
    "without both": FollowOptions(holds_hands=False, has_velocity=False),
}


def compare(moving: MovingPerson, scans: Path, frames: Path, count: int) -> dict[str, Any]:
    """How far registered frames are from the truth."""
    model = body_model()
    hands = [body_hand(model, side) for side in SIDES]
    is_hand = np.zeros(len(model.template), dtype=bool)
    is_hand[np.concatenate([hand.vertices for hand in hands])] = True
    body, seconds = np.full(count, np.nan), np.full(count, np.nan)
    shown_mm, fingers = np.full((count, 2), np.nan), np.full((count, 30, 3), np.nan)
    for t in range(count):
        found = load_body_registration(frames / f"{t:06d}")
        with np.load(truth_of(scans / f"{t:06d}.ply")) as truth:
            apart = 1e3 * np.linalg.norm(found.vertices - truth["vertices"], axis=1)
            is_seen = truth["is_seen"]
        body[t], seconds[t], fingers[t] = apart[~is_hand].mean(), sum(found.seconds.values()), found.state.pose[22:]
        for k, hand in enumerate(hands):
            if not moving.is_missing[t, k]:
                seen = hand.vertices[is_seen[hand.vertices]]
                shown_mm[t, k] = apart[seen].mean()
    turns = np.array([_turns(fingers[t], fingers[t - 1]) for t in range(1, count)])
    turns = np.concatenate([np.zeros((1, 30)), turns]).reshape(count, 2, 15)
    back = find_recoveries(moving.is_missing[:count], shown_mm)
    return {
        "frames": count,
        "body_mm": float(body.mean()),
        "body_worst_mm": float(body.max()),
        "hands_mm": float(np.nanmean(shown_mm)),
        "hands_p95_mm": float(np.nanpercentile(shown_mm, 95)),
        "hands_right": float(np.nanmean(np.where(np.isnan(shown_mm), np.nan, shown_mm < RIGHT_MM))),
        "gaps": len(back),
        "frames_until_right": max(back, default=0),
        "jump_in_gaps_deg": float(turns[moving.is_missing[:count]].max(initial=0.0)),
        "jump_anywhere_deg": float(turns.max()),
        "seconds_a_frame": float(np.median(seconds)),
    }


def find_recoveries(is_missing: npt.NDArray[np.bool_], shown_mm: Array) -> list[int]:
    """For each gap that ends, the number of frames until the hand is right again; 0 at once."""
    found = []
    for k in range(2):
        for t in np.flatnonzero(is_missing[:-1, k] & ~is_missing[1:, k]) + 1:
            after = shown_mm[t:, k]
            right = np.flatnonzero(after < RIGHT_MM)
            found.append(int(right[0]) if len(right) else len(after))
    return found


def _turns(after: Array, before: Array) -> Array:
    """(30,) degrees between rotation vectors (30, 3)."""
    return np.degrees((Rotation.from_rotvec(after) * Rotation.from_rotvec(before).inv()).magnitude())


def find_misses(found: dict[str, Any]) -> list[str]:
    """Bars that are missed."""
    bars = {"body_mm": 5.0, "hands_mm": 4.0, "frames_until_right": 5, "jump_in_gaps_deg": 20.0, "seconds_a_frame": 20.0}
    return [name for name, bar in bars.items() if found[name] > bar]


def run(name: str, follow: FollowOptions, paths: list[Path], out: Path, template: Path | None) -> Path:
    """Register the scans with one set of switches; the folder of its frames."""
    folder = out / name.replace(" ", "_")
    if template is not None and not (folder / TEMPLATE).is_file():
        folder.mkdir(parents=True, exist_ok=True)
        shutil.copytree(template / TEMPLATES, folder / TEMPLATES, dirs_exist_ok=True)
        shutil.copy(template / TEMPLATE, folder / TEMPLATE)
    register_sequence(Sequence(tuple(paths), folder, SequenceOptions(follow)), body_model())
    return folder / "frames"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--frames", type=int, default=200)
    parser.add_argument("--compared", type=int, default=60)
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    scans, count = arguments.out / "scans", arguments.frames
    moving = make_motion(PERSON, count)
    paths = [path.resolve() for path in write_motion(moving, scans, BODY_SCANNER)]
    frames = run("mixture", VARIANTS["mixture"], paths, arguments.out, None)
    whole = compare(moving, scans, frames, count)
    print(json.dumps({"whole": whole}), flush=True)
    few = min(arguments.compared, count)
    compared = {"mixture": compare(moving, scans, frames, few)} if few else {}
    for name, follow in VARIANTS.items() if few else ():
        if name != "mixture":
            frames = run(name, follow, paths[:few], arguments.out, arguments.out / "mixture")
            compared[name] = compare(moving, scans, frames, few)
            print(json.dumps({name: compared[name]}), flush=True)
    missed = find_misses(whole)
    report = {"whole": whole, "compared": compared, "missed": missed}
    print(json.dumps(report, indent=None if arguments.json else 1))
    return int(bool(missed))


if __name__ == "__main__":
    sys.exit(main())
