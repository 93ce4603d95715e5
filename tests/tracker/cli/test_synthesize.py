"""What can be rendered is told before anything is; sizes and numbers are read strictly."""

from __future__ import annotations

import argparse
import json
from pathlib import Path

import numpy as np
import pytest

from tracker.capture.sequence import load_sequence
from tracker.capture.truth import load_truth
from tracker.cli.__main__ import main
from tracker.cli.synthesize import parse_size, show


@pytest.mark.parametrize(("text", "size"), [("640x480", (640, 480)), ("32X4096", (32, 4096))])
def test_a_size_is_width_by_height(text: str, size: tuple[int, int]) -> None:
    assert parse_size(text) == size


@pytest.mark.parametrize("text", ["", "640", "640x", "640x480x3", "31x480", "640x4097", "-640x480", "6.4x480", "axb"])
def test_what_is_no_size_is_refused_with_how_to_write_one(text: str) -> None:
    with pytest.raises(argparse.ArgumentTypeError, match="needed WIDTHxHEIGHT, 32 to 4096 px each, as 640x480"):
        parse_size(text)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--motion", "wave", "--cameras", "0"], "--cameras must be 1 to 8"),
        (["--motion", "wave", "--cameras", "9"], "--cameras must be 1 to 8"),
        (["--twin", "nowhere", "--sequence", "09", "--cameras", "2"], "a twin (--twin) has the one camera"),
        (["--twin", "nowhere", "--sequence", "09", "--size", "64x64"], "640x480 px"),
        (["--motion", "wave", "--seed", "-1"], "--seed, --background and --circles at least 0"),
        (["--motion", "wave", "--background", "-0.1"], "at least 0"),
        (["--motion", "wave", "--nails"], "--nails needs --texture"),
        (["--motion", "wave", "--frames", "5:5"], "none is left of 5:5"),
        (["--motion", "wave", "--hand", "left=nowhere.npz"], "nowhere.npz"),
    ],
)
def test_what_cannot_be_rendered_is_refused_and_nothing_is_written(arguments, said, tmp_path: Path, capsys) -> None:
    assert main(["synthesize", "--out", str(tmp_path / "out"), *arguments]) == 2
    assert said in capsys.readouterr().err and list(tmp_path.iterdir()) == []


def test_every_second_frame_of_a_small_left_hand_is_rendered_without_noise_and_its_truth_says_which(
    tmp_path: Path, capsys
) -> None:
    out = tmp_path / "out"
    arguments = ["--motion", "wave", "--hand", "left", "--frames", "1:6", "--step", "2", "--size", "96x64"]
    assert main(["synthesize", *arguments, "--noise", "none", "--out", str(out), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert (told["frames"], told["hands"], told["objects"]) == (3, ["left"], [])
    sequence, truth = load_sequence(out), load_truth(out / "truth.npz")
    assert (sequence.cameras[0].width, sequence.cameras[0].height, sequence.frame_count) == (96, 64, 3)
    assert truth.frame.tolist() == [0, 1, 2] and truth.source_frame.tolist() == [1, 3, 5]
    seen = truth.visibility[0, 0] == 2
    columns, rows = np.rint(truth.joints_2d[0, 0, seen]).astype(int).T
    depth = sequence.depth_raw(0, sequence.cameras[0].id)[rows, columns] * sequence.cameras[0].depth_scale
    joints = (truth.joints_3d[0, seen] - sequence.cameras[0].T_world_camera[:3, 3]) @ sequence.cameras[
        0
    ].T_world_camera[:3, 2]
    on_hand = depth > 0
    assert on_hand.mean() > 0.7 and (joints[on_hand] - depth[on_hand] > -0.002).all(), "skin lies before its joint"


def test_a_folder_that_exists_is_left_alone(tmp_path: Path, capsys) -> None:
    (tmp_path / "mine.txt").write_text("mine")
    arguments = ["--motion", "wave", "--frames", "0:1", "--size", "64x48", "--out", str(tmp_path)]
    assert main(["synthesize", *arguments]) != 0
    assert str(tmp_path) in capsys.readouterr().err
    assert [entry.name for entry in tmp_path.iterdir()] == ["mine.txt"]


def test_one_frame_is_one() -> None:
    assert show({"name": "wave", "frames": 1, "out": "a", "seconds": 0.25}) == "wave: 1 frame in a (0.2 s)"
