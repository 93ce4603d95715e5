"""A blend model's own file gives it back to the last bit, and bad files are refused with the facts."""

from __future__ import annotations

import numpy as np
import pytest

from tests.tracker.random_blend import random_blend
from tracker.errors import ModelFileError
from tracker.model.blend_files import load_blend_model, save_blend_model
from tracker.model.npz_arrays import read_npz_arrays
from tracker.model.npz_files import write_npz_arrays

ARRAYS = (
    *("template", "faces", "shape_directions", "pose_directions", "skinning_weights", "parents"),
    *("pose_mean", "pose_components", "tips"),
)


def test_a_model_comes_back_to_the_last_bit(tmp_path):
    model = random_blend()
    save_blend_model(model, tmp_path / "hand.npz")
    loaded = load_blend_model(tmp_path / "hand.npz")
    for name in ARRAYS:
        np.testing.assert_array_equal(getattr(loaded, name), getattr(model, name))
    np.testing.assert_array_equal(loaded.joint_regressor.toarray(), model.joint_regressor.toarray())
    assert (loaded.name, loaded.side, loaded.joint_names) == (model.name, model.side, model.joint_names)
    assert loaded.provenance == model.provenance
    save_blend_model(loaded, tmp_path / "again.npz")
    assert (tmp_path / "again.npz").read_bytes() == (tmp_path / "hand.npz").read_bytes()


@pytest.mark.parametrize(
    ("name", "change", "message"),
    [
        ("side", lambda a: np.array(["both"]), "side 'both'"),
        ("parents", lambda a: np.r_[a[:-1], 15], "one tree"),
        ("template", lambda a: a * np.nan, "'template'"),
        ("template", lambda a: a[:, :2], "'template'"),
        ("faces", lambda a: a + 5000, "'faces'"),
        ("skinning_weights", lambda a: a * 0.5, "sum to one"),
        ("pose_directions", lambda a: a[:, :, :-1], "'pose_directions'"),
        ("regressor_columns", lambda a: a - 50, "'regressor_columns'"),
        ("tips", lambda a: a[:4], "'tips'"),
        ("format", lambda a: np.array(["handloom-model", "1"]), "handloom-blend-model 1"),
        ("provenance", lambda a: np.array(["[1"]), "needed a provenance that is a JSON object"),
    ],
)
def test_a_wrong_array_is_named(tmp_path, name, change, message):
    path = tmp_path / "hand.npz"
    save_blend_model(random_blend(num_shape=2), path)
    arrays = read_npz_arrays(path)
    write_npz_arrays(path, {**arrays, name: change(arrays[name])})
    with pytest.raises(ModelFileError, match=message):
        load_blend_model(path)


def test_a_missing_array_is_named(tmp_path):
    path = tmp_path / "hand.npz"
    save_blend_model(random_blend(num_shape=2), path)
    arrays = read_npz_arrays(path)
    del arrays["tips"]
    write_npz_arrays(path, arrays)
    with pytest.raises(ModelFileError, match="no 'tips'"):
        load_blend_model(path)
