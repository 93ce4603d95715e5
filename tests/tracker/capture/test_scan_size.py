"""Which unit a scan may be in, from its longest side alone; and lengths as people read them."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from tracker.capture.scan_size import (
    HAND_LENGTHS,
    UNITS,
    find_possible_units,
    find_size_fault,
    is_certain,
    measure_size,
    write_length,
)

LENGTHS = st.floats(1e-4, 1e4)


def box(rng: np.random.Generator, sides: tuple[float, float, float], count: int = 4000) -> np.ndarray:
    return rng.uniform(-0.5, 0.5, (count, 3)) * sides


@pytest.mark.parametrize("turn", [(0, 0, 0), (0.3, -1.0, 0.7), (0, np.pi, 0)])
def test_sides_are_measured_longest_first_wherever_and_however_the_box_stands(
    rng: np.random.Generator, turn: tuple[float, ...]
) -> None:
    points = box(rng, (3.0, 20.0, 8.0)) @ Rotation.from_rotvec(turn).as_matrix().T + [100.0, -50.0, 7.0]
    assert measure_size(points) == pytest.approx([20.0, 8.0, 3.0], rel=0.03)
    assert measure_size(1000 * points) == pytest.approx(1000 * measure_size(points))


def test_one_point_in_two_hundred_that_is_astray_does_not_count(rng: np.random.Generator) -> None:
    points = box(rng, (3.0, 20.0, 8.0))
    astray = points.copy()
    astray[:10] = [0.0, 40.0, 0.0]
    assert measure_size(astray)[0] == pytest.approx(20.0, rel=0.03)


def test_a_sheet_and_a_point_have_sides_of_zero() -> None:
    sheet = np.array([[x, y, 0.0] for x in range(10) for y in range(5)])
    assert measure_size(sheet)[2] == pytest.approx(0.0, abs=1e-9)
    assert measure_size(np.ones((1, 3))).tolist() == [0.0, 0.0, 0.0]


@settings(max_examples=40)
@given(LENGTHS)
def test_a_unit_is_possible_when_the_hand_in_it_has_no_fault(length: float) -> None:
    possible = find_possible_units(length)
    assert possible == {name: m for name, m in UNITS.items() if find_size_fault(length * m) is None}
    if is_certain(length):
        assert list(possible) in (["m"], ["mm"])


@settings(max_examples=40)
@given(st.floats(*HAND_LENGTHS))
def test_a_hand_in_metres_or_millimetres_is_certain_and_of_no_other_unit(length_m: float) -> None:
    for name in ("m", "mm"):
        length = length_m / UNITS[name]
        if HAND_LENGTHS[0] <= length * UNITS[name] <= HAND_LENGTHS[1]:  # but for rounding at the limits
            assert is_certain(length) and find_possible_units(length) == {name: UNITS[name]}


def test_between_centimetres_and_inches_nothing_is_certain() -> None:
    assert find_possible_units(18.0) == {"cm": 0.01, "inch": 0.0254} and not is_certain(18.0)
    assert find_possible_units(50.0) == {"cm": 0.01} and not is_certain(50.0), "alone, but to be confirmed"
    assert find_possible_units(5.0) == {"inch": 0.0254} and find_possible_units(2.0) == {}


@pytest.mark.parametrize(
    ("length", "longest", "fault"),
    [
        (0.08, 0.6, None),
        (0.6, 0.6, None),
        (0.0799, 0.6, "is 7.99 cm long"),
        (0.61, 0.6, "is 61 cm long"),
        (0.61, 3.0, None),
        (3.5, 3.0, "is 3.5 m long"),
        (float("nan"), 0.6, "is nan mm long"),
    ],
)
def test_a_length_that_no_hand_has_is_told(length: float, longest: float, fault: str | None) -> None:
    assert find_size_fault(length, longest) == fault


@pytest.mark.parametrize(
    ("metres", "said"),
    [(0.184, "18.4 cm"), (1.0, "1 m"), (12.345, "12.3 m"), (0.01, "1 cm"), (0.0099, "9.9 mm"), (0.0, "0 mm")],
)
def test_lengths_are_written_in_the_unit_that_reads_best(metres: float, said: str) -> None:
    assert write_length(metres) == said
