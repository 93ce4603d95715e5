"""What `handloom evaluate` says for people: every figure with its unit, nothing where nothing was compared."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.tracker.evaluation.judged import make_evaluation
from tracker.capture.joint_source import JointSource
from tracker.cli.__main__ import main
from tracker.cli.evaluate import show


def test_errors_of_marked_joints_stand_in_rows_and_groups_without_joints_say_none() -> None:
    error = np.full((2, 21), 2.0)
    error[1] = 4.0
    said = show(
        {"annotations": make_evaluation(error, [3, 8], untracked=((9, "cam0", "left"),)).to_json()}
    ).splitlines()
    assert said[0] == "against 2 annotated hands (1 not in the track)"
    assert said[1] == "judged by 42 joints of unknown origin"
    row = "mean   3.00 px, std   1.00, median   3.00, p95   4.00, max    4.00  (42 joints)"
    assert said[2:5] == [f"  all joints  {row}", f"  visible     {row}", "  occluded    none"]
    assert said[5:] == ["  worst: frame 8, right hand, 4.00 px", "  worst: frame 3, right hand, 2.00 px"]


def test_what_a_track_made_is_said_with_how_to_count_it_too() -> None:
    sources = ((JointSource("track", "Track 2"),) * 21,)
    left_out = np.ones((1, 21), dtype=bool)
    found = make_evaluation(np.full((1, 21), np.nan), sources=sources, left_out=left_out)
    said = show({"annotations": found.to_json()}).splitlines()
    assert said[1] == "judged by no joint"
    assert said[2].startswith("21 joints are left out") and said[2].endswith("--sources all counts them too.")
    assert said[3:] == ["  all joints  none", "  visible     none", "  occluded    none"]


def test_the_truth_is_told_in_millimetres_and_pixels_with_what_was_lost_unnoticed() -> None:
    errors = {"count": 21, "mean": 1.5, "std": 0.5, "median": 1.25, "p95": 3.0, "max": 12.0}
    truth = {
        "frames": 4,
        "joint_error_mm": errors,
        "joint_error_px": errors | {"count": 0},
        "worst_frame_mm": 5.678,
        "lost": [2, 3],
        "silently_lost": [3],
    }
    assert show({"truth": truth, "report": "a.html"}).splitlines() == [
        "against the truth of 4 frames",
        "  all joints  mean   1.50 mm, std   0.50, median   1.25, p95   3.00, max   12.00  (21 joints)",
        "  all joints  none",
        "  worst frame 5.68 mm; lost 2, of them unnoticed 1",
        "report: a.html",
    ]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ([], "Nothing to compare with: give --annotations FILE, --truth FILE or both."),
        (["--truth", "truth.npz", "--report", "a.html"], "A report is about annotations: give --annotations FILE too."),
        (["--truth", "truth.npz", "--sources", "hand,guesses"], "The sources 'hand,guesses' are not known"),
    ],
)
def test_what_was_not_said_is_asked_for_before_the_track_is_read(arguments, said, tmp_path: Path, capsys) -> None:
    assert main(["evaluate", str(tmp_path / "nowhere"), *arguments]) == 2
    assert said in capsys.readouterr().err and list(tmp_path.iterdir()) == []
