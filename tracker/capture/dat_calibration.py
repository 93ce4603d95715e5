"""Calibrations as plain text: `c0.dat` with `intrinsic:` and `distortion:`, `rot_trans_c0.dat` with `R:` and `T:`."""

from __future__ import annotations

from tracker.capture.video_calibration import VideoCamera, make_camera
from tracker.errors import CalibrationError, reading

_SECTIONS = {"intrinsic": "K", "distortion": "distortion", "r": "R", "t": "t"}


def parse_dat(intrinsics: bytes, extrinsics: bytes | None, name: str, file: str) -> VideoCamera:
    """One camera from its file of intrinsics and its file of extrinsics, if it has one."""
    with reading(CalibrationError, file, "sections of numbers such as 'intrinsic:'"):
        values = _parse_sections(intrinsics, file)
        if extrinsics is not None:
            values |= {k: v for k, v in _parse_sections(extrinsics, f"rot_trans_{file}").items() if k in ("R", "t")}
    if "K" not in values:
        raise CalibrationError(f"{file}: has no section 'intrinsic:'.")
    if extrinsics is not None and not {"R", "t"} <= values.keys():
        raise CalibrationError(f"rot_trans_{file}: needed the sections 'R:' and 'T:'.")
    return make_camera(name, file, values)


def _parse_sections(data: bytes, file: str) -> dict[str, list]:
    """Rows of numbers of each section; the first of each name counts, a line that begins with # ends the file."""
    sections: dict[str, list] = {}
    current: list | None = None
    for number, line in enumerate(data.decode("utf-8", "replace").splitlines(), 1):
        text = line.strip()
        if text.startswith("#"):
            break
        if text.endswith(":"):
            name = _SECTIONS.get(text[:-1].strip().lower())
            if name is None or name in sections:
                raise CalibrationError(f"{file}, line {number}: section {text[:40]!r} is unknown or there twice.")
            current = sections[name] = []
        elif text:
            row = _parse_row(text)
            if current is None or not row:
                raise CalibrationError(
                    f"{file}, line {number}: is {text[:60]!r}; needed numbers in a section like 'R:'."
                )
            current.append(row)
    widths = [{len(row) for row in rows} for rows in sections.values()]
    if any(len(of_section) != 1 for of_section in widths):
        different = sorted(set().union(*widths))
        raise CalibrationError(f"{file}: rows of one section have different lengths ({different}).")
    return sections


def _parse_row(text: str) -> list[float]:
    """Numbers of a line; none where one of its words is no number."""
    try:
        return [float(part) for part in text.split()]
    except ValueError:
        return []
