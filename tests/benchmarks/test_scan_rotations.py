"""Which fingertips are right."""

import numpy as np

from benchmarks.scan_rotations import are_tips_right

MARKS = np.array([[0.0, 0.0, 0.0], [3e-3, 0.0, 0.0], [0.05, 0.0, 0.0], [0.06, 0.0, 0.0], [0.1, 0.0, 0.0]])


def test_a_tip_is_right_near_its_own_mark_and_not_at_another_finger_s():
    for finger, off, is_right in ((0, 2.5e-3, True), (3, 7e-3, True), (2, 7e-3, False), (4, 13e-3, False)):
        tips = MARKS.copy()
        tips[finger, 0] += off
        assert are_tips_right(tips, MARKS) == is_right
    assert not are_tips_right(MARKS[[0, 1, 3, 2, 4]], MARKS)
