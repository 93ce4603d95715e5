"""What refined cameras tell: numbers rounded for programs, NaN as null, a line for each camera."""

from __future__ import annotations

import json

import pytest

from tracker.calibration.refinement import Agreement, RefinedCamera, Refinement

NONE = Agreement(0, float("nan"), float("nan"))
BEFORE, AFTER = Agreement(42, 7.123456, 6.5), Agreement(42, 1.25, 1.0)
STILL = RefinedCamera("door", False, 0.0, 0.0, 0.0, 0.0, BEFORE, AFTER, NONE, NONE)
MOVED = RefinedCamera("window", True, 12.34567, 0.98765, 0.0, 0.4567, BEFORE, AFTER, BEFORE, AFTER)
LONELY = RefinedCamera("shelf", False, 0.0, 0.0, 0.0, 0.0, NONE, NONE, NONE, NONE)
FOUND = Refinement((), (STILL, MOVED, LONELY), 1, 3, "door stands still.", "")


def test_an_agreement_of_no_marks_has_no_numbers_in_json() -> None:
    assert NONE.to_json() == {"joints": 0, "rms": None, "median": None}
    assert Agreement(1, float("inf"), 2.0).to_json() == {"joints": 1, "rms": None, "median": 2.0}
    assert BEFORE.to_json() == {"joints": 42, "rms": 7.1235, "median": 6.5}


def test_the_json_keeps_the_order_of_the_cameras_and_can_be_sent() -> None:
    told = json.loads(json.dumps(FOUND.to_json(), allow_nan=False))
    assert [camera["id"] for camera in told["cameras"]] == ["door", "window", "shelf"]
    assert (told["frames"], told["frames_left_out"], told["refusal"]) == (1, 3, "")
    window = told["cameras"][1]
    assert (window["moved_mm"], window["turned_deg"], window["unsure_px"]) == (12.346, 0.9877, 0.457)
    assert window["fitted_px"] == window["left_out_px"] == {"before": BEFORE.to_json(), "after": AFTER.to_json()}


def test_the_table_says_how_far_each_camera_moved_and_what_it_gained() -> None:
    lines = FOUND.say().splitlines()
    assert lines[0] == "Fitted to 1 labelled frame, judged by 3 left out." and lines[1] == "door stands still."
    head, still, moved, lonely = lines[2:6]
    assert " ".join(moved.split()) == "window 12.3 mm 0.99 ° 0.5 px 7.12 -> 1.25 7.12 -> 1.25"
    assert head.rstrip().endswith("left out, rms px") and len(head) == len(moved) == len(still)
    assert lonely == "shelf        stays as it is: too few of its labels are in another camera too"


@pytest.mark.parametrize("refusal", ["", "The labels are too few, to tell."])
def test_the_last_line_says_whether_to_take_it(refusal: str) -> None:
    found = Refinement((), (MOVED,), 9, 3, "", refusal)
    assert found.say().splitlines()[-1] == (refusal or "The cameras agree better with the labels that were left out.")
