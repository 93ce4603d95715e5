"""A verdict names what is wrong: another thing in the scan, a part of a person, a shape that nobody has."""

from __future__ import annotations

import numpy as np
import pytest

from tracker.bodies.body_verdict import judge_body
from tracker.model.body_model import body_model

VERTICES = body_model().template
IS_BODY = np.ones(len(VERTICES), dtype=np.bool_)


def judged(points, distances, shape):
    return judge_body(VERTICES, IS_BODY, points, distances, shape)


def test_points_all_over_the_body_and_close_to_it_are_good() -> None:
    verdict = judged(VERTICES, np.full(len(VERTICES), 1e-3), np.ones(20))
    assert (verdict.name, verdict.reasons) == ("good", ())
    assert verdict.measures == {"unexplained": 0.0, "uncovered": 0.0, "shape": 1.0}


@pytest.mark.parametrize(
    ("keep", "far", "shape", "said"),
    [
        (1.0, 0.2, 1.0, "another person or thing"),
        (0.6, 0.0, 1.0, "part of a person"),
        (1.0, 0.0, 6.0, "standard deviations"),
    ],
)
def test_each_fault_alone_makes_it_bad_and_is_named(keep: float, far: float, shape: float, said: str) -> None:
    height = VERTICES[:, 1]
    points = VERTICES[height > np.quantile(height, 1.0 - keep)]
    distances = np.where(np.arange(len(points)) < far * len(points), 0.1, 1e-3)
    verdict = judged(points, distances, np.full(20, shape))
    assert verdict.name == "bad" and len(verdict.reasons) == 1 and said in verdict.reasons[0]


def test_a_persons_own_template_has_no_shape_to_judge() -> None:
    assert judged(VERTICES, np.zeros(len(VERTICES)), np.zeros(0)).measures["shape"] == 0.0


def test_a_hundredth_of_the_points_far_from_the_body_is_enough_for_a_doubt() -> None:
    distances = np.where(np.arange(len(VERTICES)) < 0.01 * len(VERTICES), 0.02, 1e-3)
    verdict = judged(VERTICES, distances, np.ones(20))
    assert verdict.name == "doubtful" and "a part of the body lies in a wrong place" in verdict.reasons[0]
