"""How early the queue of frames to look at comes to wrong ones: `python -m benchmarks.frames_to_look_at [--write]`.

Two hands are rendered moving before three cameras, tracked in their colour, and looked through by the hand detector.
An error is planted in one hand of ten, in three ways: in labels that a person placed in every camera; in the track
itself, whose suggestions were accepted as labels in every camera; in the track, without any label. `--write` writes
`benchmarks/results/frames_to_look_at.md`. `--folder` keeps what was rendered, tracked and found for the next time.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
import uuid
from collections import Counter
from dataclasses import dataclass, replace
from itertools import cycle
from pathlib import Path

import numpy as np
import numpy.typing as npt

from benchmarks.result_page import write_result
from server.annotations.sources import write_sources
from server.quality.doubt import doubt_label
from server.quality.find import Setting, check_labels
from server.quality.labels import LabelReader
from server.quality.queue import Queued, find_doubts, find_label_doubts, queue_hands
from server.quality.witnesses import Detections, TrackedHands, read_detections, read_track
from tracker import Sequence, load_sequence
from tracker.capture import JointSource

Array = npt.NDArray[np.float64]
Noise = np.random.Generator

CHOSEN_ON, REPORTED = ("open-close",), ("count", "pinch")
"""Limits and the way that scores are put together were chosen on the first; figures are of the others."""
KINDS = ("shifted joint", "swapped fingers", "hand of another frame", "left and right swapped", "one camera only")
PLACED, ACCEPTED, NONE = WAYS = ("placed by hand", "accepted", "not labelled")
FRAMES, EVERY, SEEDS = 90, 10, 5
NOISE_PX = 1.5
"""Of a person's mark, [T16] §4.2."""
SHIFT_M = 0.03
"""As the label check's benchmark: a joint beside the next finger."""
AWAY_FRAMES = 12
"""Such a motion goes through its poses in 30 to 60 frames: so far away the hand has another one."""
OFF_M = 0.01
"""A track this far from the truth on average is of another pose: half a finger's width."""


@dataclass
class Made:
    """A recording with a track and detections, as the studio has them."""

    recording: Sequence
    tracked: TrackedHands
    points: dict[tuple[int, str], Array]
    """(21, 3) world, m, of the track by frame and hand."""
    detected: Detections


class Row:
    """A label as the table of annotations holds it, accepted from a suggestion or placed by a person."""

    def __init__(self, camera: str, frame: int, hand: str, pixels: Array, is_accepted: bool) -> None:
        self.id, self.revision, self.camera, self.frame, self.hand = uuid.uuid4(), 1, camera, frame, hand
        # Not "visible": depth is not to be looked at, these are cameras of colour.
        self.points = [[x, y, 1] for x, y in pixels.tolist()]
        source = JointSource(kind="track", label="Track 1")
        self.sources = write_sources((source,) * 21) if is_accepted else None


def make(folder: Path, motion: str) -> Made:
    """Render, track and look through a motion, unless the folder has it."""
    recording, track, found = folder / motion, folder / f"{motion}-track", folder / f"{motion}-det.json"
    hands = ["--hand", "right", "--hand", "left"]
    commands = {
        recording: ["synthesize", "--motion", motion, "--cameras", 3, *hands, "--frames", f"0:{FRAMES}"],
        found: ["detect", recording],
        track: ["track", recording, "--cameras", "cam0,cam1,cam2", "--no-depth", "--annotations", "none"],
    }
    for out, command in commands.items():
        if not out.exists():
            whole = [sys.executable, "-m", "server.cli", *map(str, command), "--out", str(out)]
            subprocess.run(whole, check=True, capture_output=True)
    with np.load(track / "track.npz") as arrays:
        names = [str(name) for name in arrays["joint_names"]]
        points = {
            (int(frame), hand): joints[[at for at, name in enumerate(names) if name.startswith(hand)]]
            for frame, joints in zip(arrays["frame"], arrays["joints_3d"], strict=True)
            for hand in ("right", "left")
            if f"{hand}/wrist" in names
        }
    return Made(load_sequence(recording), read_track(track), points, read_detections(found))


def other_hand(place: tuple[int, str]) -> tuple[int, str]:
    """The other hand of the same frame."""
    frame, hand = place
    return frame, "left" if hand == "right" else "right"


