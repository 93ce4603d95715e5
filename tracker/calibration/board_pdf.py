"""A board as a PDF page at its true size, in vectors.

The page is as ISO 32000-1 describes it: one content stream of filled rectangles, and a line of text in Helvetica.
"""

from __future__ import annotations

from tracker.calibration.board import Board
from tracker.calibration.board_pattern import find_dark_rectangles

POINTS_PER_M = 72.0 / 0.0254
"""PDF: 72 points an inch."""
MARGIN_M = 0.015
"""White around the board, which the detectors need, and what most printers leave blank."""

RULER_M = 0.1
"""A line of this length stands below the board, to be measured after printing."""


def make_board_pdf(board: Board) -> bytes:
    """The page: the board with a margin, a line to measure and what to do. The page is as large as that needs."""
    width, height = board.size_m
    text_m = 0.02
    page_width = max(width, RULER_M) + 2 * MARGIN_M
    page_height = height + 2 * MARGIN_M + text_m
    top = page_height - MARGIN_M
    ground, ink = ("0 g", "1 g") if board.is_inverted else ("1 g", "0 g")
    marks = [ground, _rectangle(MARGIN_M, top - height, width, height), "f", ink]
    marks += [_rectangle(MARGIN_M + x, top - y - h, w, h) for x, y, w, h in find_dark_rectangles(board).tolist()]
    marks += ["f", "0 g", _rectangle(MARGIN_M, MARGIN_M, min(RULER_M, page_width - 2 * MARGIN_M), 0.0005), "f"]
    words = (
        f"{board.describe()}. Print at 100 % (no fit to page); the line below is {1000 * RULER_M:g} mm long: measure "
        "it. "
        "Glue the sheet to something flat."
    )
    size = min(9.0, (page_width - 2 * MARGIN_M) * POINTS_PER_M / (0.5 * len(words)))
    at = f"{MARGIN_M * POINTS_PER_M:.3f} {(MARGIN_M + 0.005) * POINTS_PER_M:.3f}"
    marks.append(
        f"BT /F1 {size:.2f} Tf {at} Td ({words.replace('(', chr(92) + '(').replace(')', chr(92) + ')')}) Tj ET"
    )
    return _make_page("\n".join(marks).encode("latin-1", "replace"), page_width, page_height)


def _rectangle(x: float, y: float, width: float, height: float) -> str:
    return " ".join(f"{value * POINTS_PER_M:.4f}" for value in (x, y, width, height)) + " re"


def _make_page(content: bytes, width_m: float, height_m: float) -> bytes:
    box = f"0 0 {width_m * POINTS_PER_M:.4f} {height_m * POINTS_PER_M:.4f}"
    objects = [
        b"<< /Type /Catalog /Pages 2 0 R >>",
        b"<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
        f"<< /Type /Page /Parent 2 0 R /MediaBox [{box}] /Contents 4 0 R "
        "/Resources << /Font << /F1 5 0 R >> >> >>".encode(),
        b"<< /Length %d >>\nstream\n%s\nendstream" % (len(content), content),
        b"<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica /Encoding /WinAnsiEncoding >>",
    ]
    data, places = b"%PDF-1.4\n", []
    for number, body in enumerate(objects, 1):
        places.append(len(data))
        data += b"%d 0 obj\n%s\nendobj\n" % (number, body)
    table = b"".join(b"%010d 00000 n \n" % place for place in places)
    size = len(objects) + 1
    end = b"xref\n0 %d\n0000000000 65535 f \n%strailer\n<< /Size %d /Root 1 0 R >>\nstartxref\n%d\n%%%%EOF\n"
    return data + end % (size, table, size, len(data))
