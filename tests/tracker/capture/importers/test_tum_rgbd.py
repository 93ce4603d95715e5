"""TUM RGB-D folders: colour and depth are joined by time."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from tracker.capture import ImportOptions, check_import, load_sequence, run_import
from tracker.capture.importers.tum_rgbd import associate

TOLD = ImportOptions(intrinsics="freiburg3")
DEPTHS = [100.000, 100.033, 100.067, 100.100, 100.133]


@pytest.fixture
def folder(tmp_path: Path, save_png) -> Path:
    """Colour 5 ms after depth, one colour image more than depth images; 480 lines as the benchmark's cameras have."""
    root = tmp_path / "rgbd_dataset"
    colors = [t + 0.005 for t in DEPTHS] + [100.170]
    for i, time in enumerate(DEPTHS):
        save_png(root / f"depth/{time:.6f}.png", np.full((480, 640), 2500 + i, np.uint16))
    for i, time in enumerate(colors):
        save_png(root / f"rgb/{time:.6f}.png", np.full((480, 640, 3), i, np.uint8))
    write_list(root / "depth.txt", [f"{t:.6f} depth/{t:.6f}.png" for t in DEPTHS])
    write_list(root / "rgb.txt", [f"{t:.6f} rgb/{t:.6f}.png" for t in colors])
    write_list(root / "groundtruth.txt", ["100.0 0 0 0 0 0 0 1"])
    return root


def write_list(path: Path, lines: list[str]) -> None:
    path.write_text("# timestamp filename\n" + "\n".join(lines) + "\n")


def test_depth_gets_the_colour_nearest_in_time(folder: Path, tmp_path: Path) -> None:
    report = run_import(folder, tmp_path / "store/r", options=TOLD)
    assert report.format == "tum_rgbd" and report.frame_count == 5
    assert report.left_out == ("rgb/100.170000.png",)
    assert report.fps == pytest.approx(30, abs=0.5)
    times = report.cameras[0].timestamps
    assert times is not None and times.monotonic and times.dropped == 0
    text = " ".join(report.warnings)
    assert "up to 5.0 ms" in text and "groundtruth.txt is not used" in text
    sequence = load_sequence(tmp_path / "store/r")
    np.testing.assert_allclose(np.diag(sequence.cameras[0].K), [535.4, 539.2, 1])
    frame = sequence.frame(3, "cam0")
    assert frame.depth is not None and frame.color is not None
    assert frame.depth[0, 0] == pytest.approx(2503 / 5000) and frame.color[0, 0, 0] == 3
    stored = json.loads((tmp_path / "store/r/sources.json").read_text())["cameras"]["cam0"]
    assert stored["color"][2]["source"] == "rgb/100.072000.png"
    assert stored["depth"][2]["timestamp"] == pytest.approx(0.067)


def test_the_camera_must_be_told(folder: Path) -> None:
    report = check_import(folder)
    assert not report.ok and "freiburg1" in " ".join(report.problems)
    own = ImportOptions(fx=525, cx=319.5, cy=239.5)
    assert check_import(folder, options=own).ok


def test_depth_without_colour_in_time_is_refused_until_it_is_allowed(folder: Path) -> None:
    lines = (folder / "rgb.txt").read_text().splitlines()
    (folder / "rgb.txt").write_text("\n".join(lines[:3] + lines[4:]))
    report = check_import(folder, options=TOLD)
    assert (
        not report.ok
        and "1 of 5 depth images have no colour image within 20 ms (depth/100.067000.png)" in report.problems[0]
    )
    report = check_import(folder, options=ImportOptions(intrinsics="freiburg3", allow_gaps=True))
    assert report.ok and report.frame_count == 4 and "depth/100.067000.png" in report.left_out
    assert "1 frame seems to have been dropped" in " ".join(report.warnings)


@pytest.mark.parametrize(
    "line",
    [
        *("nan rgb/a.png", "1e400 rgb/a.png", "-5 rgb/a.png", "x rgb/a.png", "100.2", "100.2 rgb/a.png b"),
        *(
            "100.2 ../../etc/a.png",
            "100.2 /etc/a.png",
            "100.2 rgb\\a.png",
            "1.0 rgb/100.005000.png",
            "100.2 rgb/none.png",
        ),
    ],
)
def test_a_bad_line_is_refused(folder: Path, line: str) -> None:
    with (folder / "rgb.txt").open("a") as file:
        file.write(line + "\n")
    with (folder / "depth.txt").open("a") as file:
        file.write(line.replace("rgb", "depth") + "\n")
    report = check_import(folder, options=TOLD)
    assert not report.ok
    assert "rgb" in " ".join(report.problems) or "depth" in " ".join(report.problems)


def test_an_empty_list_is_refused(folder: Path) -> None:
    write_list(folder / "depth.txt", [])
    assert "lists no images" in check_import(folder, options=TOLD).problems[0]


def test_partners_are_closest_first_and_never_shared() -> None:
    first, second = np.array([0.0, 1.0, 2.0]), np.array([0.9, 1.05, 5.0])
    np.testing.assert_array_equal(associate(first, second, 0.2), [-1, 1, -1])
    np.testing.assert_array_equal(associate(first, second, 1.2), [0, 1, -1])
    np.testing.assert_array_equal(associate(np.zeros(0), second, 1.0), np.zeros(0))