def choose(held: list[tuple[int, str]], rng: np.random.Generator) -> dict[tuple[int, str], str]:
    """An error for one hand of ten, each kind in turn; where left and right are swapped both hands are wrong."""
    room, planted = len(held) // EVERY, dict[tuple[int, str], str]()
    kinds = cycle(KINDS)
    for at in rng.permutation(len(held)).tolist():
        place = held[at]
        if place in planted:
            continue
        kind = next(kinds)
        if kind == "left and right swapped":
            both = other_hand(place) in held and other_hand(place) not in planted and len(planted) + 2 <= room
            kind = kind if both else next(kinds)
        planted[place] = kind
        if kind == "left and right swapped":
            planted[other_hand(place)] = kind
        if len(planted) >= room:
            break
    return planted


def plant(points: dict[tuple[int, str], Array], place: tuple[int, str], kind: str, rng: np.random.Generator) -> Array:
    """(21, 3) world, m: the hand at a place, with an error."""
    wrong = points[place].copy()
    if kind == "shifted joint":
        direction = rng.normal(size=3)
        wrong[int(rng.integers(1, 21))] += SHIFT_M * direction / np.linalg.norm(direction)
    elif kind == "swapped fingers":
        first = int(rng.integers(1, 4))
        a, b = slice(1 + 4 * first, 5 + 4 * first), slice(5 + 4 * first, 9 + 4 * first)
        wrong[a], wrong[b] = wrong[b].copy(), wrong[a].copy()
    elif kind == "left and right swapped":
        wrong = points[other_hand(place)].copy()
    else:
        frame, hand = place
        away = frame + AWAY_FRAMES if (frame + AWAY_FRAMES, hand) in points else frame - AWAY_FRAMES
        wrong = points[away, hand].copy()
    return wrong


def spoil(made: Made, seed: int) -> tuple[Made, dict[tuple[int, str], str]]:
    """Plant an error in one hand of ten; gives what each is.

    Where one camera only is wrong, it is the detector's hand that is of another frame there, and its label is accepted
    from the detector: a track is in space and cannot be wrong in one camera.
    """
    rng = np.random.default_rng(seed)
    planted = choose(sorted({(frame, hand) for _, frame, hand in made.tracked.joints}), rng)
    tracked, detected = dict(made.tracked.joints), dict(made.detected.joints)
    for (frame, hand), kind in planted.items():
        wrong = plant(made.points, (frame, hand), kind, rng)
        cameras = made.recording.cameras
        if kind == "one camera only":
            camera = cameras[int(rng.integers(len(cameras)))]
            detected[camera.id, frame, hand] = camera.project(wrong)
        else:
            for camera in cameras:
                tracked[camera.id, frame, hand] = camera.project(wrong)
    return (
        replace(made, tracked=replace(made.tracked, joints=tracked), detected=replace(made.detected, joints=detected)),
        planted,
    )


def label(made: Made, planted: dict[tuple[int, str], str], clean: Made, noise: Noise | None) -> list[Row]:
    """Labels of every hand that the track holds, as it has them; in one camera as the detector has it.

    With noise they are a person's: placed by hand, a little beside.
    """
    rows = []
    for (camera, frame, hand), pixels in made.tracked.joints.items():
        if planted.get((frame, hand)) == "one camera only":
            found, before = (one.detected.joints.get((camera, frame, hand)) for one in (made, clean))
            if found is not None and found is not before:
                pixels = found
        if noise is not None:
            pixels = pixels + noise.normal(0, NOISE_PX, pixels.shape)
        rows.append(Row(camera, frame, hand, pixels, noise is None))
    return rows


def queue(made: Made, rows: list[Row]) -> list[Queued]:
    """As the studio has it."""
    recording = made.recording
    setting = Setting(
        recording.hands,
        {camera.id: camera for camera in recording.cameras},
        tracked=made.tracked,
        detected=made.detected,
    )
    labels = LabelReader().read(recording, rows)
    flags = [doubt_label(finding) for finding in check_labels(labels, setting).findings]
    return queue_hands([*flags, *find_doubts(setting), *find_label_doubts(labels, setting)], labels)


