"""Find the hands of an image, and follow them from image to image."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cache, cached_property
from threading import Lock

import cv2
import numpy as np
import numpy.typing as npt

from tracker.capture.exposure import brighten
from tracker.capture.grey import is_grey
from tracker.landmarks.detected_hand import DetectedHand
from tracker.landmarks.network import Run, load_network
from tracker.landmarks.palms import find_palms, load_palm_network
from tracker.landmarks.square import Square

PIXELS = 224
"""Side of the landmark network's image."""

MIN_PRESENCE = 0.5
"""MediaPipe's own."""

SIDE_MEMORY = 0.8
"""Share of the side that is remembered: hands that cross look like each other for some frames."""

DARK = 70
"""Grey images with a mean below this are brightened: of the marked fingertips in two infrared views the detector puts
48 and 31 % within 12 px so, 33 and 12 % as they are; in a third 36 and 39 %."""

MIN_SIZE, MAX_SIZE = 4.0, 4.0
"""A square smaller than this, px, or larger than this many images, is of no hand."""

WIDER = 1.25
"""Times a hand's square, in which something else often is no hand any more: a red tool is one in none of 4 frames of a
film that were looked at, and all 27 hands of three recordings are; a false hand of 50 px in one of them is too."""


class HandDetector:
    """Both networks; they are read when first needed.

    Args:
        threads: For onnxruntime.
    """

    def __init__(self, threads: int = 1) -> None:
        self._threads = threads
        self._lock = Lock()

    def find(
        self,
        image: npt.NDArray[np.uint8],
        hands: int = 2,
        before: Sequence[DetectedHand] = (),
        turns: Sequence[int] = (0,),
        accept: Callable[[DetectedHand], bool] | None = None,
    ) -> list[DetectedHand]:
        """The hands of an image.

        The same images in the same order give the same hands: the detector itself remembers nothing.

        Args:
            image: (H, W, 3) red green blue, or (H, W) grey.
            hands: At most so many. Palms are looked for only when fewer were followed.
            before: What was found in the image before.
            turns: By so many quarters, counterclockwise, the image is turned to look for palms, in this order until all
                hands are found. The network knows hands that point up best; a turn costs as much as a look.
            accept: Whether something found is a hand; what is not is not given back; a palm there may still tell one.

        Returns:
            Those that were followed first, in their order.
        """
        image = _brighten(as_color(image))
        found: list[DetectedHand] = []

        def add(hand: DetectedHand | None, earlier: DetectedHand | None = None) -> None:
            if hand is not None and (accept is None or accept(hand)):
                self._add(found, hand, earlier)

        for hand in before:
            add(self._look(image, hand.next_square), hand)
        for turn in turns:
            if len(found) < hands:
                with self._lock:
                    squares = find_palms(self._palms, image, turn)
                for square in squares[: hands + 1]:
                    if len(found) < hands and not any(square.is_near(hand.next_square) for hand in found):
                        add(self._look_twice(image, square))
        return found

    def sees_wider(self, image: npt.NDArray[np.uint8], hand: DetectedHand) -> bool:
        """Whether a hand that was found is one in a larger square too: (H, W, 3) red green blue, or (H, W) grey."""
        square = hand.next_square
        return self._look(_brighten(as_color(image)), replace(square, size=WIDER * square.size)) is not None

    def _add(self, found: list[DetectedHand], hand: DetectedHand | None, before: DetectedHand | None = None) -> None:
        if hand is None or any(hand.is_same(other) for other in found):
            return
        if before is not None:
            hand = replace(hand, right=SIDE_MEMORY * before.right + (1.0 - SIDE_MEMORY) * hand.right)
        found.append(hand)

    def _look_twice(self, image: npt.NDArray[np.uint8], square: Square) -> DetectedHand | None:
        """The hand in a square that a palm told, looked at again in the square that its own joints tell."""
        first = self._look(image, square)
        return None if first is None else self._look(image, first.next_square) or first

    def _look(self, image: npt.NDArray[np.uint8], square: Square) -> DetectedHand | None:
        """The hand in a square; None where there is none."""
        if not MIN_SIZE <= square.size <= MAX_SIZE * max(image.shape[:2]):
            return None
        crop = square.cut(image, PIXELS)
        with self._lock:  # OpenCV's networks hold one image at a time
            told = self._landmarks(crop)
        presence = float(told["presence"].reshape(-1)[0])
        if presence < MIN_PRESENCE:
            return None
        points = told["points"].reshape(21, 3).astype(np.float64)
        return DetectedHand(
            points=square.to_image(points[:, :2] - 0.5, PIXELS),
            points_3d=square.turn_back(told["points_3d"].reshape(21, 3).astype(np.float64)),
            presence=presence,
            right=float(told["side"].reshape(-1)[0]),
        )

    @cached_property
    def _palms(self) -> Run:
        return load_palm_network(self._threads)

    @cached_property
    def _landmarks(self) -> Run:
        return load_network("landmarks", ("points", "presence", "side", "points_3d"), self._threads)


@cache
def default_hand_detector(number: int = 0) -> HandDetector:
    """One of those of the whole process; a second one looks at another image at the same time."""
    return HandDetector()


def _brighten(image: npt.NDArray[np.uint8]) -> npt.NDArray[np.uint8]:
    """A dark image as bright as the photographs that the networks learnt from."""
    if not is_grey(image):
        return brighten(image)
    if image.mean() > DARK:
        return image
    return cv2.LUT(image, (255.0 * np.sqrt(np.arange(256) / 255.0)).astype(np.uint8)).astype(np.uint8)


def as_color(image: npt.NDArray[np.uint8]) -> npt.NDArray[np.uint8]:
    """(H, W, 3) of an image in colour or grey."""
    assert image.dtype == np.uint8 and image.ndim in (2, 3)
    return np.repeat(image[..., None], 3, axis=2) if image.ndim == 2 else image
