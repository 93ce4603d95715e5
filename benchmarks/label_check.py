"""How many injected mistakes the label check finds: `python -m benchmarks.label_check [--write]`.

Two hands are rendered moving, every frame labelled with 1.5 px of noise, as people have it ([T16] §4.2); one label in
ten gets a mistake. `--write` writes `benchmarks/results/label_check.md`.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
import uuid
from collections import Counter, defaultdict
from pathlib import Path

import numpy as np

from benchmarks.result_page import write_result
from server.quality.find import Setting, find_flags
from server.quality.labels import LabelReader
from tests.server.quality.errors import KINDS, Item, inject
from tracker import load_annotations, load_sequence

MOTIONS = ("open-close", "wave", "count", "pinch")
FRAMES, EVERY, SEEDS, NOISE_PX = 60, 10, 3, 1.5


class Row:
    """A label as the table of annotations holds it."""

    def __init__(self, item: Item) -> None:
        self.id, self.revision, self.camera, self.sources = uuid.uuid4(), 1, "cam0", None
        self.frame, self.hand, self.points = item.frame, item.hand, item.points.tolist()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write", action="store_true", help="write benchmarks/results/label_check.md")
    args = parser.parse_args()
    found: dict[str, list[int]] = defaultdict(list)
    flagged = wrong = false = labels = clean_flags = clean_labels = 0
    precision_at: list[float] = []
    kinds: Counter[str] = Counter()
    with tempfile.TemporaryDirectory() as folder:
        for motion in MOTIONS:
            out = Path(folder) / motion
            command = ["synthesize", "--motion", motion, "--hand", "right", "--hand", "left", "--frames", f"0:{FRAMES}"]
            subprocess.run(
                [sys.executable, "-m", "server.cli", *command, "--out", out], check=True, capture_output=True
            )
            recording = load_sequence(out)
            setting = Setting(recording.hands, {"cam0": recording.camera("cam0")})
            for seed in range(SEEDS):
                rng = np.random.default_rng(seed)
                items = [
                    Item(a.frame, a.hand, a.points.copy()) for a in load_annotations(out / "annotations.json").items
                ]
                for item in items:
                    item.points[:, :2] += rng.normal(0, NOISE_PX, (21, 2)) * (item.points[:, 2:] > 0)
                rows = LabelReader().read(recording, [Row(item) for item in items])
                clean_flags += len({flag.label.id for flag in find_flags(rows, setting)})
                clean_labels += len(rows)
                kinds.update(flag.kind for flag in find_flags(rows, setting))
                before = {(item.frame, item.hand): item.points.copy() for item in items}
                made: dict[int, str] = {}
                for number, frame in enumerate(range(EVERY // 2, FRAMES, EVERY)):
                    made[frame] = KINDS[(number + seed) % len(KINDS)]
                    inject(items, made[frame], frame, rng)
                is_wrong = {
                    k for item in items if not np.array_equal(before[k := (item.frame, item.hand)], item.points)
                }
                flags = find_flags(LabelReader().read(recording, [Row(item) for item in items]), setting)
                places = list(dict.fromkeys((flag.label.frame, flag.label.hand) for flag in flags))
                for frame, kind in made.items():
                    found[kind].append(any(place in places for place in is_wrong if place[0] == frame))
                flagged += len(places)
                wrong += len(is_wrong)
                false += len(set(places) - is_wrong)
                labels += len(items)
                top = places[: len(is_wrong)]
                precision_at.append(np.mean([place in is_wrong for place in top]))
    rows_ = ["| mistake | injected | found |", "|---|---|---|"]
    rows_ += [
        f"| {kind} | {len(found[kind])} | {sum(found[kind])} ({100 * np.mean(found[kind]):.0f} %) |" for kind in KINDS
    ]
    every = [hit for hits in found.values() for hit in hits]
    rows_ += [
        f"\nRecall of mistakes {100 * np.mean(every):.0f} %; of {flagged} flagged labels {flagged - false} hold one "
        f"(precision {100 * (1 - false / flagged):.0f} %); of as many as there are wrong labels, from the worst on, "
        f"{100 * np.mean(precision_at):.0f} % do. Labels without any mistake: {clean_flags} of {clean_labels} flagged "
        f"({100 * clean_flags / clean_labels:.1f} %)."
    ]
    print("\n".join(rows_))
    print("flags of labels without a mistake:", dict(kinds))
    if args.write:
        command = "python -m benchmarks.label_check --write"
        write_result("label_check", "Mistakes that the label check finds", command, "\n".join(rows_))


if __name__ == "__main__":
    main()
