"""A calibration's numbers are told by camera and by board, in JSON without NaN and in a table for people."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.calibration.found_calibration import found_calibration
from tracker.calibration.calibration_report import describe_calibration, say_calibration
from tracker.calibration.camera_calibration import TimeOffset

FOUND = found_calibration()


def test_each_camera_has_its_own_rms_and_median_of_what_was_fitted_left_out_and_placed_by_others() -> None:
    first, second = describe_calibration(FOUND)["cameras"]
    assert first["residual_px"] == {
        "fitted": {"rms": pytest.approx(np.sqrt(0.125), abs=1e-4), "median": 0.35, "corners": 2},
        "left_out": {"rms": 0.6, "median": 0.6, "corners": 1},
        "by_other_cameras": {"rms": None, "median": None, "corners": 0},
    }
    assert second["residual_px"]["by_other_cameras"] == {"rms": 5.0, "median": 5.0, "corners": 1}
    assert (first["frames"], first["frames_with_board"], second["frames"]) == (90, 60, 91)
    assert second["time_offset"] == {"seconds": -0.0335, "frames": -1.005, "known": True}


def test_all_cameras_together_are_the_corners_of_each_together() -> None:
    told = describe_calibration(FOUND)
    for name in ("fitted", "left_out", "by_other_cameras"):
        own = [camera["residual_px"][name] for camera in told["cameras"]]
        corners = sum(one["corners"] for one in own)
        squares = sum(one["corners"] * (one["rms"] or 0.0) ** 2 for one in own)
        assert told["residual_px"][name]["corners"] == corners
        assert told["residual_px"][name]["rms"] == pytest.approx(np.sqrt(squares / corners), abs=1e-3)


def test_a_board_names_the_cameras_that_saw_it_and_has_no_place_where_none_is_known() -> None:
    seen, lost, left_out = describe_calibration(FOUND)["boards"]
    assert list(seen["residual_px"]) == ["cam0", "cam1"] and seen["T_world_board"] == np.eye(4).tolist()
    assert lost == {"seconds": 0.5, "left_out": False, "T_world_board": None, "residual_px": {}}
    assert left_out["left_out"] is True and left_out["residual_px"]["cam1"]["rms"] == 5.0


def test_the_description_is_json_and_its_cameras_come_back_to_the_last_digit() -> None:
    told = json.loads(json.dumps(describe_calibration(FOUND), allow_nan=False))
    for camera, one in zip(FOUND.cameras, told["cameras"], strict=True):
        assert np.array_equal(one["K"], camera.K) and np.array_equal(one["T_world_camera"], camera.T_world_camera)
        assert np.array_equal(one["distortion"], camera.distortion)
    assert told["world"].startswith("the frame of cam0") and told["board"] == FOUND.board.describe()


def test_the_table_has_a_line_for_each_camera_under_the_same_columns() -> None:
    lines = say_calibration(FOUND).splitlines()
    assert lines[0].endswith("2 cameras, judged at 3 moments, 1 of them left out of the fit.")
    head, first, second, together = lines[2:6]
    end = head.index("left out px") + len("left out px")
    assert first[:end].endswith("0.60 / 0.60") and second[:end].endswith("5.00 / 5.00")
    assert together.startswith("all ") and together[: head.index("offset ms")].rstrip().endswith("5.00 / 5.00")
    assert first.split()[-4:-3] == ["0.00"] and "-33.5" in second and "-1.00" in second
    assert "-" in first[end : head.index("offset ms")].split(), "cam0 was never judged by the others alone"


def test_an_offset_that_the_motion_does_not_tell_is_not_given_as_a_number() -> None:
    untold = replace(FOUND, offsets=(FOUND.offsets[0], TimeOffset(0.0, 0.0, False)))
    line = say_calibration(untold).splitlines()[4]
    assert line.startswith("cam1") and "not told" in line
    assert line.index("+") == say_calibration(FOUND).splitlines()[4].index("+"), "places stay in their column"


def test_warnings_end_the_text_and_without_them_nothing_is_said_to_look_at() -> None:
    assert "To look at" not in say_calibration(FOUND)
    warned = replace(FOUND, warnings=("cam1: moved.", "cam0: is blurred."))
    assert say_calibration(warned).splitlines()[-3:] == ["To look at:", "- cam1: moved.", "- cam0: is blurred."]
    assert describe_calibration(warned)["warnings"] == ["cam1: moved.", "cam0: is blurred."]


def test_a_long_name_is_cut_in_the_table_and_whole_in_the_json() -> None:
    name = "the camera over the door of the kitchen"
    named = replace(FOUND, cameras=(replace(FOUND.cameras[0], id=name), FOUND.cameras[1]))
    assert say_calibration(named).splitlines()[3].startswith(f"{name[:15]}       90")
    assert describe_calibration(named)["cameras"][0]["id"] == name
