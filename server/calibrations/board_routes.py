"""`/calibrations/form`, and boards as pages to print and as pictures."""

from __future__ import annotations

from typing import Annotated, Any

import cv2
from fastapi import APIRouter, Query, Response

from server.calibrations.schemas import BoardChoice, BoardOptions, BoardQuery, CalibrationForm, CalibrationOptions
from server.download import name_download
from server.errors import error_responses
from tracker.calibration import MAX_CAMERAS, draw_board, list_dictionaries, make_board_pdf

router = APIRouter(prefix="/calibrations", tags=["calibrations"], responses=error_responses())

PICTURE_PX = 640
"""Along the board's longer side."""

MARGIN = 0.04
"""White around the board in its picture, of the longer side."""

BOARDS = (
    BoardChoice(
        label="ChArUco",
        about="Recommended: it may be seen in part, and its corners are found to 0.1 px.",
        board=BoardOptions(),
    ),
    BoardChoice(
        label="AprilTag grid",
        about="It may be seen in part; its corners are found to 0.3 px.",
        board=BoardOptions(
            kind="apriltag", columns=4, rows=6, square_mm=42.0, marker_mm=32.0, dictionary="DICT_APRILTAG_36h11"
        ),
    ),
    BoardChoice(
        label="Checkerboard",
        about="It must be seen whole; one count is even and the other odd, or it looks the same upside down.",
        board=BoardOptions(kind="checkerboard", columns=6, rows=9, square_mm=28.0, marker_mm=0.0, dictionary=""),
    ),
)


def _answer(media_type: str) -> dict[int | str, dict[str, Any]]:
    return {200: {"content": {media_type: {"schema": {"type": "string", "format": "binary"}}}}}


@router.get("/form")
def get_calibration_form() -> CalibrationForm:
    """Kinds of boards with their usual measures, families of markers, and the default options of a calibration."""
    return CalibrationForm(
        boards=list(BOARDS),
        dictionaries=list_dictionaries(),
        most_cameras=MAX_CAMERAS,
        defaults=CalibrationOptions(),
    )


@router.get("/board.pdf", response_class=Response, responses=_answer("application/pdf"))
def get_board_pdf(options: Annotated[BoardQuery, Query()]) -> Response:
    """A board as a page of true size, to be printed at 100 %."""
    board = options.make_board()
    size = f"{options.columns}x{options.rows}-{options.square_mm:g}mm"
    headers = name_download(f"board-{options.kind}-{size}", suffix=".pdf")
    return Response(make_board_pdf(board), media_type="application/pdf", headers=headers)


@router.get("/board.png", response_class=Response, responses=_answer("image/png"))
def get_board_picture(options: Annotated[BoardQuery, Query()]) -> Response:
    """A picture of a board, straight from the front."""
    board = options.make_board()
    per_m = PICTURE_PX / max(board.size_m)
    image = draw_board(board, per_m, margin_px=round(MARGIN * PICTURE_PX))
    data = cv2.imencode(".png", image)[1].tobytes()
    return Response(data, media_type="image/png", headers={"Cache-Control": "private, max-age=86400"})
