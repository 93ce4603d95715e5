"""A track and detections as the checks read them: hands held, hands lost, how far they are from the depth."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from server.quality.witnesses import read_track

HANDS = [f"{hand}/{joint}" for hand in ("right", "left") for joint in range(21)]
FRAMES = [10, 11, 12]


def write(folder: Path, depth: list[float] | None = None, **changes: np.ndarray) -> Path:
    """A track of two hands in two cameras; joint j of a hand is at (j, frame) px."""
    points = np.zeros((len(FRAMES), 2, len(HANDS), 2))
    points[..., 0] = np.tile(np.arange(21), 2)
    points[..., 1] = np.array(FRAMES)[:, None, None]
    arrays = {
        "frame": np.array(FRAMES),
        "status": np.array(["tracked", "lost", "tracked"]),
        "camera_ids": np.array(["cam0", "cam1"]),
        "joint_names": np.array(HANDS),
        "joints_2d": points,
    }
    np.savez(folder / "track.npz", allow_pickle=False, **(arrays | changes))
    if depth is not None:
        np.savez(folder / "frames.npz", allow_pickle=False, depth_residual_mm=np.array(depth))
    return folder


def test_a_hand_is_where_the_track_held_it_and_lost_where_it_did_not(tmp_path: Path) -> None:
    found = read_track(write(tmp_path))
    assert found.lost == {(11, "right"), (11, "left")}
    assert set(found.joints) == {(c, f, h) for c in ("cam0", "cam1") for f in (10, 12) for h in ("right", "left")}
    np.testing.assert_array_equal(found.joints["cam1", 12, "left"], np.c_[np.arange(21), np.full(21, 12)])


def test_each_hand_has_its_own_state_where_the_track_says_it(tmp_path: Path) -> None:
    states = np.array([["tracked", "lost"], ["tracked", "tracked"], ["lost", "tracked"]])
    found = read_track(write(tmp_path, hand_names=np.array(["right", "left"]), hand_status=states))
    assert found.lost == {(10, "left"), (12, "right")}


def test_a_hand_without_all_its_joints_is_none(tmp_path: Path) -> None:
    names = np.array([name if name != "left/20" else "ball/0" for name in HANDS])
    assert {hand for _, _, hand in read_track(write(tmp_path, joint_names=names)).joints} == {"right"}


def test_frames_without_depth_say_nothing_of_it(tmp_path: Path) -> None:
    assert read_track(write(tmp_path)).depth_mm == {}
    assert read_track(write(tmp_path, [3.0, np.nan, 5.0])).depth_mm == {10: 3.0, 12: 5.0}
