"""How near a model fit comes to the joints that nobody has placed yet: `python -m benchmarks.suggestions FOLDER`.

FOLDER holds T16's `Cameras.txt`, `models/` and `seq/`: real motions, rendered with a sensor's noise, every joint known.
Of each hand that is wholly in the image the first joints of ORDER count as placed, to the pixel, and the fit
is judged by the others. `--write` writes `benchmarks/results/suggestions.md`.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from benchmarks.result_page import write_result
from tracker.capture.annotations import Annotation, load_annotations
from tracker.capture.sequence import Sequence
from tracker.model import save_model
from tracker.model.default_hand import default_hand
from tracker.model.files import load_model
from tracker.synthesis.recording import RecordingOptions, write_recording
from tracker.synthesis.twin import load_twin
from tracker.tracking.quick_fit import fit_marked

SEQUENCES = ("01", "04", "09", "12", "15", "17", "20")
FRAMES = 12
"""So many of each sequence, evenly spread."""

ORDER = (0, 5, 17, 12, 4, 20, 8, 16, 9, 13, 1, 2)
"""As an annotator in a hurry would go on: wrist, both ends of the palm, then tips."""

PLACED = (4, 6, 8, 12)


def render(folder: Path, out: Path) -> Iterator[tuple[Sequence, Annotation]]:
    """Each hand that is wholly in a rendered image, with its recording."""
    for name in SEQUENCES:
        twin = load_twin(folder, name, 1500)
        step = max(1, twin.num_moments // FRAMES)
        options = RecordingOptions(range(step // 2, twin.num_moments, step), seed=3)
        recording = write_recording(twin, out / name, options, save_model)
        print(f"rendered {name}", flush=True)
        for item in load_annotations(out / name / "annotations.json").items:
            if np.all(item.points[:, 2] > 0):
                yield recording, item


def judge(hands: list[tuple[Sequence, Annotation]], placed: int, is_own: bool, with_depth: bool) -> str:
    """A row of the table."""
    errors, seconds, guesses = [], [], []
    is_open = np.ones(21, dtype=bool)
    is_open[list(ORDER[:placed])] = False
    for recording, item in hands:
        model = load_model(recording.folder / "models" / f"{item.hand}.npz") if is_own else default_hand(item.hand)
        frame = recording.frame(item.frame, item.camera) if with_depth else None
        points = item.points.copy()
        points[is_open, 2] = 0
        began = time.perf_counter()
        fit = fit_marked(model, points, recording.camera(item.camera), frame)
        seconds.append(time.perf_counter() - began)
        errors.append(np.linalg.norm(fit.joints - item.points[:, :2], axis=1)[is_open])
        guesses.append((fit.is_hidden == (item.points[:, 2] == 1))[is_open])
    of_hands = [float(np.mean(error)) for error in errors]
    everything = np.concatenate(errors)
    cells = (
        "own" if is_own else "default",
        "yes" if with_depth else "no",
        placed,
        f"{np.mean(everything):.1f}",
        f"{np.median(everything):.1f}",
        f"{np.percentile(of_hands, 90):.1f}",
        f"{100 * np.mean(np.concatenate(guesses)):.0f} %",
        f"{1e3 * np.median(seconds):.0f}",
        f"{1e3 * np.percentile(seconds, 95):.0f}",
    )
    return "| " + " | ".join(map(str, cells)) + " |"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--write", action="store_true", help="write benchmarks/results/suggestions.md")
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as out:
        hands = list(render(args.folder, Path(out)))
        judge(hands[:2], 6, False, True)  # kernels are loaded by then
        rows = [
            "| hand model | depth | placed | mean, px | median, px | 90 % of hands below, px | visibility right | ms | "
            "ms, 95 % |",
            "|---|---|---|---|---|---|---|---|---|",
        ]
        for is_own in (False, True):
            for with_depth in (True, False):
                rows += [judge(hands, placed, is_own, with_depth) for placed in PLACED]
    print(f"{len(hands)} hands")
    print("\n".join(rows))
    if args.write:
        command = "python -m benchmarks.suggestions FOLDER_OF_T16_DATA --write"
        text = "\n".join([f"{len(hands)} hands:\n", *rows])
        write_result("suggestions", "Fits to the joints placed so far", command, text)


if __name__ == "__main__":
    main()
