"""Arrays for the browser come back as they went, and the same points are chosen each time."""

from __future__ import annotations

import numpy as np
import pytest

from server.scans.geometry import ALIGNMENT, choose_points, pack_arrays, pack_scan, quantise
from tests.server.packed_arrays import unpack_arrays

DIGEST = "0123456789abcdef" * 4


@pytest.mark.parametrize("kind", ["uint8", "int8", "uint16", "uint32", "float32"])
@pytest.mark.parametrize("shape", [(0, 3), (1,), (7, 3), (5, 2, 2)])
def test_arrays_and_members_come_back(kind: str, shape: tuple[int, ...]) -> None:
    array = np.arange(np.prod(shape)).reshape(shape).astype(kind)
    arrays, members = unpack_arrays(pack_arrays({"a": array, "b": array[:0]}, {"unit": "m", "count": 3}))
    assert members == {"unit": "m", "count": 3}
    assert arrays["a"].dtype == np.dtype(kind) and np.array_equal(arrays["a"], array) and arrays["b"].size == 0


def test_every_array_begins_at_a_multiple_of_eight() -> None:
    data = pack_arrays({"a": np.zeros(3, np.uint8), "b": np.ones(1, np.float32)}, {"name": "ä"})
    header = int.from_bytes(data[4:8], "little")
    assert (8 + header) % ALIGNMENT == 0 and len(data) % ALIGNMENT == 0
    assert unpack_arrays(data)[0]["b"].tolist() == [1.0]


def test_big_endian_arrays_are_sent_as_all_others() -> None:
    array = np.array([1, 256], dtype=">u2")
    assert unpack_arrays(pack_arrays({"a": array}, {}))[0]["a"].tolist() == [1, 256]


def test_positions_of_a_hand_are_kept_to_three_micrometres(rng: np.random.Generator) -> None:
    points = rng.uniform(-0.1, 0.1, (1000, 3))
    numbers, box = quantise(points)
    back = np.array(box["origin_m"]) + np.array(box["step_m"]) * numbers
    assert numbers.dtype == np.uint16 and np.abs(back - points).max() < 3.1e-6


def test_one_point_and_none_are_no_special_case() -> None:
    numbers, box = quantise(np.array([[1.0, 2.0, 3.0]]))
    assert np.allclose(np.array(box["origin_m"]) + np.array(box["step_m"]) * numbers, [[1, 2, 3]])
    assert quantise(np.zeros((0, 3)))[0].shape == (0, 3)


def test_fewer_points_are_the_beginning_of_more_and_another_file_has_others() -> None:
    many = choose_points(1000, 500, DIGEST)
    assert np.array_equal(choose_points(1000, 100, DIGEST), many[:100]) and len(set(many.tolist())) == 500
    assert sorted(choose_points(10, 50, DIGEST).tolist()) == list(range(10))
    assert not np.array_equal(choose_points(1000, 100, DIGEST[::-1]), many[:100])


def test_a_scan_is_sent_with_what_belongs_to_each_point(rng: np.random.Generator) -> None:
    points, colors = rng.uniform(-0.1, 0.1, (50, 3)), rng.integers(0, 255, (50, 3)).astype(np.uint8)
    normals = np.tile([0.0, 0.6, -0.8], (50, 1))
    flags = np.arange(50).astype(np.uint8) % 3
    arrays, members = unpack_arrays(pack_scan(points, normals, colors, flags, 20, DIGEST))
    chosen = choose_points(50, 20, DIGEST)
    assert members["point_count"] == 50 and np.array_equal(arrays["colors"], colors[chosen])
    assert np.array_equal(arrays["flags"], flags[chosen]) and arrays["normals"][0].tolist() == [0, 76, -102]
    assert "colors" not in unpack_arrays(pack_scan(points, normals, None, flags, 20, DIGEST))[0]
