"""Nothing that is within reach is left out, and little that is not is let in."""

import numpy as np
import pytest
from scipy.optimize import linprog
from scipy.spatial.transform import Rotation

from tracker.physics.hulls import build_hull
from tracker.physics.near_hulls import HullPairs


def distance_between(one, other):
    """Between two convex hulls of points, m: the least |x - y|, found by alternating projections (slow and plain)."""
    x = one.mean(axis=0)
    for _ in range(300):
        before, y = x, nearest_in_hull(other, x)
        x = nearest_in_hull(one, y)
        if np.linalg.norm(x - before) < 1e-8:
            break
    return np.linalg.norm(x - y)


def nearest_in_hull(points, target):
    """Frank-Wolfe with exact line search and away steps: the point of the hull of (N, 3) nearest to target."""
    shares = np.eye(len(points))[np.argmin(np.linalg.norm(points - target, axis=1))]
    for _ in range(200):
        x = shares @ points
        slope = points @ (x - target)
        best, worst = np.argmin(slope), np.argmax(np.where(shares > 0.0, slope, -np.inf))
        step = points[best] - points[worst]
        length = step @ step
        if length < 1e-18:
            break
        move = min(max(-(x - target) @ step / length, 0.0), shares[worst])
        shares[best] += move
        shares[worst] -= move
    return shares @ points


def apart_by_lp(one, other):
    """Whether a plane separates two sets of points: a linear programme."""
    rows = np.concatenate([np.c_[one, np.ones(len(one))], -np.c_[other, np.ones(len(other))]])
    return linprog(np.zeros(4), rows, -1e-3 * np.ones(len(rows)), bounds=(None, None)).status == 0


@pytest.mark.parametrize("reach", [0.0, 0.01])
def test_pairs_within_reach_are_never_left_out_and_far_ones_mostly_are(rng, reach):
    def some(count):
        return [build_hull(i, rng.normal(scale=[0.01, 0.02, 0.05], size=(15, 3))) for i in range(count)]

    still, moving = some(8), some(4)
    turns = rng.normal(size=(12, 3))
    Rs, centers = Rotation.from_rotvec(turns).as_matrix(), rng.uniform(-0.12, 0.12, size=(12, 3))
    near = HullPairs(still, moving).find_near(Rs[:8], centers[:8], Rs[8:], centers[8:], reach)
    far = []
    for s in range(8):
        for m in range(4):
            one, other = still[s].vertices @ Rs[s].T + centers[s], moving[m].vertices @ Rs[8 + m].T + centers[8 + m]
            distance = distance_between(one, other) if apart_by_lp(one, other) else 0.0
            if distance < reach - 1e-4 or distance == 0.0:
                assert near[s, m]
            if distance > reach + 0.02:
                far.append(near[s, m])
    assert len(far) >= 8 and np.mean(far) < 0.2


def test_everything_is_within_an_infinite_reach():
    hull = build_hull(0, 0.01 * np.eye(3))
    eye, here = np.eye(3)[None], np.zeros((1, 3))
    assert HullPairs([hull], [hull]).find_near(eye, here, eye, here + 9.0, np.inf).all()
    assert not HullPairs([hull], [hull]).find_near(eye, here, eye, here + 9.0, 1.0).any()


def test_without_hands_there_are_no_pairs():
    hull = build_hull(0, 0.01 * np.eye(3))
    none = HullPairs([], [hull]).find_near(
        np.zeros((0, 3, 3)), np.zeros((0, 3)), np.eye(3)[None], np.zeros((1, 3)), 0.1
    )
    assert none.shape == (0, 1)
