"""The agreement of people whose noise we made ourselves."""

from __future__ import annotations

import numpy as np
import pytest

from server.teams.agreement import OKS_SIGMAS, measure_agreement


def simulate(sigmas: list[float], places: int, seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """(A, P, 21, 3) points of people with these sigmas, px per axis, around places that nobody knows."""
    rng = np.random.default_rng(seed)
    truth = rng.uniform(0, 640, (places, 1, 2)) + rng.uniform(0, 200, (places, 21, 2))
    noise = rng.normal(size=(len(sigmas), places, 21, 2)) * np.array(sigmas)[:, None, None, None]
    points = np.concatenate([truth + noise, np.full((len(sigmas), places, 21, 1), 2.0)], axis=-1)
    return points, np.ones((len(sigmas), places), dtype=bool)


def leave_out(points: np.ndarray, marked: np.ndarray, share: float, seed: int = 1) -> None:
    """Joints that somebody did not place, and images that somebody left out."""
    rng = np.random.default_rng(seed)
    points[..., 2] *= rng.random(points.shape[:3]) >= share
    marked &= rng.random(marked.shape) >= share / 2


@pytest.mark.parametrize(
    ("sigmas", "places"),
    [
        ([1.46] * 4, 200),
        ([0.8, 1.2, 1.6, 2.4], 400),
        ([1.0, 1.0, 1.0, 1.0, 6.0], 400),
        ([0.5, 3.0, 1.0], 6000),  # beside so rough a third one it takes many hands to tell two careful ones apart
    ],
)
def test_each_persons_noise_comes_back_though_joints_are_missing(sigmas: list[float], places: int) -> None:
    points, marked = simulate(sigmas, places)
    leave_out(points, marked, 0.2)
    found = measure_agreement(points, marked)
    assert [person.std_px for person in found.people] == pytest.approx(sigmas, rel=0.05)
    assert found.overall.std_px == pytest.approx(np.sqrt(np.mean(np.square(sigmas))), rel=0.05)


@pytest.mark.parametrize("people", [2, 3, 4, 8])
def test_few_people_do_not_make_the_noise_look_smaller(people: int) -> None:
    """Dividing by the number of people would give sqrt(1 - 1 / people) of it."""
    assert measure_agreement(*simulate([1.46] * people, 200)).overall.std_px == pytest.approx(1.46, rel=0.02)


def test_one_joint_marked_by_two_is_unbiased_too() -> None:
    found = []
    for seed in range(1000):
        points, marked = simulate([2.0, 2.0], 1, seed)
        points[:, :, 1:, 2] = 0
        found.append(measure_agreement(points, marked).joints[0].std_px)
    assert np.mean(found) == pytest.approx(2.0, rel=0.05)


def test_two_people_cannot_be_told_apart_and_share_what_they_have() -> None:
    found = measure_agreement(*simulate([1.0, 3.0], 400))
    assert [person.std_px for person in found.people] == pytest.approx([np.sqrt(5)] * 2, rel=0.05)


def test_noise_is_found_by_joint_and_by_state() -> None:
    points, marked = simulate([1.0, 1.0, 1.0], 600)
    rng = np.random.default_rng(3)
    points[:, :, 8, :2] += rng.normal(size=(3, 600, 2)) * np.sqrt(8)  # joint 8: 3 px in all
    points[:, :, 8, 2] = 1
    points[0, :, 12, 2] = 1  # about joint 12 they differ
    found = measure_agreement(points, marked)
    assert found.joints[8].std_px == pytest.approx(3, rel=0.05)
    assert found.joints[0].std_px == pytest.approx(1, rel=0.05)
    assert found.states["occluded"].std_px == pytest.approx(3, rel=0.05)
    assert found.states["visible"].std_px == pytest.approx(1, rel=0.05)
    assert found.states["mixed"].samples == 3 * 600
    assert [person["occluded"].std_px for person in found.people_states] == pytest.approx([3] * 3, rel=0.1)
    assert found.people_joints[1][8].std_px == pytest.approx(3, rel=0.1)
    assert found.joint_disagreement[8] == 0
    assert found.joint_disagreement[12] == pytest.approx(2 / 3)
    assert found.pairs[0].state_disagreement == pytest.approx(1 / 21)
    assert found.pairs[2].state_disagreement == 0


def test_a_habit_shows_as_a_bias() -> None:
    points, marked = simulate([1.0] * 4, 200)
    points[2, ..., :2] += [3.0, -2.0]
    bias = measure_agreement(points, marked).biases[2]
    assert (bias.x_px, bias.y_px) == (pytest.approx(3, abs=0.1), pytest.approx(-2, abs=0.1))


def test_similarity_is_that_of_coco() -> None:
    points, marked = simulate([0.0, 0.0], 1)
    points[1, ..., 0] += 4
    found = measure_agreement(points, marked)
    middle = points[..., :2].mean(axis=0)[0]
    area = float(np.prod(middle.max(axis=0) - middle.min(axis=0)))
    assert found.pairs[0].oks == pytest.approx(np.mean(np.exp(-16 / (2 * area * (2 * OKS_SIGMAS) ** 2))))
    assert found.pairs[0].mean_px == pytest.approx(4)
    assert measure_agreement(*simulate([0.0, 0.0], 5)).pairs[0].oks == 1


def test_nothing_in_common_is_said_as_nothing() -> None:
    points, marked = simulate([1.0, 1.0, 1.0], 4)
    marked[1:] = False
    found = measure_agreement(points, marked)
    assert found.overall.std_px is None
    assert {person.std_px for person in found.people} == {None}
    assert {pair.oks for pair in found.pairs} == {None}
    assert set(found.joint_disagreement) == {None}
    assert measure_agreement(points[:, :0], marked[:, :0]).overall.samples == 0


def test_people_who_agree_exactly_have_no_noise() -> None:
    found = measure_agreement(*simulate([0.0, 0.0, 0.0], 5))
    assert [found.overall.std_px, *(person.std_px for person in found.people)] == pytest.approx([0] * 4, abs=1e-9)
