"""Lists of people, poses and sides as people write them; numbers out of their limits are refused with the limits."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tracker.cli.__main__ import main
from tracker.cli.synthesize_scans import parse_poses, parse_sides, parse_subjects, show
from tracker.errors import TrackerError
from tracker.synthesis.scans.pose_list import FISTS, POSE_NAMES
from tracker.synthesis.scans.subject import TEST_SUBJECTS, TRAIN_SUBJECTS

EVERYBODY = (*TRAIN_SUBJECTS, *TEST_SUBJECTS)


def test_people_are_named_in_groups_or_counted_in_ranges_each_once_in_the_order_written() -> None:
    assert parse_subjects("train") == TRAIN_SUBJECTS and parse_subjects("test") == TEST_SUBJECTS
    assert parse_subjects("all") == EVERYBODY
    assert parse_subjects("20-22, 1,4,21") == (20, 21, 22, 1, 4) and parse_subjects("7-7") == (7,)


@settings(max_examples=40)
@given(st.lists(st.sampled_from(EVERYBODY), min_size=1, max_size=10))
def test_any_list_of_people_is_read_back(numbers: list[int]) -> None:
    assert parse_subjects(",".join(map(str, numbers))) == tuple(dict.fromkeys(numbers))


@pytest.mark.parametrize("text", ["", "some", "1,", "1-", "-3", "1.5", "1-2-3", "train,test"])
def test_what_is_no_list_of_people_is_refused_with_how_to_write_one(text: str) -> None:
    with pytest.raises(TrackerError, match=r"needed train, test, all, or numbers such as 1,4,20-25\."):
        parse_subjects(text)


@pytest.mark.parametrize("text", ["0", "38", "1-38", "1-99999999999", "30-99"])
def test_people_that_there_are_not_are_refused_with_those_there_are(text: str) -> None:
    with pytest.raises(TrackerError, match="there are the subjects 1 to 37, each once"):
        parse_subjects(text)


@pytest.mark.parametrize("text", ["5-3", "1,9-2"])
def test_a_range_that_runs_backwards_is_refused_and_not_taken_for_nobody(text: str) -> None:
    with pytest.raises(TrackerError, match=r"needed train, test, all, or numbers such as 1,4,20-25\."):
        parse_subjects(text)


def test_poses_are_named_and_frames_of_motions_need_the_motions() -> None:
    assert parse_poses("all", False) == POSE_NAMES and parse_poses("fists", False) == FISTS
    assert parse_poses(f"{POSE_NAMES[3]}, {POSE_NAMES[0]},{POSE_NAMES[3]}", False) == (POSE_NAMES[3], POSE_NAMES[0])
    assert parse_poses(f"09-60,{POSE_NAMES[0]}", True) == ("09-60", POSE_NAMES[0])
    with pytest.raises(TrackerError, match="frames of motions need --motions FOLDER"):
        parse_poses("09-60", False)
    with pytest.raises(TrackerError, match=rf"There is no pose 'wave'; there are {POSE_NAMES[0]}, "):
        parse_poses(f"{POSE_NAMES[0]},wave", True)


@pytest.mark.parametrize(("text", "sides"), [("left", ("left",)), ("left, right,left", ("left", "right"))])
def test_sides_are_taken_once_each(text: str, sides: tuple[str, ...]) -> None:
    assert parse_sides(text) == sides
    for wrong in ("", "both", "right,", "Left"):
        with pytest.raises(TrackerError, match="needed right, left or right,left"):
            parse_sides(wrong)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--repeats", "0"], "--repeats is 0; needed 1 to 1000."),
        (["--points", "99"], "--points is 99; needed 100 to 200000."),
        (["--noise-mm", "nan"], "--noise-mm is nan; needed 0.0 to 5.0."),
        (["--strength", "-1"], "--strength is -1.0; needed 0.0 to 4.0."),
        (["--seed", "-1"], "--seed is -1"),
        (["--sides", "none"], "--sides 'none'"),
    ],
)
def test_numbers_out_of_their_limits_are_refused_and_nothing_is_written(
    arguments, said, tmp_path: Path, capsys
) -> None:
    assert main(["synthesize-scans", "--out", str(tmp_path / "out"), *arguments]) == 2
    assert said in capsys.readouterr().err and not (tmp_path / "out").exists()


def test_one_scan_is_one() -> None:
    assert show({"scans": 1, "out": "a", "seconds": 2.04}) == "1 scan in a (2.0 s)"
    assert show({"scans": 0, "out": "a", "seconds": 0.0}) == "0 scans in a (0.0 s)"
