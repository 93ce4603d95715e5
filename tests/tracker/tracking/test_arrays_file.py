"""Arrays come back as they were written, those without dimensions too."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tracker.tracking.arrays_file import load_arrays, save_arrays


def test_arrays_come_back_with_their_shape_and_type(tmp_path: Path) -> None:
    arrays = {"number": np.array(7), "flag": np.array(True), "empty": np.zeros((0, 3)), "table": np.eye(3)[:, ::2]}
    save_arrays(tmp_path / "a.npz", arrays)
    found = load_arrays(tmp_path / "a.npz", tuple(arrays))
    for name, array in arrays.items():
        assert found[name].dtype == array.dtype
        assert found[name].shape == array.shape, name
        assert np.array_equal(found[name], array)
