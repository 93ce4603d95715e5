"""A picture of one annotated hand: what people marked and where the track has it, cut out of the image."""

from __future__ import annotations

import cv2
import numpy as np
import numpy.typing as npt

from tracker.capture.sequence import Sequence
from tracker.evaluation.error_color import compute_error_color
from tracker.evaluation.evaluation import Evaluation
from tracker.model.joints import HAND_EDGES

SIZE = (384, 288)
"""Width and height of a picture, px."""
MARGIN = 0.12
"""Of the hand's box, on every side."""
SMALLEST = 64
"""Width below which nothing is enlarged further, image px."""
FULL_PX = 20.0
"""Error at which the colour scale ends, px."""
MARKED, GREY = (255, 255, 255), (120, 126, 134)
"""RGB of labels, and of joints that were left out."""

Image = npt.NDArray[np.uint8]


def draw_worst_picture(
    sequence: Sequence,
    frame: int,
    camera: str,
    marked: npt.NDArray[np.float64],
    tracked: npt.NDArray[np.float64],
    visibility: npt.NDArray[np.int64],
    left_out: npt.NDArray[np.bool_],
) -> Image:
    """(288, 384, 3) RGB: marks as white rings with solid bones, the track as crosses in the colour of their error.

    Marks that do not count are grey rings, without a line to the track.

    Args:
        marked: (21, 2) px.
        tracked: (21, 2) px; NaN where a joint does not project.
        visibility: (21,) 0 absent, 1 occluded, 2 visible.
        left_out: (21,) marks that do not count.
    """
    image = _load_image(sequence, frame, camera)
    is_marked: npt.NDArray[np.bool_] = np.asarray(visibility > 0)
    is_tracked: npt.NDArray[np.bool_] = np.asarray(np.isfinite(tracked).all(axis=1))
    scale, corner = _find_window(image, marked[is_marked], tracked[is_tracked])
    warp = np.array([[scale, 0.0, -scale * corner[0]], [0.0, scale, -scale * corner[1]]])
    picture = cv2.warpAffine(image, warp, SIZE, flags=cv2.INTER_AREA if scale < 1 else cv2.INTER_LINEAR)
    picture = (picture * 0.75).astype(np.uint8)
    marks = scale * (np.nan_to_num(marked) - corner)
    tracks = scale * (np.nan_to_num(tracked) - corner)
    error = np.linalg.norm(np.nan_to_num(tracked) - marked, axis=1)
    for start, end in HAND_EDGES:
        if is_tracked[start] and is_tracked[end]:
            _line(picture, tracks[start], tracks[end], GREY, 1)
        if is_marked[start] and is_marked[end]:
            _line(picture, marks[start], marks[end], MARKED, 1)
    for joint in np.flatnonzero(is_marked & is_tracked & ~left_out):
        color = compute_error_color(error[joint] / FULL_PX)
        _line(picture, marks[joint], tracks[joint], color, 2)
        _cross(picture, tracks[joint], color)
    for joint in np.flatnonzero(is_marked):
        _ring(picture, marks[joint], GREY if left_out[joint] else MARKED, is_filled=visibility[joint] == 2)
    return picture


def draw_item(sequence: Sequence, evaluation: Evaluation, item: int) -> Image:
    """The picture of one item of an evaluation."""
    return draw_worst_picture(
        sequence,
        int(evaluation.frame[item]),
        evaluation.camera[item],
        evaluation.marked[item],
        evaluation.tracked[item],
        evaluation.visibility[item],
        evaluation.left_out[item],
    )


def encode_jpeg(picture: Image) -> bytes:
    """The picture's file."""
    is_done, data = cv2.imencode(".jpg", cv2.cvtColor(picture, cv2.COLOR_RGB2BGR), [cv2.IMWRITE_JPEG_QUALITY, 85])
    assert is_done
    return data.tobytes()


def _load_image(sequence: Sequence, frame: int, camera: str) -> Image:
    if sequence.camera(camera).has_color:
        return sequence.color(frame, camera)
    depth = sequence.depth_raw(frame, camera).astype(np.float64)
    known = depth[depth > 0]
    near, far = np.percentile(known, (1, 99)) if known.size else (0.0, 1.0)
    gray = np.where(depth > 0, 255 - 215 * np.clip((depth - near) / max(far - near, 1.0), 0, 1), 0).astype(np.uint8)
    return np.repeat(gray[:, :, None], 3, axis=2)


def _find_window(
    image: Image, marked: npt.NDArray[np.float64], tracked: npt.NDArray[np.float64]
) -> tuple[float, npt.NDArray[np.float64]]:
    """Scale and top-left corner (image px) of a window with the proportions of SIZE around the joints.

    A track that flew off far is let go: the window is at most three times as large as the marked hand asks for.
    """
    low, high = marked.min(axis=0), marked.max(axis=0)
    reach = max(float((high - low).max()), SMALLEST / 2)
    if len(tracked):
        near = np.clip(tracked, low - reach, high + reach)
        low, high = np.minimum(low, near.min(axis=0)), np.maximum(high, near.max(axis=0))
    wanted = (high - low) * (1 + 2 * MARGIN)
    width = max(float(wanted[0]), float(wanted[1]) * SIZE[0] / SIZE[1], float(SMALLEST))
    size = np.array([width, width * SIZE[1] / SIZE[0]])
    room = np.array([image.shape[1], image.shape[0]], dtype=np.float64)
    corner = (low + high) / 2 - size / 2
    corner = np.where(size < room, np.clip(corner, 0.0, np.maximum(room - size, 0.0)), (room - size) / 2)
    return SIZE[0] / width, corner


def _at(point: npt.NDArray[np.float64]) -> tuple[int, int]:
    x, y = np.clip(np.round(16 * point), -(2**20), 2**20)
    return int(x), int(y)


def _line(
    picture: Image, start: npt.NDArray[np.float64], end: npt.NDArray[np.float64], color: tuple[int, ...], width: int
) -> None:
    cv2.line(picture, _at(start), _at(end), color, width, cv2.LINE_AA, shift=4)


def _ring(picture: Image, point: npt.NDArray[np.float64], color: tuple[int, ...], *, is_filled: bool) -> None:
    cv2.circle(picture, _at(point), 16 * 4, (0, 0, 0), 3, cv2.LINE_AA, shift=4)
    cv2.circle(picture, _at(point), 16 * 4, color, 1, cv2.LINE_AA, shift=4)
    if is_filled:
        cv2.circle(picture, _at(point), 16 * 1, color, -1, cv2.LINE_AA, shift=4)


def _cross(picture: Image, point: npt.NDArray[np.float64], color: tuple[int, ...]) -> None:
    for way in ((4.0, 4.0), (4.0, -4.0)):
        _line(picture, point - way, point + np.array(way), (0, 0, 0), 4)
    for way in ((4.0, 4.0), (4.0, -4.0)):
        _line(picture, point - way, point + np.array(way), color, 2)
