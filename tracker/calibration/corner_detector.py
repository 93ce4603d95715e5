"""The corners of a board in one picture, each with its number."""

from __future__ import annotations

import cv2
import numpy as np
import numpy.typing as npt

from tracker.calibration.board import Board

Array = npt.NDArray[np.float64]
Grey = npt.NDArray[np.uint8]

MIN_CORNERS = 6
"""A plane's homography needs four; with fewer than two more nothing says that one of them is wrong."""

BENT = 0.05
"""A corner farther from the board's homography than this share of the board's own extent in the picture has the number
of another one; no lens in use bends a board so much."""


class CornerDetector:
    """Finds a board.

    Args:
        board: The board.
    """

    def __init__(self, board: Board) -> None:
        self.board = board
        parameters = cv2.aruco.DetectorParameters()
        if board.kind == "apriltag":
            self._tags = cv2.aruco.ArucoDetector(board.markers, parameters)
        elif board.kind == "charuco":
            assert isinstance(board.layout, cv2.aruco.CharucoBoard)
            self._charuco = cv2.aruco.CharucoDetector(
                board.layout, cv2.aruco.CharucoParameters(), parameters, cv2.aruco.RefineParameters()
            )

    def find(self, image: Grey) -> Array:
        """(N, 2) px, the board's corners in an image (H, W), grey; NaN where one is not seen."""
        assert image.ndim == 2
        image = cv2.bitwise_not(image) if self.board.is_inverted else image  # pyright: ignore[reportAssignmentType]
        finders = {"charuco": self._find_charuco, "apriltag": self._find_tags, "checkerboard": self._find_checkerboard}
        return drop_misnumbered(self.board, finders[self.board.kind](image))

    def _find_charuco(self, image: Grey) -> Array:
        found = np.full((len(self.board.corners), 2), np.nan)
        corners, ids, _, _ = self._charuco.detectBoard(image)
        if ids is not None and len(ids):
            found[np.asarray(ids, dtype=np.int64).ravel()] = np.asarray(corners, dtype=np.float64).reshape(-1, 2)
        return found

    def _find_tags(self, image: Grey) -> Array:
        found = np.full((len(self.board.corners) // 4, 4, 2), np.nan)
        corners, ids, _ = self._tags.detectMarkers(image)
        for tag, number in zip(
            corners, np.asarray(ids, dtype=np.int64).ravel() if ids is not None else (), strict=False
        ):
            if number < len(found):
                found[number] = self._refine(image, np.asarray(tag, dtype=np.float32).reshape(4, 2))
        return found.reshape(-1, 2)

    def _refine(self, image: Grey, tag: npt.NDArray[np.float32]) -> Array:
        """A tag's corners (4, 2) px, looked for in a window that holds its border and nothing of what is inside it.

        Differs from OpenCV, whose own window is a third of that and leaves them half a pixel off.
        """
        side = float(np.linalg.norm(np.diff(tag, axis=0, append=tag[:1]), axis=1).mean())
        reach = int(np.clip(round(0.75 * side / (self.board.markers.markerSize + 2)), 2, 8))
        stop = (cv2.TERM_CRITERIA_COUNT + cv2.TERM_CRITERIA_EPS, 50, 0.01)
        corners = cv2.cornerSubPix(image, np.ascontiguousarray(tag), (reach, reach), (-1, -1), stop)
        moved = np.asarray(corners, dtype=np.float64).reshape(4, 2)
        return moved if np.abs(moved - tag).max() < reach else tag.astype(np.float64)

    def _find_checkerboard(self, image: Grey) -> Array:
        size = (self.board.columns - 1, self.board.rows - 1)
        found = np.full((size[0] * size[1], 2), np.nan)
        small = cv2.resize(image, None, fx=0.5, fy=0.5) if min(image.shape) > 700 else image
        if not cv2.checkChessboard(small, size):
            return found
        is_there, corners = cv2.findChessboardCornersSB(image, size, flags=cv2.CALIB_CB_NORMALIZE_IMAGE)
        if not is_there:
            return found
        return orient_checkerboard(self.board, image, np.asarray(corners, dtype=np.float64).reshape(-1, 2))


def orient_checkerboard(board: Board, image: Grey, corners: Array) -> Array:
    """(N, 2) px: corners of a whole checkerboard numbered as on the board, whichever way OpenCV went through them.

    A board is not seen from behind, so rows turn right from columns; and its first square is dark.
    """
    grid = corners.reshape(board.rows - 1, board.columns - 1, 2)
    across, down = grid[0, -1] - grid[0, 0], grid[-1, 0] - grid[0, 0]
    if across[0] * down[1] - across[1] * down[0] < 0:
        grid = grid[:, ::-1]
    same, other = [], []
    for row in range(board.rows - 2):
        for column in range(board.columns - 2):
            x, y = np.clip(np.rint(grid[row : row + 2, column : column + 2].mean(axis=(0, 1))), 0, None).astype(int)
            shade = int(image[min(y, image.shape[0] - 1), min(x, image.shape[1] - 1)])
            (same if (row + column) % 2 == 0 else other).append(shade)
    if np.mean(same) > np.mean(other):
        grid = grid[::-1, ::-1]
    return grid.reshape(-1, 2)


def drop_misnumbered(board: Board, corners: Array) -> Array:
    """(N, 2) px with NaN for corners that lie far from where the others put them; all NaN when too few are left."""
    is_seen = np.isfinite(corners[:, 0])
    nothing = np.full_like(corners, np.nan)
    if is_seen.sum() < MIN_CORNERS or not _spans_plane(board.corners[is_seen]):
        return nothing
    pixels = corners[is_seen]
    far = BENT * float(np.linalg.norm(np.ptp(pixels, axis=0)))
    H, is_good = cv2.findHomography(board.corners[is_seen, :2], pixels, cv2.RANSAC, max(far, 2.0))
    if H is None or is_good.sum() < MIN_CORNERS or is_good.sum() < 0.6 * len(pixels):
        return nothing
    kept = nothing.copy()
    places = np.flatnonzero(is_seen)[is_good.ravel() > 0]
    kept[places] = corners[places]
    return kept if _spans_plane(board.corners[places]) else nothing


def _spans_plane(points: Array) -> bool:
    """Points (M, 3) that do not lie on a line."""
    spread = np.linalg.svd(points[:, :2] - points[:, :2].mean(axis=0), compute_uv=False)
    return bool(spread[1] > 0.1 * spread[0])
