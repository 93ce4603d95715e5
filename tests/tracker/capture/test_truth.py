"""A truth file comes back bit by bit; one that is damaged is refused with what is in it, never with a crash."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tracker.capture.truth import Truth, load_truth
from tracker.errors import SequenceError


def make_truth(moments: int = 3, cameras: int = 2, joints: int = 2, objects: int = 1) -> Truth:
    rng = np.random.default_rng(0)
    return Truth(
        frame=np.arange(moments),
        source_frame=np.arange(moments) * 7,
        joint_names=tuple(f"right/joint_{number}" for number in range(joints)),
        joints_3d=rng.normal(size=(moments, joints, 3)),
        joints_2d=rng.normal(size=(moments, cameras, joints, 2)),
        visibility=rng.integers(0, 3, (moments, cameras, joints)),
        object_names=tuple(f"ball_{number}" for number in range(objects)),
        T_world_object=rng.normal(size=(moments, objects, 4, 4)),
    )


def save_changed(path: Path, **changes: Any) -> Path:
    """A sound file but for some arrays; None takes one away."""
    make_truth().save(path)
    with np.load(path) as archive:
        arrays = {name: archive[name] for name in archive.files} | changes
    np.savez(path, **{name: value for name, value in arrays.items() if value is not None})
    return path


@pytest.mark.parametrize("sizes", [(3, 2, 2, 1), (1, 1, 21, 0), (0, 2, 2, 0), (2, 0, 0, 3)])
def test_what_is_saved_is_loaded_whatever_is_empty(tmp_path: Path, sizes: tuple[int, int, int, int]) -> None:
    truth = make_truth(*sizes)
    truth.save(tmp_path / "truth.npz")
    found = load_truth(tmp_path / "truth.npz")
    assert (found.joint_names, found.object_names) == (truth.joint_names, truth.object_names)
    for name in ("frame", "source_frame", "joints_3d", "joints_2d", "visibility", "T_world_object"):
        assert np.array_equal(getattr(found, name), getattr(truth, name)), name
        assert getattr(found, name).dtype == getattr(truth, name).dtype
    assert [entry.name for entry in tmp_path.iterdir()] == ["truth.npz"]


@pytest.mark.parametrize(
    "changes",
    [
        {"joints_3d": np.zeros((3, 2, 2))},
        {"joints_3d": np.zeros((2, 2, 3))},
        {"joints_2d": np.zeros((3, 2, 3, 2))},
        {"joints_2d": np.zeros(())},
        {"visibility": np.zeros((3, 1, 2), int)},
        {"T_world_object": np.zeros((3, 4, 4))},
        {"source_frame": np.zeros(2, int)},
        {"frame": np.zeros((), int)},
        {"joint_names": np.array("right/wrist")},
    ],
    ids=lambda changes: "-".join(f"{name}{np.shape(value)}" for name, value in changes.items()),
)
def test_arrays_that_do_not_match_are_refused_with_all_shapes(tmp_path: Path, changes: dict[str, np.ndarray]) -> None:
    path = save_changed(tmp_path / "truth.npz", **changes)
    with pytest.raises(SequenceError, match=r"truth\.npz: the shapes in it do not match: frame \(.*T_world_object \("):
        load_truth(path)


def test_fields_that_are_missing_are_named(tmp_path: Path) -> None:
    path = save_changed(tmp_path / "truth.npz", visibility=None, object_names=None)
    with pytest.raises(
        SequenceError, match=r"no visibility, object_names in it; a truth file holds frame, source_frame"
    ):
        load_truth(path)


@pytest.mark.parametrize("content", [b"", b"no archive", b"PK\x03\x04 cut off"])
def test_what_is_no_archive_is_refused_with_what_makes_one(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "truth.npz"
    path.write_bytes(content)
    with pytest.raises(SequenceError, match=r"truth\.npz: .* needed a truth file as `handloom synthesize` writes it"):
        load_truth(path)


def test_objects_in_the_file_are_not_unpickled(tmp_path: Path) -> None:
    path = save_changed(tmp_path / "truth.npz", joint_names=np.array([print], dtype=object))
    with pytest.raises(SequenceError, match=r"truth\.npz: "):
        load_truth(path)
    with pytest.raises(SequenceError, match=r"gone\.npz"):
        load_truth(tmp_path / "gone.npz")
