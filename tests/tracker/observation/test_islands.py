"""Parts of a hand that show by themselves."""

from __future__ import annotations

import numpy as np

from tracker.observation.islands import find_islands

K = np.array([[240.0, 0, 80], [0, 240.0, 60], [0, 0, 1]])
DEPTH = np.full((120, 160), 0.48, dtype=np.float32)  # 2 mm a pixel


def test_a_fingertip_apart_from_the_hand_is_an_island_and_the_hand_and_a_speck_are_none():
    is_hand = np.zeros((120, 160), dtype=bool)
    is_hand[50:110, 40:100] = True
    is_hand[20:26, 60:65] = True  # 12 by 10 mm
    is_hand[10:11, 10:12] = True  # 2 by 4 mm
    (island,) = find_islands(is_hand, DEPTH, K)
    assert np.array_equal(np.argwhere(island.is_in).min(axis=0), [20, 60])
    assert island.middle.tolist() == [62.0, 22.5]
    np.testing.assert_allclose([island.area, island.depth], [120e-6, 0.48], rtol=1e-6)


def test_the_largest_island_comes_first():
    is_hand = np.zeros((120, 160), dtype=bool)
    is_hand[20:25, 60:64] = is_hand[20:28, 100:106] = True
    assert [round(1e6 * island.area) for island in find_islands(is_hand, DEPTH, K)] == [192, 80]


def test_in_an_image_without_a_hand_there_are_none():
    assert find_islands(np.zeros((120, 160), dtype=bool), DEPTH, K) == []
