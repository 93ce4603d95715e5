"""The files of a finished calibration: written beside, moved in whole, never changed."""

from __future__ import annotations

import io
import json
import shutil
import uuid
import zipfile
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from server.storage import Storage

if TYPE_CHECKING:
    from tracker.calibration import CameraCalibration

AREA = "calibrations"
COVERAGE = "coverage-{}.png"
EARLIEST = (1980, 1, 1, 0, 0, 0)
"""Time of the files in an archive, so that the same cameras make the same bytes."""


def store_result(storage: Storage, calibration_id: uuid.UUID, result: CameraCalibration) -> dict[str, Any]:
    """Write the files of a result; gives what the row tells of it. Done twice it writes the same."""
    files = _encode(result)
    folder = storage.folder(AREA, calibration_id)
    beside = folder.with_name(f".unfinished-{uuid.uuid4().hex}")
    beside.mkdir()
    try:
        for name, data in files.items():
            (beside / name).write_bytes(data)
        storage.remove(AREA, calibration_id)  # of a worker that died before it said so
        beside.rename(folder)
    finally:
        shutil.rmtree(beside, ignore_errors=True)
    storage.publish(AREA, calibration_id)
    told = json.loads(files["report.json"])
    del told["boards"]
    return {**told, "files": [name for name in files if not name.startswith("coverage-")]}


def _encode(result: CameraCalibration) -> dict[str, bytes]:
    """Contents by file name; a format that cannot hold one of the cameras is left out."""
    from tracker import TrackerError
    from tracker.calibration import encode_cameras, encode_coverage, encode_report

    files = {
        "cameras.toml": encode_cameras(result, "anipose")[""],
        "cameras.yaml": encode_cameras(result, "opencv")[""],
    }
    with suppress(TrackerError):  # known lenses may have more coefficients than COLMAP's models
        files["colmap.zip"] = _pack(encode_cameras(result, "colmap"))
    files |= encode_report(result)
    return files | {COVERAGE.format(number): encode_coverage(result, number) for number in range(len(result.cameras))}


def _pack(files: dict[str, bytes]) -> bytes:
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in files.items():
            archive.writestr(zipfile.ZipInfo(name, EARLIEST), data, zipfile.ZIP_DEFLATED)
    return out.getvalue()
