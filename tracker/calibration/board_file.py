"""A board's description: a small TOML file, ours or caliscope's `charuco.toml`, or one word of the command line."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path
from typing import Any

from tracker.calibration.board import APRILTAG, Board
from tracker.capture.document import read_regular_file
from tracker.capture.scan_size import UNITS
from tracker.errors import CalibrationError, reading

MAX_BOARD_BYTES = 64 * 1024
"""Ours has 200 bytes."""

DICTIONARY = "DICT_5X5_100"
"""Of a ChArUco board whose description names none: OpenCV's samples draw with it, and 5x5 bits are seldom mistaken."""

WORD = "KIND:COLUMNSxROWS:SQUARE_MM[:MARKER_MM[:DICTIONARY]]"
_WORD = re.compile(r"([a-z]+):([0-9]{1,3})x([0-9]{1,3}):([0-9.]{1,12})(?::([0-9.]{1,12}))?(?::(?:DICT_)?(\w{1,30}))?")


def read_board(text: str) -> Board:
    """The board that a word such as `charuco:5x7:30:22.5:5X5_100` describes, or a file.

    Raises:
        CalibrationError: It is neither, or describes an impossible board.
    """
    match = _WORD.fullmatch(text)
    if match is None:
        if not Path(text).exists() and ":" in text:
            raise CalibrationError(f"--board {text[:80]!r}: is neither a file nor {WORD}, such as charuco:5x7:30:22.5.")
        return load_board(Path(text))
    with reading(CalibrationError, f"--board {text}", WORD):
        kind, columns, rows, square, marker, family = match.groups()
        values = {"kind": kind, "columns": int(columns), "rows": int(rows), "square_mm": float(square)}
        values |= {"marker_mm": float(marker)} if marker else {}
        values |= {"dictionary": f"DICT_{family}"} if family else {}
    return _make_board(values, f"--board {text}")


def load_board(path: Path) -> Board:
    """The board of a TOML file.

    Ours: `kind`, `columns`, `rows`, `square_mm`, and as they apply `marker_mm`, `dictionary`, `inverted`, `legacy`.
    Caliscope's: `columns`, `rows`, `board_width`, `board_height`, `units`, `dictionary`, `aruco_scale`,
    `square_size_override_cm`, `inverted`, `legacy_pattern`.

    Raises:
        CalibrationError: The file is missing, too large, no TOML, or describes an impossible board.
    """
    data = read_regular_file(path, MAX_BOARD_BYTES, CalibrationError)
    with reading(CalibrationError, path, "a board's description in TOML"):
        values = tomllib.loads(data.decode("utf-8-sig"))
    if "aruco_scale" in values:
        values = _from_caliscope(values, str(path))
    return _make_board(values, str(path))


def write_board(board: Board) -> bytes:
    """The file that `load_board` reads."""
    lines = [
        f'kind = "{board.kind}"',
        f"columns = {board.columns}",
        f"rows = {board.rows}",
        f"square_mm = {1000 * board.square_m:.6g}",
    ]
    if board.kind != "checkerboard":
        lines += [f"marker_mm = {1000 * board.marker_m:.6g}", f'dictionary = "{board.dictionary}"']
    lines += ["inverted = true"] if board.is_inverted else []
    lines += ["legacy = true"] if board.is_legacy else []
    return ("\n".join(lines) + "\n").encode()


def _from_caliscope(values: dict[str, Any], file: str) -> dict[str, Any]:
    columns, rows = _whole(values, "columns", file), _whole(values, "rows", file)
    override = values.get("square_size_override_cm")
    if override is not None:
        square_mm = 10.0 * _number(values, "square_size_override_cm", file)
    else:
        unit = UNITS.get(str(values.get("units", "cm")))
        if unit is None:
            raise CalibrationError(f"{file}: units is {str(values['units'])[:40]!r}; needed {', '.join(UNITS)}.")
        width, height = _number(values, "board_width", file), _number(values, "board_height", file)
        square_mm = 1000.0 * unit * min(width / max(columns, 1), height / max(rows, 1))
    return {
        "kind": "charuco",
        "columns": columns,
        "rows": rows,
        "square_mm": square_mm,
        "marker_mm": square_mm * _number(values, "aruco_scale", file),
        "dictionary": values.get("dictionary", DICTIONARY),
        "inverted": values.get("inverted", False),
        "legacy": values.get("legacy_pattern", False),
    }


def _make_board(values: dict[str, Any], file: str) -> Board:
    kind = values.get("kind", "charuco")
    if kind not in ("charuco", "apriltag", "checkerboard"):
        raise CalibrationError(f"{file}: kind is {str(kind)[:40]!r}; needed charuco, apriltag or checkerboard.")
    square_m = _number(values, "square_mm", file) / 1000.0
    has_markers = kind != "checkerboard"
    usual = APRILTAG if kind == "apriltag" else DICTIONARY
    if "marker_mm" in values and has_markers:
        marker_m = _number(values, "marker_mm", file) / 1000.0
    else:
        marker_m = 0.75 * square_m if has_markers else 0.0
    flags = {name: values.get(name, False) for name in ("inverted", "legacy")}
    if any(not isinstance(flag, bool) for flag in flags.values()):
        raise CalibrationError(f"{file}: inverted and legacy are true or false.")
    with reading(CalibrationError, file, "a board's description"):
        try:
            return Board(
                kind=str(kind),
                columns=_whole(values, "columns", file),
                rows=_whole(values, "rows", file),
                square_m=square_m,
                marker_m=marker_m,
                dictionary=str(values.get("dictionary", usual)) if has_markers else "",
                is_inverted=flags["inverted"],
                is_legacy=flags["legacy"],
            )
        except CalibrationError as fault:
            raise fault if file in str(fault) else CalibrationError(f"{file}: {fault}") from None


def _number(values: dict[str, Any], name: str, file: str) -> float:
    value = values.get(name)
    if isinstance(value, bool) or not isinstance(value, int | float) or not 0.0 < value < 1e6:
        raise CalibrationError(f"{file}: {name} is {repr(value)[:40]}; needed a number above 0.")
    return float(value)


def _whole(values: dict[str, Any], name: str, file: str) -> int:
    value = values.get(name)
    if isinstance(value, bool) or not isinstance(value, int):
        raise CalibrationError(f"{file}: {name} is {repr(value)[:40]}; needed a whole number.")
    return value
