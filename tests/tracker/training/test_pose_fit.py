"""Poses of registrations under a known rest shape: first ones by bone, then exact ones."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from tests.tracker.training.fingers import PARENTS, make_fingers
from tracker.model.skinning import keep_heaviest
from tracker.training.pose_fit import Hands, Poses, each, fit_poses, start_poses
from tracker.training.rig import Rig


@pytest.fixture(scope="module")
def fingers():
    return make_fingers(people=3, poses=8)


@pytest.fixture(scope="module")
def rig(fingers):
    return Rig(PARENTS, keep_heaviest(fingers.weights), fingers.directions)


@pytest.fixture(scope="module")
def hands(fingers, rig):
    return Hands(fingers.targets, fingers.owners, fingers.templates, fingers.joints, rig)


def find_angles(found: np.ndarray, true: np.ndarray) -> np.ndarray:
    """(N, B) rad between rotations."""
    cosine = 0.5 * (np.einsum("nbij,nbij->nb", found, true) - 1.0)
    return np.arccos(np.clip(cosine, -1.0, 1.0))


def test_first_poses_are_near_whatever_the_length_of_the_fingers(fingers, rig):
    average = np.tile(fingers.templates.mean(0), (3, 1, 1))
    joints = np.tile(fingers.joints.mean(0), (3, 1, 1))
    start = start_poses(Hands(fingers.targets, fingers.owners, average, joints, rig))
    assert np.degrees(find_angles(start.rotations, fingers.rotations)).max() < 12.0
    assert np.linalg.det(start.rotations) == pytest.approx(np.ones((24, 4)))


def test_from_first_poses_the_true_ones_are_found(fingers, hands):
    start = start_poses(hands)
    found = fit_poses(start, hands, 20)
    assert found.errors.max() < 1e-6
    assert np.degrees(find_angles(found.rotations, fingers.rotations)).max() < 0.01
    assert found.translations == pytest.approx(fingers.translations, abs=1e-6)


def test_threads_change_nothing_and_the_start_stays(hands):
    start = start_poses(hands)
    before = start.rotations.copy()
    one, two = (fit_poses(start, hands, 3, threads) for threads in (1, 2))
    assert one.rotations.tobytes() == two.rotations.tobytes() and (start.rotations == before).all()


def test_more_steps_never_fit_worse(fingers, hands):
    noise = 1e-3 * np.random.default_rng(0).normal(size=fingers.targets.shape)
    start = Poses(fingers.rotations[::-1].copy(), fingers.translations[::-1].copy(), np.zeros(24))
    noisy = replace(hands, targets=fingers.targets + noise)
    errors = [fit_poses(start, noisy, steps).errors for steps in (0, 1, 3, 9)]
    for before, after in pairwise(errors):
        assert (after <= before + 1e-12).all()


def test_progress_is_told_and_may_cancel():
    shares: list[float] = []
    each(lambda n: None, 250, 1, shares.append)
    assert shares == [0.4, 0.8, 1.0]

    def cancel(share: float) -> None:
        raise KeyboardInterrupt

    done: list[int] = []
    with pytest.raises(KeyboardInterrupt):
        each(done.append, 250, 1, cancel)
    assert len(done) == 100


def test_the_four_largest_weights_are_kept():
    rng = np.random.default_rng(1)
    weights = rng.dirichlet(np.full(7, 0.5), 50)
    full = keep_heaviest(weights)
    assert full.sum(1) == pytest.approx(np.ones(50)) and ((full > 0.0).sum(1) <= 4).all()
    for row, kept in zip(weights, full, strict=True):
        largest = np.sort(np.argsort(-row, kind="stable")[:4])
        assert kept[largest] == pytest.approx(row[largest] / row[largest].sum())
