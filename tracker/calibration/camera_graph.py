"""Where all cameras are, from pairs that share boards: along the pairs that agree best, from the first camera."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

import numpy as np
import numpy.typing as npt

from tracker.calibration.board import Board
from tracker.calibration.board_pose import find_board_poses
from tracker.calibration.camera_pair import CameraPair, SeenBoards, relate_cameras
from tracker.calibration.lens import Lens
from tracker.calibration.sightings import Report, Sightings
from tracker.errors import CalibrationError
from tracker.geometry.se3 import inverse

Array = npt.NDArray[np.float64]

DISAGREES = 0.03
"""Of a picture's longer side: cameras whose boards stay farther apart at every offset have no place for each other."""


def relate_all(board: Board, seen: Sequence[SeenBoards], max_offset_s: float, report: Report) -> list[CameraPair]:
    """Every pair of cameras that shares boards and agrees about them."""
    numbers = list(combinations(range(len(seen)), 2))
    pairs = []
    for done, (first, second) in enumerate(numbers):
        pair = relate_cameras((first, second), board, seen[first], seen[second], max_offset_s)
        if pair is not None:
            pairs.append(pair)
        report("relating the cameras", (done + 1) / len(numbers))
    return pairs


def place_cameras(
    board: Board, seen: Sequence[SeenBoards], pairs: Sequence[CameraPair]
) -> tuple[Array, Array, npt.NDArray[np.bool_]]:
    """Places and time offsets of the cameras.

    Returns:
        T_world_camera (C, 4, 4), m, the world being the first camera; offsets (C,), s, to be added to the first
            camera's time; whether each offset is known (C,).

    Raises:
        CalibrationError: Some cameras share no board with the first, not even by way of others; names them.
    """
    longest = [max(boards.sightings.width, boards.sightings.height) for boards in seen]
    agreeing = [pair for pair in pairs if pair.error_px < DISAGREES * longest[pair.first]]
    places = np.tile(np.eye(4), (len(seen), 1, 1))
    offsets, is_known = np.zeros(len(seen)), np.ones(len(seen), dtype=bool)
    reached = {0}
    while len(reached) < len(seen):
        edges = [pair for pair in agreeing if (pair.first in reached) != (pair.second in reached)]
        if not edges:
            raise CalibrationError(_say_unreached(board, seen, pairs, reached))
        pair = max(edges, key=lambda edge: (edge.is_telling, edge.shared / (0.5 + edge.error_px)))
        if pair.first in reached:
            old, new, T, offset = pair.first, pair.second, pair.T_first_second, pair.offset_s
        else:
            old, new, T, offset = pair.second, pair.first, inverse(pair.T_first_second), -pair.offset_s
        places[new] = places[old] @ T
        offsets[new] = offsets[old] + offset
        is_known[new] = is_known[old] and pair.is_telling
        reached.add(new)
    return places, offsets, is_known


def _say_unreached(board: Board, seen: Sequence[SeenBoards], pairs: Sequence[CameraPair], reached: set[int]) -> str:
    names = [boards.sightings.camera for boards in seen]
    missing = [number for number in range(len(seen)) if number not in reached]
    disputed = [pair for pair in pairs if (pair.first in reached) != (pair.second in reached)]
    those, there = (
        ", ".join(names[number] for number in missing),
        ", ".join(names[number] for number in sorted(reached)),
    )
    if not disputed:
        return (
            f"{those}: no board was seen at the same moment by {'it' if len(missing) == 1 else 'one of them'} and by "
            f"{there}. "
            "Hold the board where both groups see it, at least three times, or leave cameras out."
        )
    pair = min(disputed, key=lambda edge: edge.error_px)
    blamed = pair.second if pair.first in reached else pair.first
    if board.kind == "checkerboard":
        for camera in {blamed, *([0] if len(reached) == 1 else [])}:
            other = pair.first if camera == pair.second else pair.second
            if _agrees_mirrored(board, seen[camera], seen[other]):
                return (
                    f"{names[camera]}: is mirrored: its boards move as {names[other]}'s only when its picture is "
                    "flipped. "
                    "Switch its mirroring off, or flip the video."
                )
    return (
        f"{names[blamed]}: disagrees with {names[pair.first if blamed == pair.second else pair.second]} about where "
        f"{pair.shared} boards are, by {pair.error_px:.0f} px at best. Are the videos more out of step than was "
        "searched "
        "(--max-offset), was a camera moved, or are there two boards in the room?"
    )


def _agrees_mirrored(board: Board, mirrored: SeenBoards, other: SeenBoards) -> bool:
    """Whether flipping a checkerboard's camera makes the two agree."""
    flipped = flip(board, mirrored)
    reach = 0.5 * min(float(np.ptp(boards.sightings.times)) for boards in (mirrored, other))
    pair = relate_cameras((0, 1), board, other, flipped, min(reach, 5.0))
    return pair is not None and pair.error_px < DISAGREES * max(other.sightings.width, other.sightings.height)


def flip(board: Board, boards: SeenBoards) -> SeenBoards:
    """A checkerboard's sightings as the camera would have had them, had it not been mirrored."""
    seen, lens = boards.sightings, boards.lens
    grid = seen.corners.reshape(len(seen.frames), board.rows - 1, board.columns - 1, 2)
    # The first square is dark: mirrored, columns or rows run backwards, whichever keeps it so.
    grid = grid[:, :, ::-1] if board.columns % 2 == 1 else grid[:, ::-1]
    corners = grid.reshape(seen.corners.shape) * [-1.0, 1.0] + [seen.width - 1.0, 0.0]
    K = lens.K.copy()
    K[0, 2] = seen.width - 1.0 - K[0, 2]
    distortion = lens.distortion.copy()
    if len(distortion) > 3:
        distortion[3] = -distortion[3]
    own = Sightings(seen.camera, seen.width, seen.height, seen.fps, seen.times, seen.frames, corners)
    right = Lens(K, distortion)
    return SeenBoards(own, right, find_board_poses(board, right, corners))
