"""The contours of several views are one term: the sum of theirs, whatever the number of threads."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.terms.test_contours import SCENE, edges, truth
from tracker.fitting.frame_fit import FitOptions, fit_frame
from tracker.fitting.objective import Objective
from tracker.fitting.view_contours import ViewContours
from tracker.terms.contours import Contours
from tracker.terms.normal_equations import NormalEquations

__all__ = ["edges", "truth"]  # fixtures


@pytest.fixture
def contours(edges) -> ViewContours:
    return ViewContours({f"cam{number}": Contours(seen) for number, seen in enumerate(edges)})


def test_the_term_adds_what_the_contours_of_each_view_add(contours, truth):
    posed = SCENE.pose_at(truth)
    together, apart = NormalEquations.at(posed), NormalEquations.at(posed)
    contours.find(posed).add_to(together)
    for own in contours.views.values():
        own.find(posed).add_to(apart)
    assert together.count == apart.count > 300
    np.testing.assert_allclose(together.blocks, apart.blocks, rtol=1e-12, atol=1e-9)
    np.testing.assert_allclose(together.gradients, apart.gradients, rtol=1e-12, atol=1e-9)
    assert together.cost == pytest.approx(apart.cost, rel=1e-12)
    assert list(contours.find(posed).parts) == ["cam0", "cam1", "cam2"]


def test_two_threads_fit_to_the_same_bits_as_one(contours, truth, rng):
    start = truth + rng.normal(0.0, 0.01, len(truth))
    poses = [
        fit_frame(SCENE, None, start, start, Objective({"contours": term}), FitOptions(iterations=6)).pose
        for term in (contours, replace(contours, threads=2))
    ]
    np.testing.assert_array_equal(*poses)


def test_contours_that_reach_farther_meet_more_edges(contours, truth):
    pose = truth.copy()
    pose[:3] += [0.006, 0.0, 0.0]
    posed = SCENE.pose_at(pose)
    near, far = contours.reaching(0.002).find(posed).count, contours.find(posed).count
    assert 0 < near < 0.8 * far
