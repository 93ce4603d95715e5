"""[T16] Figure 13: precision and recall of the fingertip detector."""

from __future__ import annotations

import tempfile
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import cv2
import numpy as np

from benchmarks import detections
from benchmarks.studies import paper
from benchmarks.studies.blocks import Block, Picture, Table, Text
from benchmarks.studies.plots import Lines, Series, draw_plot
from benchmarks.studies.study import Extent, Row, Study
from benchmarks.studies.trial import Results
from tracker.detection.confidence import C_THR
from tracker.detection.default_detector import default_detector
from tracker.detection.detect import DetectOptions
from tracker.evaluation.detector_study import ANY_CONFIDENCE

POINTS = 60
"""Of a curve that are kept."""


@dataclass(frozen=True)
class DetectorCurves:
    """Our detector, and (`with_trained`) forests trained on three of the sequences, judged on five others."""

    with_trained: bool

    def __call__(self, data: Path, twins: Path) -> dict[str, Any]:
        """Render, train, judge; twins are rendered anew, 40 frames or so of each."""
        cv2.setNumThreads(1)
        coarse = replace(ANY_CONFIDENCE, stride=DetectOptions().stride)
        names = detections.TESTED_ON + (detections.TRAINED_ON if self.with_trained else ())
        with tempfile.TemporaryDirectory() as temporary:
            recordings = detections.render(data, Path(temporary), names)
            cases = [("ours", "depth", default_detector(), True), ("ours, nothing taken out", "depth", None, False)]
            if self.with_trained:
                cases += [
                    (
                        f"trained on {', '.join(detections.TRAINED_ON)}",
                        looks_at,
                        detections.train(recordings, kind, 1),
                        True,
                    )
                    for looks_at, kind in (("depth", "depth"), ("colour", "color"))
                ]
            rows = []
            for name, looks_at, forest, use_skin in cases:
                forest = forest or default_detector()
                curve, areas, _ = detections.judge(forest, recordings, use_skin, coarse)
                precision, recall = curve.at(C_THR)
                kept = np.unique(np.linspace(0, len(curve.recall) - 1, POINTS).astype(int))
                rows.append(
                    {
                        "detector": name,
                        "looks_at": looks_at,
                        "auc": curve.auc,
                        "areas": areas,
                        "precision": precision,
                        "recall": recall,
                        "tips": curve.num_truths,
                        "images": curve.num_images,
                        "curve": [
                            [round(float(curve.recall[n]), 4), round(float(curve.precision[n]), 4)] for n in kept
                        ],
                    }
                )
        return {"rows": rows}


def trials(extent: Extent) -> list[DetectorCurves]:
    return [DetectorCurves(with_trained=not extent.quick)]


def tabulate(results: Results, extent: Extent) -> list[Row]:
    return results[trials(extent)[0]]["rows"]


def show(rows: list[Row]) -> list[Block]:
    names = [f"{row['detector']}, {row['looks_at']}" for row in rows]
    sequences = list(rows[0]["areas"])
    cells = [
        (
            name,
            f"{row['auc']:.3f}",
            *(f"{row['areas'][sequence]:.2f}" for sequence in sequences),
            f"{row['precision']:.2f}, {row['recall']:.2f}",
            "",
        )
        for name, row in zip(names, rows, strict=True)
    ]
    cells += [(f"T16, {on}", *[""] * (len(sequences) + 2), f"{auc:.2f}") for on, auc in paper.FIGURE_13_AUC.items()]
    drawn = draw_plot(
        [
            Lines(
                "Precision and recall, twins",
                "recall",
                "precision",
                [
                    Series(name, [p[0] for p in row["curve"]], [p[1] for p in row["curve"]], has_marks=False)
                    for name, row in zip(names, rows, strict=True)
                ],
                y_top=1.0,
            )
        ],
        "Precision and recall of fingertip detectors",
    )
    return [
        Table(
            ("detector", "AUC", *(f"AUC {s}" for s in sequences), "precision, recall at 3.0", "T16 AUC"), tuple(cells)
        ),
        Picture("figure_13", drawn, "Of the paper's curves only the areas are printed."),
        Text(
            f"{rows[0]['tips']} visible fingertips in {rows[0]['images']} images. Our detector has seen renders of its "
            "own hand only, none of these hands or motions; the trained ones have seen other motions of these hands. "
            "The sequences were looked at when its pixel size and blur were chosen (docs/objective.md)."
        ),
    ]


STUDY = Study(
    name="figure_13",
    title="Precision and recall of the fingertip detector",
    paper="Figure 13, §4.1.2",
    question="How well are fingertips found?",
    same="A Hough forest of ten trees on eleven channels; PASCAL-VOC: a box counts if it overlaps a tip's by half.",
    differs="Rendered images in place of recorded ones: the noise is simpler and a twin's colour is nothing but "
    "shading, so areas are not comparable. Boxes are of 32 mm; Dexter is not at hand.",
    trials=trials,
    tabulate=tabulate,
    show=show,
)
