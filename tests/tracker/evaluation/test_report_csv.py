"""The table that other programs read: rows in order, empty cells for what is not there, no formula among the names."""

from __future__ import annotations

import csv
import io

import numpy as np
import pytest

from tests.tracker.evaluation.judged import judge, make_evaluation
from tracker.capture.joint_source import JointSource
from tracker.evaluation.report_csv import COLUMNS, defuse, write_csv
from tracker.model.joints import HAND_JOINTS


def read(text: str) -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO(text)))


def test_without_tracks_there_is_the_head_alone() -> None:
    assert write_csv([]) == ",".join(COLUMNS) + "\n" == write_csv([judge("a", make_evaluation(np.zeros((0, 21))))])


def test_rows_are_in_the_order_of_tracks_frames_and_joints() -> None:
    judged = [judge(key, make_evaluation(np.ones((2, 21)), [3, 7])) for key in ("b", "a")]
    rows = read(write_csv(judged))
    assert [(row["track_id"], row["frame"], row["joint"]) for row in rows] == [
        (key, frame, joint) for key in ("b", "a") for frame in ("3", "7") for joint in HAND_JOINTS
    ]
    assert {row["track"] for row in rows} == {"Track b", "Track a"} and {row["counts"] for row in rows} == {"yes"}


def test_what_does_not_project_has_empty_cells_and_what_is_left_out_says_so() -> None:
    error = np.full((1, 21), 2.0)
    error[0, :2] = np.nan
    evaluation = make_evaluation(error)
    evaluation.tracked[0, 0] = np.nan
    evaluation.left_out[0, 1] = True
    first, second, third = read(write_csv([judge("a", evaluation)]))[:3]
    assert (first["tracked_x"], first["tracked_y"], first["error_px"], first["counts"]) == ("", "", "", "yes")
    assert (second["error_px"], second["counts"]) == ("", "left out")
    assert (third["marked_x"], third["marked_y"], third["tracked_x"], third["error_px"]) == (
        *("20.000", "20.000", "22.000", "2.000"),
    )


def test_each_joint_tells_where_it_came_from() -> None:
    sources = (None, JointSource("track", "Track 2"), JointSource("track", "=1+1"), *(None,) * 18)
    rows = read(write_csv([judge("a", make_evaluation(np.ones((1, 21)), sources=(sources,)))]))
    assert [row["source"] for row in rows[:3]] == ["placed by hand", "accepted from Track 2", "accepted from =1+1"]
    assert read(write_csv([judge("a", make_evaluation(np.ones((1, 21))))]))[0]["source"] == "of unknown origin"


def test_commas_quotes_and_lines_in_a_name_stay_in_its_cell() -> None:
    name = 'a, "b"\nc'
    (first, *_) = read(write_csv([judge("a", make_evaluation(np.ones((1, 21))), name)]))
    assert first["recording"] == name and set(first) == set(COLUMNS)


@pytest.mark.parametrize("sign", ["=", "+", "-", "@", "\t", "\r"])
def test_a_name_that_begins_like_a_formula_is_marked_as_text(sign: str) -> None:
    assert defuse(f"{sign}1") == f"'{sign}1" and defuse(f"a{sign}1") == f"a{sign}1" and defuse("") == ""
