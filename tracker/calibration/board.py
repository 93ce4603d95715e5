"""A flat board whose corners are known to a fraction of a millimetre: ChArUco, a grid of AprilTags, a checkerboard."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import cv2
import numpy as np
import numpy.typing as npt

from tracker.errors import CalibrationError

Array = npt.NDArray[np.float64]

BOARD_KINDS = ("charuco", "apriltag", "checkerboard")
MAX_SQUARES = 40
"""Along a side: what a camera of 64 million pixels can still tell apart from across a room."""

APRILTAG = "DICT_APRILTAG_36h11"
MIN_SQUARE_M, MAX_SQUARE_M = 0.001, 1.0
"""Sides of squares that a board may have, m: from what a printer still draws to what a wall holds."""


@dataclass(frozen=True)
class Board:
    """A board; its frame is that of OpenCV: origin at the top left, x right, y down along the board, z into it, m.

    Attributes:
        kind: One of `BOARD_KINDS`.
        columns: Squares across (`apriltag`: tags), the outer ones too.
        rows: Squares down.
        square_m: From one square to the next, m (`apriltag`: from one tag to the next, with the gap).
        marker_m: The side of a marker or tag with its black border, m; 0 for a checkerboard.
        dictionary: OpenCV's name of the markers' family, such as `DICT_5X5_100`; empty for a checkerboard.
        is_inverted: Black and white are exchanged.
        is_legacy: A ChArUco board as OpenCV drew it before 4.6: with an even number of rows it begins in white.
    """

    kind: str
    columns: int
    rows: int
    square_m: float
    marker_m: float = 0.0
    dictionary: str = ""
    is_inverted: bool = False
    is_legacy: bool = False

    def __post_init__(self) -> None:
        fault = self._find_fault()
        if fault:
            raise CalibrationError(f"Board {self.columns}x{self.rows}: {fault}.")

    def _find_fault(self) -> str:
        if self.kind not in BOARD_KINDS:
            return f"is of the kind {self.kind[:40]!r}; needed {', '.join(BOARD_KINDS)}"
        least = 1 if self.kind == "apriltag" else 3
        if not (least <= self.columns <= MAX_SQUARES and least <= self.rows <= MAX_SQUARES):
            return f"needed {least} to {MAX_SQUARES} squares along each side"
        if not MIN_SQUARE_M <= self.square_m <= MAX_SQUARE_M:
            return f"a square measures {1000 * self.square_m:g} mm; needed {1000 * MIN_SQUARE_M:g} to 1000 mm"
        if self.kind == "checkerboard":
            if (self.columns + self.rows) % 2 == 0:
                return (
                    "turned by 180 degrees it looks the same, so two cameras cannot agree which corner is which; take "
                    "one "
                    "whose columns are even and rows odd, or the reverse, or a ChArUco"
                )
            return ""
        if not 0.2 * self.square_m <= self.marker_m < self.square_m:
            return (
                f"a marker measures {1000 * self.marker_m:g} mm; needed less than the {1000 * self.square_m:g} mm "
                "of a square, and at least a fifth of it"
            )
        if self.dictionary not in list_dictionaries():
            return f"the markers' family is {self.dictionary[:40]!r}; needed one of OpenCV's, such as DICT_5X5_100"
        have, need = len(_load_family(self.dictionary).bytesList), self.marker_count
        if need > have:
            return f"it has {need} markers, {self.dictionary} only {have}; take a larger family or fewer squares"
        return ""

    @property
    def marker_count(self) -> int:
        """How many different markers are on it."""
        squares = self.columns * self.rows
        return squares if self.kind == "apriltag" else squares // 2 if self.kind == "charuco" else 0

    @cached_property
    def markers(self) -> cv2.aruco.Dictionary:
        """Those of the family that are on the board: fewer are distinguished faster and more surely."""
        family = _load_family(self.dictionary)
        own = family.bytesList[: self.marker_count]
        return cv2.aruco.Dictionary(own, family.markerSize, family.maxCorrectionBits)

    @cached_property
    def layout(self) -> cv2.aruco.CharucoBoard | cv2.aruco.GridBoard:
        """OpenCV's own board: where each marker is. A checkerboard has none."""
        size = (self.columns, self.rows)
        if self.kind == "apriltag":
            return cv2.aruco.GridBoard(size, self.marker_m, self.square_m - self.marker_m, self.markers)
        assert self.kind == "charuco"
        board = cv2.aruco.CharucoBoard(size, self.square_m, self.marker_m, self.markers)
        board.setLegacyPattern(self.is_legacy)
        return board

    @cached_property
    def corners(self) -> Array:
        """(N, 3) board, m: inner corners row by row; of an AprilTag grid the four of each tag, clockwise."""
        if self.kind == "apriltag":
            return np.concatenate([np.asarray(tag, dtype=np.float64) for tag in self.layout.getObjPoints()])
        across, down = np.meshgrid(np.arange(1, self.columns), np.arange(1, self.rows))
        flat = np.stack([across.ravel(), down.ravel(), np.zeros(across.size)], axis=1)
        return np.asarray(flat * self.square_m, dtype=np.float64)

    @property
    def size_m(self) -> tuple[float, float]:
        """Width and height of what is printed, m."""
        gap = self.square_m - self.marker_m if self.kind == "apriltag" else 0.0
        return self.columns * self.square_m - gap, self.rows * self.square_m - gap

    def describe(self) -> str:
        """One line for people: `ChArUco 4x5, squares of 54 mm, markers of 40.5 mm (DICT_4X4_1000), inverted`."""
        name = {"charuco": "ChArUco", "apriltag": "AprilTag grid", "checkerboard": "checkerboard"}[self.kind]
        words = [f"{name} {self.columns}x{self.rows}"]
        if self.kind == "apriltag":
            words.append(f"tags of {1000 * self.marker_m:g} mm every {1000 * self.square_m:g} mm ({self.dictionary})")
        else:
            words.append(f"squares of {1000 * self.square_m:g} mm")
        if self.kind == "charuco":
            words.append(f"markers of {1000 * self.marker_m:g} mm ({self.dictionary})")
        words += ["inverted"] if self.is_inverted else []
        words += ["legacy pattern"] if self.is_legacy else []
        return ", ".join(words)


def list_dictionaries() -> list[str]:
    """OpenCV's families of markers by their names, such as `DICT_5X5_100`."""
    return [name for name in dir(cv2.aruco) if name.startswith("DICT_")]


def _load_family(name: str) -> cv2.aruco.Dictionary:
    return cv2.aruco.getPredefinedDictionary(getattr(cv2.aruco, name))
