"""Calibrations written with OpenCV's names: YAML (OpenCV's and ROS's), JSON, npz; one camera, a stereo pair or several.

Only the values are read: no YAML tags, no pickles.
"""

from __future__ import annotations

import io
import re
import zipfile
from typing import Any

import numpy as np

from tracker.capture.document import parse_json
from tracker.capture.video_calibration import MAX_CALIBRATION_BYTES, VideoCamera, make_camera
from tracker.errors import CalibrationError, reading

_NAMES = {
    "K": ("k", "m", "mtx", "matrix", "cameramatrix", "intrinsic", "intrinsics", "intrinsicmatrix"),
    "distortion": (
        "d",
        "dist",
        "distcoeffs",
        "distortion",
        "distortions",
        "distortioncoefficients",
        "distcoefficients",
    ),
    "R": ("r", "rotation", "rvec", "rotationmatrix"),
    "t": ("t", "translation", "tvec", "translationvector"),
    "size": ("size", "imagesize", "resolution"),
}
_MEANING = {name: meaning for meaning, names in _NAMES.items() for name in names}


def parse_opencv(data: bytes, file: str) -> dict[str, Any]:
    """Named values of a calibration file of any of the three kinds; nested tables are dicts."""
    if file.lower().endswith(".npz"):
        return _parse_npz(data, file)
    if file.lower().endswith(".json"):
        value = parse_json(data, file, CalibrationError).value
        if isinstance(value, list):
            value = {"cameras": value}
        if not isinstance(value, dict):
            raise CalibrationError(f"{file}: needed an object with the values of a calibration.")
        return value
    return _parse_yaml(data.decode("utf-8", "replace"), file)


def find_cameras(values: dict[str, Any], file: str, name: str) -> list[VideoCamera]:
    """Cameras in the values of one file; a single unnumbered one is called `name`. Empty when there is none."""
    tables = _find_tables(values)
    if tables:
        return [_make_from_table(key, table, file) for key, table in list(tables.items())[:64]]
    numbered = _gather(values)
    if "K" in numbered.get("", {}):
        return [make_camera(name, file, numbered[""])]
    shared = numbered.pop("", {})
    own = {key: values for key, values in sorted(numbered.items()) if "K" in values}
    if len(own) == 2 and "R" in shared and "t" in shared:
        own = _place_stereo_pair(own, shared)
    size = {"size": shared.get("size")}
    return [make_camera(key, f"{file}: camera {key}", size | values) for key, values in own.items()]


def _find_tables(values: dict[str, Any]) -> dict[str, Any]:
    """Cameras that have a table each: those listed under `cameras`, else every table with a camera matrix."""
    listed = values.get("cameras")
    if isinstance(listed, list):
        return {str(i): table for i, table in enumerate(listed)}
    return listed if isinstance(listed, dict) else {k: v for k, v in values.items() if "K" in _gather_unnumbered(v)}


def _make_from_table(key: str, table: Any, file: str) -> VideoCamera:
    own = _gather_unnumbered(table)
    if "K" not in own:
        raise CalibrationError(f"{file}: camera {key} has no camera matrix.")
    label = next((table[k] for k in ("id", "name") if isinstance(table.get(k), str)), key)
    return make_camera(str(label)[:100], f"{file}: {key}", own)


def _place_stereo_pair(own: dict[str, dict[str, Any]], shared: dict[str, Any]) -> dict[str, dict[str, Any]]:
    """OpenCV's stereo pair: x2 = R x1 + T, and the world is the first camera; R1 and R2, which rectify, are left."""
    (first, second) = own
    inside = {key: {k: v for k, v in values.items() if k not in ("R", "t")} for key, values in own.items()}
    return {first: inside[first], second: inside[second] | {"R": shared["R"], "t": shared["t"]}}


def _gather_unnumbered(table: Any) -> dict[str, Any]:
    return _gather(table).get("", {}) if isinstance(table, dict) else {}


def _gather(values: dict[str, Any]) -> dict[str, dict[str, Any]]:
    """Values by camera suffix and meaning (`cameraMatrix1` is K of `1`); names that mean nothing are left out."""
    found: dict[str, dict[str, Any]] = {}
    for key, value in values.items():
        match = re.fullmatch(r"([A-Za-z]+)([0-9]{0,3})", str(key).replace("_", "").replace("-", ""))
        meaning = _MEANING.get(match[1].lower()) if match else None
        if match and meaning and value is not None:
            found.setdefault(match[2], {}).setdefault(meaning, value)
    width, height = values.get("image_width"), values.get("image_height")
    if width is not None and height is not None:
        found.setdefault("", {}).setdefault("size", [width, height])
    return found


def _parse_npz(data: bytes, file: str) -> dict[str, Any]:
    with reading(CalibrationError, file, "an npz of arrays"):
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            if sum(entry.file_size for entry in archive.infolist()) > MAX_CALIBRATION_BYTES:
                raise CalibrationError(f"{file}: unpacks to more than {MAX_CALIBRATION_BYTES} bytes.")
        with np.load(io.BytesIO(data), allow_pickle=False) as arrays:
            return {key: arrays[key] for key in list(arrays)[:1000]}


def _parse_yaml(text: str, file: str) -> dict[str, Any]:
    """The little YAML that OpenCV and ROS write: keys by indentation, numbers, texts, flat lists in brackets."""
    root: dict[str, Any] = {}
    stack: list[tuple[int, dict[str, Any]]] = [(-1, root)]
    lines = iter(enumerate(text.splitlines(), 1))
    for number, line in lines:
        body = _drop_comment(line).rstrip()
        if not body.strip() or body.startswith(("%", "---", "...")):
            continue
        key, colon, rest = body.strip().partition(":")
        if not colon:
            raise CalibrationError(f"{file}, line {number}: is {body.strip()[:60]!r}; needed 'name: value'.")
        rest = re.sub(r"^\s*!![A-Za-z0-9_-]+", "", rest).strip()
        if rest.startswith("["):
            parts, still_open = [rest], rest.count("[") - rest.count("]")
            while still_open > 0:
                step = next(lines, None)
                if step is None:
                    raise CalibrationError(f"{file}, line {number}: the list does not end.")
                parts.append(_drop_comment(step[1]).strip())
                still_open += parts[-1].count("[") - parts[-1].count("]")
            rest = " ".join(parts)
        indent = len(body) - len(body.lstrip())
        while stack[-1][0] >= indent:
            stack.pop()
        if len(stack) > 8:
            raise CalibrationError(f"{file}, line {number}: is nested too deeply.")
        parent = stack[-1][1]
        name = key.strip().strip("\"'")
        if rest == "":
            child: dict[str, Any] = {}
            parent[name] = child
            stack.append((indent, child))
        else:
            parent[name] = _parse_value(rest)
    return root


def _parse_value(text: str) -> Any:
    if text.startswith("["):
        rows = re.findall(r"\[([^\[\]]*)\]", text)
        values = [[_parse_value(cell.strip()) for cell in row.split(",") if cell.strip()] for row in rows]
        return values if text.count("[") > 1 else (values[0] if values else [])
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return text[1:-1] if len(text) > 1 and text[0] == text[-1] and text[0] in "\"'" else text.strip("\"'")


def _drop_comment(line: str) -> str:
    """A line without what follows `#`, unless that stands in quotes."""
    return re.sub(r"""("[^"]*"|'[^']*')|#.*""", lambda found: found[1] or "", line)
