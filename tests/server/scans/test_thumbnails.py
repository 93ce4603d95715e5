"""Small pictures of scans."""

from __future__ import annotations

import cv2
import numpy as np

from server.scans.thumbnails import SIZE_PX, draw_thumbnail, find_upright
from tracker import Scan


def a_stick_with_a_wide_end(turn: np.ndarray) -> Scan:
    rng = np.random.default_rng(3)
    points = rng.uniform((-0.01, -0.1, -0.003), (0.01, 0.1, 0.003), (4000, 3))
    points[:, 0] *= np.where(points[:, 1] > 0, 3.0, 1.0)
    return Scan(points @ turn.T + 0.3, np.tile(turn[:, 2], (4000, 1)), None, None, "stick")


def open_picture(data: bytes) -> np.ndarray:
    return cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_UNCHANGED)


def test_a_scan_stands_upright_with_its_wide_end_on_top_however_it_lay() -> None:
    for seed in range(4):
        turn, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
        scan = a_stick_with_a_wide_end(turn * np.sign(np.linalg.det(turn)))
        upright = find_upright(scan.points)
        np.testing.assert_allclose(upright @ upright.T, np.eye(3), atol=1e-12)
        assert np.linalg.det(upright) > 0
        covered = open_picture(draw_thumbnail(scan, np.ones(4000, bool), "0" * 64))[:, :, 3] > 0
        rows = np.flatnonzero(covered.any(axis=1))
        assert rows[0] <= 0.1 * SIZE_PX
        assert rows[-1] >= 0.9 * SIZE_PX - 1
        assert covered[: SIZE_PX // 2].sum() > 2 * covered[SIZE_PX // 2 :].sum()


def test_what_is_left_out_is_not_drawn_and_nothing_gives_an_empty_picture() -> None:
    scan = a_stick_with_a_wide_end(np.eye(3))
    assert open_picture(draw_thumbnail(scan, np.zeros(4000, bool), "0" * 64))[:, :, 3].max() == 0
    half = scan.points[:, 1] > 0.3
    covered = open_picture(draw_thumbnail(scan, half, "0" * 64))[:, :, 3] > 0
    assert covered.sum() > 0.5 * open_picture(draw_thumbnail(scan, ~half, "0" * 64))[:, :, 3].astype(bool).sum()
