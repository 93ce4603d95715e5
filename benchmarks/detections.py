"""How well fingertips are found on twins of T16's sequences: `python -m benchmarks.detections FOLDER [--write]`.

FOLDER holds the authors' `Cameras.txt`, `models/` and `seq/`. Judged as in PASCAL-VOC over five sequences: the detector
that comes with Handloom, which has seen renders of its own hand only, and detectors trained on three other sequences.
`--write` writes the table and the curves into `benchmarks/results` and the picture into `docs/pictures`.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np

from benchmarks.result_page import RESULTS, write_result
from tracker.capture.annotations import load_annotations
from tracker.capture.atomic_file import write_atomically
from tracker.capture.sequence import Sequence, load_sequence
from tracker.detection import Forest, find_in_image
from tracker.detection.annotated_images import AnnotatedImage, annotated_images
from tracker.detection.confidence import C_THR, calibrate_confidence
from tracker.detection.default_detector import default_detector
from tracker.detection.detect import DetectOptions
from tracker.detection.sampling import PatchOptions, join_patches, sample_patches
from tracker.detection.training import ForestOptions, train_forest
from tracker.evaluation.detections import PrecisionRecall, compute_precision_recall
from tracker.evaluation.detector_study import ANY_CONFIDENCE, judge_image
from tracker.model import save_model
from tracker.synthesis.recording import RecordingOptions, write_recording
from tracker.synthesis.twin import load_twin

DOCS = Path(__file__).resolve().parents[1] / "docs"
TRAINED_ON, TESTED_ON = ("01", "15", "18"), ("04", "09", "12", "17", "20")
FRAMES = 40
"""So many of each sequence, evenly spread."""

SMALL = ForestOptions(tests=4000, patches=20_000)
COLORS = ((200, 80, 20), (200, 160, 20), (60, 160, 60), (40, 40, 200), (160, 40, 160))
HEADER = (
    "| detector | looks at | pixels | AUC | " + " | ".join(TESTED_ON) + " | precision, recall at 3.0 | ms |",
    "|---|---|---|---|" + "---|" * len(TESTED_ON) + "---|---|",
)


def render(folder: Path, out: Path, names: tuple[str, ...]) -> dict[str, Sequence]:
    """Recordings of the sequences, `FRAMES` frames each."""
    recordings = {}
    for name in names:
        twin = load_twin(folder, name, 1500)
        step = max(1, twin.num_moments // FRAMES)
        options = RecordingOptions(range(step // 2, twin.num_moments, step), seed=3)
        recordings[name] = write_recording(twin, out / name, options, save_model)
        print(f"rendered {name}", flush=True)
    return recordings


def images(recording: Sequence, use_skin: bool) -> Iterator[AnnotatedImage]:
    path = recording.annotations_path
    assert path is not None
    yield from annotated_images(load_sequence(recording.folder), load_annotations(path), 1, use_skin)


def train(recordings: dict[str, Sequence], kind: str, threads: int) -> Forest:
    """A detector that learnt from the sequences TRAINED_ON."""
    about, rng = PatchOptions(kind=kind, per_image=150), np.random.default_rng(0)
    parts, held_out = [], []
    for name in TRAINED_ON:
        for number, item in enumerate(images(recordings[name], True)):
            if number >= 0.9 * recordings[name].frame_count:  # frames next to those learnt from would tell little
                held_out.append(item)
            else:
                parts.append(sample_patches(item.image, item.tips, item.is_visible, about, rng))
    forest = train_forest(join_patches(parts), about, replace(SMALL, threads=threads))
    curve = compute_precision_recall([judge_image(forest, item) for item in held_out])
    return calibrate_confidence(forest, curve.confidences, curve.precision)


def judge(
    forest: Forest, recordings: dict[str, Sequence], use_skin: bool, options: DetectOptions
) -> tuple[PrecisionRecall, dict[str, float], float]:
    """The curve over all test sequences, the area for each, and the median time of an image, ms."""
    everything, areas, times = [], {}, []
    for name in TESTED_ON:
        judged = []
        for item in images(recordings[name], use_skin):
            began = time.perf_counter()
            find_in_image(forest, item.image, replace(options, min_confidence=C_THR))
            times.append(time.perf_counter() - began)
            judged.append(judge_image(forest, item, options))
        areas[name] = compute_precision_recall(judged).auc
        everything += judged
    return compute_precision_recall(everything), areas, 1e3 * float(np.median(times))


def draw(curves: dict[str, PrecisionRecall]) -> np.ndarray:
    """The curves as a picture."""
    size, margin = 480, 60
    picture = np.full((size + 2 * margin, size + 2 * margin, 3), 255, dtype=np.uint8)
    font, grey = cv2.FONT_HERSHEY_SIMPLEX, (90, 90, 90)

    def place(recall: float, precision: float) -> tuple[int, int]:
        return round(margin + size * recall), round(margin + size * (1.0 - precision))

    for tick in np.linspace(0.0, 1.0, 6):
        cv2.line(picture, place(tick, 0.0), place(tick, 1.0), (225, 225, 225))
        cv2.line(picture, place(0.0, tick), place(1.0, tick), (225, 225, 225))
        x, y = place(tick, 0.0)
        cv2.putText(picture, f"{tick:.1f}", (x - 12, y + 22), font, 0.45, grey, 1, cv2.LINE_AA)
        x, y = place(0.0, tick)
        cv2.putText(picture, f"{tick:.1f}", (x - 38, y + 5), font, 0.45, grey, 1, cv2.LINE_AA)
    cv2.putText(picture, "recall", (margin + size // 2 - 20, margin + size + 46), font, 0.5, grey, 1, cv2.LINE_AA)
    cv2.putText(picture, "precision", (8, margin - 18), font, 0.5, grey, 1, cv2.LINE_AA)
    for number, (name, curve) in enumerate(curves.items()):
        color = COLORS[number % len(COLORS)]
        points = np.array([place(r, p) for r, p in zip(curve.recall, curve.precision, strict=True)], dtype=np.int32)
        cv2.polylines(picture, [points.reshape(-1, 1, 2)], False, color, 2, cv2.LINE_AA)
        y = margin + size - 20 - 20 * (len(curves) - number)
        cv2.putText(picture, f"{name}: AUC {curve.auc:.2f}", (margin + 14, y), font, 0.45, color, 1, cv2.LINE_AA)
    return picture


def write(rows: list[str], curves: dict[str, PrecisionRecall]) -> None:
    """The table, the picture, and points of the curves."""
    command = "python -m benchmarks.detections FOLDER_OF_T16_DATA --write"
    write_result("detection", "Fingertips found on twins", command, "\n".join(rows))
    done, data = cv2.imencode(".png", draw(curves))
    assert done
    write_atomically(DOCS / "pictures" / "detection.png", data.tobytes())
    lines = ["detector,confidence,precision,recall"]
    for name, curve in curves.items():
        for n in range(0, len(curve.confidences), max(1, len(curve.confidences) // 100)):
            lines.append(f"{name},{curve.confidences[n]:.3f},{curve.precision[n]:.4f},{curve.recall[n]:.4f}")
    write_atomically(RESULTS / "detection.csv", ("\n".join(lines) + "\n").encode())


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--write", action="store_true", help="write benchmarks/results/detection.*")
    parser.add_argument("--threads", type=int, default=1, help="of the training")
    args = parser.parse_args()
    cv2.setNumThreads(1)
    coarse = replace(ANY_CONFIDENCE, stride=DetectOptions().stride)
    with tempfile.TemporaryDirectory() as temporary:
        recordings = render(args.folder, Path(temporary), TRAINED_ON + TESTED_ON)
        ours = default_detector()
        depth, color = (train(recordings, kind, args.threads) for kind in ("depth", "color"))
        cases = (
            ("ours, stride 1", "depth", ours, True, ANY_CONFIDENCE),
            ("ours", "depth", ours, True, coarse),
            ("ours", "depth", ours, False, coarse),
            ("trained on 01, 15, 18", "depth", depth, True, coarse),
            ("trained on 01, 15, 18", "colour", color, True, coarse),
        )
        rows, curves = list(HEADER), {}
        for name, looks_at, forest, use_skin, options in cases:
            curve, areas, ms = judge(forest, recordings, use_skin, options)
            precision, recall = curve.at(C_THR)
            pixels = "hands'" if use_skin else "all"
            curves[f"{name}, {looks_at}, {pixels} pixels"] = curve
            each = " | ".join(f"{areas[sequence]:.2f}" for sequence in TESTED_ON)
            rows.append(
                f"| {name} | {looks_at} | {pixels} | **{curve.auc:.3f}** | {each} "
                f"| {precision:.3f}, {recall:.3f} | {ms:.1f} |"
            )
            print(rows[-1], flush=True)
        print(f"{curve.num_truths} visible fingertips in {curve.num_images} images")
    if args.write:
        write(rows, curves)


if __name__ == "__main__":
    main()
