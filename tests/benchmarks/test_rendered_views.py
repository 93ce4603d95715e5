"""What the study of rendered views counts, and what it runs."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.rendered_views.errors import Errors, find_interval
from benchmarks.rendered_views.nails import describe, describe_change
from benchmarks.rendered_views.page import BASE, SWARMS, list_settings, write_page
from benchmarks.rendered_views.setting import Setting


def test_errors_are_distances_of_joints_and_angles_of_bones(rng):
    truth = rng.uniform(-0.1, 0.1, (4, 42, 3))
    moved = Errors.of(truth + np.array([0.003, 0.0, 0.004]), truth)
    np.testing.assert_allclose(moved.mm, 5.0)
    np.testing.assert_allclose(moved.degrees, 0.0, atol=1e-4)
    turned = truth.copy()
    wrist, tip = truth[0, 21 + 7], truth[0, 21 + 8]
    turned[0, 21 + 8] = wrist + np.cross(np.array([0.0, 0.0, 1.0]), tip - wrist)
    degrees = Errors.of(turned, truth).degrees
    assert np.count_nonzero(degrees > 1e-3) == 1
    assert degrees[0].max() <= 90.0


def test_an_interval_holds_the_mean_and_is_as_wide_as_blocks_differ():
    frames = np.repeat([1.0, 3.0], 40)
    low, high = find_interval(frames)
    assert low < 2.0 < high
    assert high - low == pytest.approx(2 * 1.96 / np.sqrt(10), rel=0.3)  # ten blocks, each 1 or 3
    assert find_interval(np.full(20, 7.0)) == (7.0, 7.0)


def test_every_setting_is_run_once_and_a_page_without_runs_has_its_heads(tmp_path):
    settings = list_settings()
    assert len({setting.key for setting in settings}) == len(settings)
    page = write_page(tmp_path, 4, (64, 48))
    assert "Table 15" in page
    assert "64x48" in page


def test_a_page_tells_the_errors_of_joints_and_ball_by_detection_rate_beside_what_the_paper_says(tmp_path, rng):
    truth, ball = rng.uniform(-0.1, 0.1, (4, 42, 3)), rng.uniform(-0.1, 0.1, (4, 1, 3))
    for name, balls in (("crossing", ball[:, :0]), ("passing", ball)):
        for rate, off in ((0.3, 0.003), (0.7, 0.002)):
            path = tmp_path / f"{name}_4_64x48" / f"{replace(BASE, detected=rate).key}.npz"
            path.parent.mkdir(exist_ok=True)
            off_x = np.array([off, 0.0, 0.0])
            np.savez(path, joints=truth + off_x, truth=truth, ball=balls + 2.0 * off_x, true_ball=balls)
    lines = write_page(tmp_path, 4, (64, 48)).splitlines()
    start = lines.index("## Detection rate (Fig. 17a)")
    assert "a detection rate of only 30%" in " ".join(lines[start:])
    rows = [line for line in lines[start:] if line.startswith(("| 30% ", "| 70% "))]
    assert [row.split(" | ")[1] for row in rows] == ["3.00", "2.00"]
    assert [row.removesuffix(" |").split(" | ")[-1] for row in rows] == ["6.00 (6.0)", "4.00 (4.0)"]


def test_the_swarm_stands_below_our_terms_beside_the_papers(tmp_path, rng):
    truth = rng.uniform(-0.1, 0.1, (4, 42, 3))
    for name in ("crossing", "passing"):
        for particles, off in ((64, 0.005), (128, 0.004)):
            path = tmp_path / f"{name}_4_64x48" / f"{SWARMS[particles].key}.npz"
            path.parent.mkdir(exist_ok=True)
            ball = np.zeros((4, int(name == "passing"), 3))
            np.savez(path, joints=truth + np.array([0.0, off, 0.0]), truth=truth, ball=ball, true_ball=ball)
    rows = [line for line in write_page(tmp_path, 4, (64, 48)).splitlines() if line.startswith("| swarm, ")]
    assert [row.split(" | ")[1] for row in rows] == ["5.00", "4.00"]
    assert [row.removesuffix(" |").split(" | ")[-4] for row in rows] == ["4.86", "4.67"]
    assert "swarm" not in Setting().key


def test_lost_frames_are_counted_and_their_errors_are_not():
    apart = np.full((10, 21), 2.0)
    apart[0] = np.nan
    assert describe(apart) == "1 of 10 | 2.00 (2) | 2.00 (2)"
    assert describe(np.full((3, 21), np.nan)) == "3 of 3 | - | -"
    after = apart - 0.5
    after[3] = np.nan
    assert describe_change(apart, after) == "-0.50 (-0.50 to -0.50)"
    assert describe_change(apart, np.full((10, 21), np.nan)) == "-"
