"""Shape directions of parts of a hand, learnt from few people."""

from __future__ import annotations

import numpy as np
import pytest

from tests.tracker.training.test_train import crude_finger, make_set
from tracker.errors import TrainingError
from tracker.training.local_shapes import find_local_shapes
from tracker.training.options import TrainingOptions
from tracker.training.spaces import find_shape_space, find_space
from tracker.training.train import train_model


@pytest.fixture(scope="module")
def patchwork():
    """Templates (30, 60, 3) of a strip 0.6 m long whose three thirds vary independently, with one mode each."""
    rng = np.random.default_rng(0)
    strip = np.stack([np.linspace(0.0, 0.6, 60), np.zeros(60), np.zeros(60)], axis=1)
    modes = rng.normal(scale=0.01, size=(60, 3))
    third = np.arange(60) // 20
    return np.stack([strip + modes * rng.normal(size=3)[third][:, None] for _ in range(30)])


def residual(templates, mean, directions):
    flat = directions.reshape(len(mean.ravel()), -1)
    offsets = (templates - mean).reshape(len(templates), -1).T
    return np.sqrt(np.mean((offsets - flat @ np.linalg.lstsq(flat, offsets, rcond=None)[0]) ** 2))


def test_of_parts_that_vary_by_themselves_three_people_teach_what_else_takes_many(patchwork):
    few, others = patchwork[:3], patchwork[3:]
    mean, whole, space = find_shape_space(few, 2)
    local = find_local_shapes(few, space.components[:2], 6, reach=0.1)
    with_parts = np.concatenate([whole, local], axis=2)
    assert residual(others, mean, with_parts) < 0.5 * residual(others, mean, whole)


def test_they_stand_at_right_angles_to_the_whole_hands_and_to_one_another(patchwork):
    space = find_space(patchwork[:5].reshape(5, -1))
    local = find_local_shapes(patchwork[:5], space.components[:3], 8, reach=0.1).reshape(180, -1)
    assert np.abs(space.components[:3] @ local).max() < 1e-9
    gram = local.T @ local
    assert gram == pytest.approx(np.diag(np.diag(gram)), abs=1e-9)
    assert (np.diff(np.diag(gram)) <= 1e-12).all()


def test_where_everything_is_near_they_are_the_further_principal_components(patchwork):
    _, directions, space = find_shape_space(patchwork[:6], 5)
    local = find_local_shapes(patchwork[:6], space.components[:2], 3, reach=1e3)
    assert np.abs(local) == pytest.approx(np.abs(directions[:, :, 2:]), abs=1e-5)


def test_no_more_come_than_the_templates_tell_of():
    same = np.repeat(np.random.default_rng(1).normal(size=(1, 10, 3)), 4, axis=0)
    assert find_local_shapes(same, np.zeros((0, 30)), 5).shape == (10, 3, 0)


def test_a_trained_model_has_them_behind_the_principal_components():
    options = TrainingOptions(rounds=1, num_shapes=3, ridge=1e-3)
    plain = train_model(make_set(), crude_finger(), options).model
    both = train_model(make_set(), crude_finger(), TrainingOptions(**{**vars(options), "num_local_shapes": 4})).model
    assert both.num_shape == 7
    assert np.array_equal(both.shape_directions[:, :, :3], plain.shape_directions)


@pytest.mark.parametrize("count", [-1, 201])
def test_how_many_is_checked(count):
    with pytest.raises(TrainingError, match="num_local_shapes"):
        TrainingOptions(num_local_shapes=count)
