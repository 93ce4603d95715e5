"""The files of a calibration: the cameras in the format asked for, and a folder that says how good they are."""

from __future__ import annotations

import json
from pathlib import Path

from tracker.calibration.anipose_file import write_anipose
from tracker.calibration.board_file import write_board
from tracker.calibration.calibration_report import describe_calibration, say_calibration
from tracker.calibration.camera_calibration import CameraCalibration
from tracker.calibration.colmap_file import write_colmap
from tracker.calibration.coverage import encode_coverage
from tracker.calibration.opencv_file import write_opencv
from tracker.capture.atomic_file import write_atomically
from tracker.errors import CalibrationError

CALIBRATION_FORMATS = {"anipose": (".toml",), "opencv": (".yaml", ".yml"), "colmap": ("",)}
"""By the end of the file's name; COLMAP's is a folder."""


def choose_format(out: Path) -> str:
    """The format that a file's name asks for.

    Raises:
        CalibrationError: It asks for none, or is a folder where a file is needed, or the reverse.
    """
    chosen = next((name for name, ends in CALIBRATION_FORMATS.items() if out.suffix.lower() in ends), None)
    if chosen is None:
        raise CalibrationError(
            f"--out {out}: needed a name that ends in .toml (Anipose) or .yaml (OpenCV), or a folder without a dot in "
            "its name "
            "(COLMAP's text)."
        )
    if out.exists() and out.is_dir() != (chosen == "colmap"):
        raise CalibrationError(f"--out {out}: is a {'folder' if out.is_dir() else 'file'}; give another name.")
    return chosen


def encode_cameras(result: CameraCalibration, chosen: str) -> dict[str, bytes]:
    """The cameras in one of `CALIBRATION_FORMATS`, by file name; the name is empty where the format is one file.

    Raises:
        CalibrationError: The format cannot hold a camera.
    """
    if chosen == "anipose":
        offsets = [offset.seconds for offset in result.offsets]
        return {"": write_anipose(result.cameras, offsets, result.left_out.rms)}
    return {"": write_opencv(result.cameras)} if chosen == "opencv" else write_colmap(result.cameras)


def encode_report(result: CameraCalibration) -> dict[str, bytes]:
    """What says how good a calibration is, by file name; the pictures of the coverage not."""
    return {
        "report.json": json.dumps(describe_calibration(result), indent=1, allow_nan=False).encode(),
        "report.txt": (say_calibration(result) + "\n").encode(),
        "board.toml": write_board(result.board),
    }


def write_calibration(result: CameraCalibration, out: Path) -> dict[str, str]:
    """Write the cameras, and beside them a folder `<name>_report`.

    Each file is whole or not there, and the cameras come last.

    Returns:
        Where the cameras and the report are: `out`, `report`.

    Raises:
        CalibrationError: As `choose_format`, or the format cannot hold a camera.
    """
    cameras = {out / name if name else out: data for name, data in encode_cameras(result, choose_format(out)).items()}
    folder = out.with_name(f"{out.stem}_report")
    files = {folder / name: data for name, data in encode_report(result).items()}
    for number in range(len(result.cameras)):
        name = "".join(sign if sign.isalnum() or sign in "-_" else "_" for sign in result.cameras[number].id)
        files[folder / f"coverage_{name}.png"] = encode_coverage(result, number)
    for path, data in {**files, **cameras}.items():
        path.parent.mkdir(parents=True, exist_ok=True)
        write_atomically(path, data)
    return {"out": str(out), "report": str(folder)}
