"""Detections against annotated fingertips as in the PASCAL-VOC challenge: precision, recall, area under the curve."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class JudgedImage:
    """Detections of one image, judged.

    Attributes:
        confidences: (N,) of the detections that count.
        is_true: (N,) whether each found a fingertip that no better one had found.
        num_truths: Fingertips that were to be found.
    """

    confidences: Array
    is_true: npt.NDArray[np.bool_]
    num_truths: int


@dataclass(frozen=True)
class PrecisionRecall:
    """A precision-recall curve, most confident detections first.

    Attributes:
        confidences: (N,) of the detections, from all images.
        precision: (N,) share of true ones among those at least as confident.
        recall: (N,) share of all fingertips that these found.
        auc: Area under the curve with precision made monotone, over all points (VOC since 2010).
        num_truths: Fingertips.
        num_images: Images.
    """

    confidences: Array
    precision: Array
    recall: Array
    auc: float
    num_truths: int
    num_images: int

    def at(self, confidence: float) -> tuple[float, float]:
        """Precision and recall of the detections of at least this confidence; precision 1 if there are none."""
        kept = int(np.count_nonzero(self.confidences >= confidence))
        return (1.0, 0.0) if kept == 0 else (float(self.precision[kept - 1]), float(self.recall[kept - 1]))


def judge_boxes(confidences: Array, overlaps: Array, is_easy: npt.NDArray[np.bool_], least: float = 0.5) -> JudgedImage:
    """Judge the detections of one image: M. Everingham et al., "The PASCAL visual object classes challenge", 2010.

    Each detection, most confident first, goes to the fingertip whose box it overlaps most. It is true if it does so by
    at least `least` and that fingertip has not been found before. Detections of fingertips that are not easy, those
    that are occluded, count neither way.

    Args:
        confidences: (N,).
        overlaps: (N, T) intersection over union with the boxes of the true fingertips.
        is_easy: (T,) whether a fingertip is to be found.
        least: Smallest overlap that counts.
    """
    assert overlaps.shape == (len(confidences), len(is_easy))
    found = np.zeros(len(is_easy), dtype=bool)
    kept, is_true = [], []
    for row in np.argsort(-confidences, kind="stable"):
        nearest = int(np.argmax(overlaps[row])) if len(is_easy) else -1
        hit = nearest >= 0 and overlaps[row, nearest] >= least
        if hit and not is_easy[nearest]:
            continue
        kept.append(row)
        is_true.append(hit and not found[nearest])
        if hit:
            found[nearest] = True
    return JudgedImage(
        confidences[np.array(kept, dtype=np.int64)], np.array(is_true, dtype=bool), int(np.count_nonzero(is_easy))
    )


def compute_precision_recall(images: list[JudgedImage]) -> PrecisionRecall:
    """The curve over all images together."""
    confidences = np.concatenate([np.zeros(0), *(image.confidences for image in images)])
    is_true = np.concatenate([np.zeros(0, dtype=bool), *(image.is_true for image in images)])
    num_truths = sum(image.num_truths for image in images)
    order = np.argsort(-confidences, kind="stable")
    hits = np.cumsum(is_true[order])
    precision = hits / np.arange(1, len(order) + 1)
    recall = hits / max(num_truths, 1)
    # All-point interpolation: at every recall the best precision at this or a larger one.
    envelope = np.maximum.accumulate(precision[::-1])[::-1]
    auc = float(np.sum(np.diff(np.r_[0.0, recall]) * envelope))
    return PrecisionRecall(confidences[order], precision, recall, auc, num_truths, len(images))
