"""Motions of a body come back as they were written, and hostile files are refused by name."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tracker.errors import ModelFileError
from tracker.model.body_motion import BodyMotion, load_body_motion, save_body_motion

RNG = np.random.default_rng(0)
MOTION = BodyMotion(
    RNG.standard_normal((3, 52, 3)), RNG.standard_normal((3, 3)), RNG.standard_normal(16), 120.0, "male"
)
GOOD = {"poses": np.zeros((2, 156)), "trans": np.zeros((2, 3)), "betas": np.zeros(16)}


def test_a_motion_comes_back_to_the_last_bit_and_equal_motions_are_equal_files(tmp_path: Path) -> None:
    save_body_motion(MOTION, tmp_path / "a.npz")
    save_body_motion(replace(MOTION), tmp_path / "b.npz")
    found = load_body_motion(tmp_path / "a.npz")
    assert np.array_equal(found.poses, MOTION.poses) and np.array_equal(found.translations, MOTION.translations)
    assert np.array_equal(found.shape, MOTION.shape) and (found.fps, found.population) == (120.0, "male")
    assert (tmp_path / "a.npz").read_bytes() == (tmp_path / "b.npz").read_bytes()


def test_what_amass_writes_beside_the_poses_does_no_harm(tmp_path: Path) -> None:
    others = {"dmpls": np.zeros((2, 8)), "marker_labels": np.array(["a", "b"]), "gender": np.array(b"female")}
    np.savez(tmp_path / "m.npz", **GOOD, **others, mocap_framerate=np.array(60), notes=np.array([{}], dtype=object))
    found = load_body_motion(tmp_path / "m.npz")
    assert (len(found), found.fps, found.population) == (2, 60.0, "female")


@pytest.mark.parametrize(
    ("changes", "what"),
    [
        ({"poses": np.zeros((2, 165))}, "'poses', float64 2x165"),
        ({"poses": np.zeros((0, 156))}, "0 frames"),
        ({"poses": np.full((2, 156), np.nan)}, "'poses' with values"),
        ({"poses": np.full((2, 156), 1e6)}, "'poses' with values"),
        ({"poses": np.array([{"a": 1}], dtype=object)}, "no 'poses'"),
        ({"trans": np.zeros((3, 3))}, "'trans', float64 3x3"),
        ({"betas": np.zeros(1000)}, "1000 'betas'"),
        ({"mocap_framerate": np.array(0.0)}, "'mocap_framerate' of 0"),
        ({"mocap_framerate": np.zeros(2)}, "'mocap_framerate', float64 2"),
        ({"gender": np.array("robot")}, "gender 'robot'"),
    ],
)
def test_a_hostile_file_is_refused_by_what_is_wrong_in_it(changes: dict, what: str, tmp_path: Path) -> None:
    np.savez(tmp_path / "m.npz", **(GOOD | changes))
    with pytest.raises(ModelFileError, match=what):
        load_body_motion(tmp_path / "m.npz")


def test_no_file_and_a_file_of_noise_are_refused(tmp_path: Path) -> None:
    (tmp_path / "noise.npz").write_bytes(bytes(range(256)) * 9)
    for name in ("noise.npz", "nothing.npz"):
        with pytest.raises(ModelFileError, match=name):
            load_body_motion(tmp_path / name)
