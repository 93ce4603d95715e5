"""`c0.dat` and `rot_trans_c0.dat`: sections of numbers, each once, that make a camera."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracker.capture.dat_calibration import parse_dat
from tracker.errors import CalibrationError

INSIDE = "intrinsic:\n30 0 16\n0 31 12\n0 0 1\ndistortion:\n0.1 0 0 0 0\n"
OUTSIDE = "R:\n0 -1 0\n1 0 0\n0 0 1\nT:\n1\n2\n3\n"


def parse(inside: str = INSIDE, outside: str | None = OUTSIDE):
    return parse_dat(inside.encode(), None if outside is None else outside.encode(), "c0", "c0.dat")


def test_a_camera_is_read_from_its_two_files() -> None:
    camera = parse(f"\n{INSIDE}# a line that begins so ends the file\nR:\nnothing", f"{OUTSIDE}intrinsic:\n1\n")
    assert (camera.name, camera.K.tolist()) == ("c0", [[30, 0, 16], [0, 31, 12], [0, 0, 1]])
    assert camera.distortion.tolist() == [0.1, 0, 0, 0, 0] and camera.t.tolist() == [1, 2, 3]
    np.testing.assert_allclose(camera.find_pose(0.001)[:3, 3], [-0.002, 0.001, -0.003])


def test_one_camera_alone_needs_no_place() -> None:
    assert parse(outside=None).find_pose(1.0).tolist() == np.eye(4).tolist()


@pytest.mark.parametrize(
    ("inside", "outside", "told"),
    [
        ("", OUTSIDE, "no section 'intrinsic:'"),
        ("1 2 3\n", OUTSIDE, "line 1: is '1 2 3'"),
        ("lens:\n1\n", OUTSIDE, "'lens:' is unknown"),
        (INSIDE + "intrinsic:\n1\n", OUTSIDE, "line 7: section 'intrinsic:'"),
        (INSIDE.replace("31", "x"), OUTSIDE, "line 3"),
        (INSIDE.replace("0 31 12", "0 31"), OUTSIDE, "different lengths"),
        (INSIDE.replace("31", "nan"), OUTSIDE, "NaN or infinity"),
        (INSIDE.replace("31", "1e999"), OUTSIDE, "NaN or infinity"),
        (INSIDE.replace("0 0 1\n", ""), OUTSIDE, r"K has shape \(2, 3\)"),
        ("intrinsic:\n" + INSIDE[INSIDE.index("distortion") :], OUTSIDE, "K|different lengths"),
        (INSIDE, "", "needed the sections 'R:' and 'T:'"),
        (INSIDE, OUTSIDE.replace("0 0 1", "0 0 2"), "not a rotation"),
        (INSIDE, OUTSIDE.replace("0 0 1", "0 0 -1"), "not a rotation"),
        (INSIDE, OUTSIDE + "4\n", "t has 4 numbers"),
    ],
)
def test_files_that_make_no_camera_are_refused(inside: str, outside: str, told: str) -> None:
    with pytest.raises(CalibrationError, match=told):
        parse(inside, outside)


@given(st.text(st.sampled_from("0123456789 .-e\nRT:naif#"), max_size=60))
def test_any_text_makes_a_camera_or_an_error_that_names_the_file(text: str) -> None:
    try:
        assert np.isfinite(parse(outside=text).find_pose(1.0)).all()
    except CalibrationError as refusal:
        told = str(refusal)
    else:
        return
    assert "c0.dat" in told
