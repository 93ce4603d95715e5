"""Find fingertips: patches vote, peaks of the votes become detections, the best of those that overlap stay."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

from tracker.detection.detection import Detection
from tracker.detection.forest import Forest
from tracker.detection.levels import build_levels
from tracker.detection.patch_image import PatchImage
from tracker.detection.suppression import suppress
from tracker.detection.voting import vote_into
from tracker.observation import HAND, Observation

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class DetectOptions:
    """How fingertips are looked for.

    Attributes:
        min_confidence: c_thr, [T16] §3.2.5.
        max_overlap: Detections that overlap a better one by more are dropped, [T16] §3.2.5.
        stride: A patch at every so many px of a level in each direction.
        scales: Sizes of hands that are looked for, times the one trained; distance is taken care of besides.
        cell: Spacing of the votes' grid, m.
        blur: Standard deviation by which votes are smoothed, m.
        depth_reach: Points of a detection are at most so much nearer or farther than it, m.
        max_points: So many points of a detection are kept, evenly spread.
    """

    min_confidence: float = 3.0
    max_overlap: float = 0.5
    stride: int = 2
    scales: tuple[float, ...] = (1.0,)
    cell: float = 0.002
    blur: float = 0.0025
    depth_reach: float = 0.020
    max_points: int = 300


DEFAULT_OPTIONS = DetectOptions()


@dataclass(frozen=True)
class Peaks:
    """Where votes gather, most confident first.

    Attributes:
        centers: (N, 2) column and row, px of the image searched.
        boxes: (N, 4) left, top, right, bottom, px.
        confidences: (N,).
        depths: (N,) m.
    """

    centers: Array
    boxes: Array
    confidences: Array
    depths: Array

    def __len__(self) -> int:
        return len(self.confidences)


def find_in_image(forest: Forest, image: PatchImage, options: DetectOptions = DEFAULT_OPTIONS) -> Peaks:
    """Fingertips in an image, [T16] §3.2.5."""
    rows = [_find_at_scale(forest, image, options, scale) for scale in options.scales]
    found = np.concatenate(rows)
    half = 0.5 * forest.box_size * image.focal * found[:, 4:5] / np.maximum(found[:, 3:4], 1e-6)
    boxes = np.concatenate([found[:, :2] - half, found[:, :2] + half], axis=1)
    kept = suppress(boxes, found[:, 2], options.max_overlap)
    return Peaks(found[kept, :2], boxes[kept], found[kept, 2], found[kept, 3])


def find_fingertips(
    forest: Forest,
    observation: Observation,
    options: DetectOptions = DEFAULT_OPTIONS,
) -> tuple[Detection, ...]:
    """Fingertips among the pixels of an observation that may be hand, most confident first.

    Args:
        forest: A trained detector.
        observation: A region of one depth image; with its colour for a forest that looks at colour.
        options: How to look.
    """
    peaks = find_in_image(forest, PatchImage.of(observation), options)
    region, K = observation.region, observation.K
    stride = max(1, round(region.width / observation.depth.shape[1]))
    first = np.array([region.column, region.row], dtype=np.float64)
    detections = []
    for center, box, confidence, depth in zip(peaks.centers, peaks.boxes, peaks.confidences, peaks.depths, strict=True):
        points = _points_in(observation, box, float(depth), options)
        if len(points) == 0:
            continue
        rays = (box - K[[0, 1, 0, 1], 2]) / K[[0, 1, 0, 1], [0, 1, 0, 1]]
        detections.append(
            Detection(
                center_px=center * stride + first,
                box=box * stride + np.tile(first, 2),
                box_rays=rays,
                confidence=float(confidence),
                depth=float(depth),
                points=points,
                centroid=points.mean(axis=0),
            )
        )
    return tuple(detections)


def _find_at_scale(forest: Forest, image: PatchImage, options: DetectOptions, scale: float) -> Array:
    """(N, 5) column, row, confidence, depth and scale of each peak."""
    levels = build_levels(image, forest.kind, forest.pixel_size, options.stride, scale)
    levels = [level for level in levels if len(level.centers)]
    if not levels:
        return np.zeros((0, 5))
    cell = max(0.5, options.cell * image.focal / float(np.mean([level.depth for level in levels])))
    height, width = (int(np.ceil(length / cell)) + 1 for length in image.depth.shape)
    density = np.zeros((height, width), dtype=np.float32)
    depth_sum = np.zeros_like(density)
    for level in levels:
        # A blurred vote is 1 at its peak, and patches that are left out are made up for by the others.
        vote_into(density, depth_sum, forest, level, cell, options.stride**2 / forest.num_trees)
    sigma = options.blur / options.cell
    gain = 2.0 * np.pi * sigma * sigma
    density = cv2.GaussianBlur(density, (0, 0), sigma) * np.float32(gain * forest.confidence_scale)
    depth_sum = cv2.GaussianBlur(depth_sum, (0, 0), sigma) * np.float32(gain * forest.confidence_scale)
    highest = cv2.dilate(density, np.ones((3, 3), np.uint8))
    rows, columns = np.nonzero((density >= highest) & (density >= max(options.min_confidence, 1e-3)))
    peaks = np.empty((len(rows), 5))
    for place, (row, column) in enumerate(zip(rows, columns, strict=True)):
        strength = float(density[row, column])
        peaks[place] = (
            cell * (column + _refine(density[row], int(column))),
            cell * (row + _refine(density[:, column], int(row))),
            strength,
            float(depth_sum[row, column]) / strength,
            scale,
        )
    return peaks


def _refine(line: npt.NDArray[np.float32], place: int) -> float:
    """Where, between -0.5 and 0.5 of a cell, the parabola through a maximum and its neighbours is highest."""
    if place == 0 or place == len(line) - 1:
        return 0.0
    before, at, after = (float(line[place + step]) for step in (-1, 0, 1))
    curvature = before - 2.0 * at + after
    return 0.0 if curvature >= 0.0 else float(np.clip(0.5 * (before - after) / curvature, -0.5, 0.5))


def _points_in(observation: Observation, box: Array, depth: float, options: DetectOptions) -> Array:
    """Points of hand in a box, (N, 3) world, m, those nearly at a depth, at most `max_points` evenly spread."""
    height, width = observation.depth.shape
    left, top = np.maximum(np.ceil(box[:2]).astype(int), 0)
    right, bottom = min(int(box[2]) + 1, width), min(int(box[3]) + 1, height)
    if left >= right or top >= bottom:
        return np.zeros((0, 3))
    inside = (slice(top, bottom), slice(left, right))
    near = np.abs(observation.depth[inside] - depth) <= options.depth_reach
    points = observation.points[inside][((observation.labels[inside] & HAND) > 0) & near]
    step = max(1, int(np.ceil(len(points) / options.max_points)))
    return points[::step].astype(np.float64)