def find_off(made: Made, folder: Path, motion: str) -> set[tuple[int, str]]:
    """Frames and hands where the track is by itself far from the truth; none where that is not known."""
    off: set[tuple[int, str]] = set()
    if not (folder / motion / "truth.npz").is_file():
        return off
    with np.load(folder / motion / "truth.npz") as truth:
        names = [str(name) for name in truth["joint_names"]]
        for hand in ("right", "left"):
            columns = [at for at, name in enumerate(names) if name.startswith(hand)]
            for frame, joints in zip(truth["frame"].tolist(), truth["joints_3d"][:, columns], strict=True):
                found = made.points.get((frame, hand))
                if found is not None and np.linalg.norm(found - joints, axis=1).mean() > OFF_M:
                    off.add((frame, hand))
    return off


@dataclass
class Count:
    """What the first tenth of queues held."""

    planted: Counter[tuple[str, str]]
    held: Counter[tuple[str, str]]
    others: Counter[str]
    others_off: Counter[str]
    hands: int = 0
    """Of which the truth is known."""
    off: int = 0


def measure(folder: Path, motions: tuple[str, ...]) -> Count:
    """Queues of spoiled recordings, labelled and not."""
    count = Count(Counter(), Counter(), Counter(), Counter())
    for motion in motions:
        clean = make(folder, motion)
        off = find_off(clean, folder, motion)
        count.hands += len(clean.points) if (folder / motion / "truth.npz").is_file() else 0
        count.off += len(off)
        for seed in range(SEEDS):
            made, planted = spoil(clean, seed)
            for way in WAYS:
                noise = np.random.default_rng([seed, 1]) if way == PLACED else None
                rows = [] if way == NONE else label(made, planted, clean, noise)
                # A person's mistake is in the labels alone.
                ranked = queue(clean if way == PLACED else made, rows)
                room = len(clean.points) // EVERY
                first = {(one.frame, one.hand) for one in ranked[:room]}
                for place, kind in planted.items():
                    count.planted[kind, way] += 1
                    count.held[kind, way] += place in first
                count.others[way] += len(first - set(planted))
                count.others_off[way] += len((first - set(planted)) & off)
    return count


def describe(count: Count) -> list[str]:
    """The table and a sentence."""
    titles = " | ".join(f"{way}, in the first tenth" for way in WAYS)
    rows = [f"| error | planted | {titles} |", "|---|---|" + "---|" * len(WAYS)]
    for kind in (*KINDS, "all"):
        kinds = KINDS if kind == "all" else (kind,)
        planted, held = ([sum(of[one, way] for one in kinds) for way in WAYS] for of in (count.planted, count.held))
        shares = [f"{part} ({100 * part / whole:.0f} %)" for part, whole in zip(held, planted, strict=True)]
        rows.append(f"| {kind} | {planted[0]} | {' | '.join(shares)} |")
    if not count.hands:
        return rows
    others = ", ".join(f"{count.others_off[way]} of {count.others[way]} ({way})" for way in WAYS)
    rows.append(
        f"\nOf the other hands in the first tenth {others} are wrong, too: the track was by itself more than "
        f"{1e3 * OFF_M:.0f} mm from the truth, as it was in {count.off} of all {count.hands} hands."
    )
    return rows


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write", action="store_true", help="write benchmarks/results/frames_to_look_at.md")
    parser.add_argument("--folder", type=Path, help="keep what was made here, or take it from here")
    parser.add_argument(
        "--only", metavar="NAME", help="measure NAME, NAME-track and NAME-det.json of --folder, all made before"
    )
    args = parser.parse_args()
    if args.only:
        print(*describe(measure(args.folder, (args.only,))), sep="\n")
        return
    with tempfile.TemporaryDirectory() as temporary:
        folder = args.folder or Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        print(f"{', '.join(CHOSEN_ON)}, on which limits were chosen:", *describe(measure(folder, CHOSEN_ON)), sep="\n")
        rows = describe(measure(folder, REPORTED))
    print(f"\n{', '.join(REPORTED)}:", *rows, sep="\n")
    if args.write:
        command = "python -m benchmarks.frames_to_look_at --write"
        write_result("frames_to_look_at", "The queue of frames to look at", command, "\n".join(rows))


if __name__ == "__main__":
    main()
