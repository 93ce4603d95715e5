"""Paired differences and their intervals, and what of a rendered hand and cube counts as carried and as lying."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from benchmarks.studies.as_written import DATA, compare
from benchmarks.studies.held import find_carried_frames, find_lying_side
from tests.tracker.grips import ball, cube
from tracker.geometry import se3
from tracker.synthesis.actor import Actor


def run_of(px, hands=1):
    return {"frame_px": list(px), "hands": hands}


def test_a_difference_in_every_frame_is_certain_and_noise_about_nothing_is_not(rng):
    before = rng.uniform(1.0, 2.0, size=120)
    assert compare([run_of(before - 0.2)], [run_of(before)]) == pytest.approx((-0.2, -0.2, -0.2))
    mean, low, high = compare([run_of(before + rng.normal(scale=0.3, size=120))], [run_of(before)])
    assert low < 0.0 < high and low < mean < high


def test_frames_count_by_their_hands():
    one, two = run_of(np.ones(20)), run_of(3.0 * np.ones(20), hands=2)
    nothing = run_of(np.zeros(20)), run_of(np.zeros(20), hands=2)
    assert compare([one, two], list(nothing))[0] == pytest.approx(7.0 / 3.0)


def moved(model, *places) -> Actor:
    """An actor that stands at these places (3,), m, turned by 0.4 rad about the camera's x."""
    T = [se3.exp(np.array([0.0, 0.0, 0.0, 0.4, 0.0, 0.0])) for _ in places]
    Ms = np.array([[np.column_stack([turned[:3, :3], place])] for turned, place in zip(T, places, strict=True)])
    return Actor(model.name, model, Ms, (0.5, 0.5, 0.5))


def test_a_cube_lies_on_its_lowest_side_and_a_ball_on_none():
    down = find_lying_side(moved(cube(), [0.0, 0.0, 0.5]))
    np.testing.assert_allclose(down, [0.0, np.cos(0.4), np.sin(0.4)], atol=1e-9)
    assert find_lying_side(moved(ball(), [0.0, 0.0, 0.5])) is None


def test_an_object_is_carried_where_it_rests_neither_before_nor_after():
    places = [[0.0, 0.0, 0.5]] * 12 + [[0.02 * k, -0.03, 0.5] for k in range(1, 5)] + [[0.1, 0.0, 0.5]] * 12
    actor = moved(cube(), *places)
    truth = SimpleNamespace(source_frame=np.arange(len(places)), frame=np.arange(len(places)))
    twin = SimpleNamespace(performance=SimpleNamespace(objects=(actor,)), truth=truth)
    assert find_carried_frames(twin) == [12, 13, 14, 15]


def test_the_variants_of_the_papers_terms_differ_in_what_they_say():
    assert set(DATA["m2d"]) | set(DATA["d2m"]) == set(DATA["both"])
    assert DATA["any edge"]["data_to_model"].max_angle == 180.0 != DATA["both"]["data_to_model"].max_angle
    assert not DATA["every pixel"]["data_to_model"].at_vertices
