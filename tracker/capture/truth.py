"""What is exactly known of a synthetic recording: `truth.npz`."""

from __future__ import annotations

import io
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from tracker.capture.atomic_file import write_atomically
from tracker.errors import SequenceError, reading

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Truth:
    """Joints and objects of every frame; fields as in `track.npz` where that has them.

    Attributes:
        frame: (T,) frame of the recording.
        source_frame: (T,) frame of the motion that was rendered.
        joint_names: (J,) such as `right/index_mcp`.
        joints_3d: (T, J, 3) world, m.
        joints_2d: (T, C, J, 2) px.
        visibility: (T, C, J) 0 outside the image, 1 occluded, 2 visible.
        object_names: (O,).
        T_world_object: (T, O, 4, 4) coordinates of the object's file to world, m.
    """

    frame: npt.NDArray[np.int64]
    source_frame: npt.NDArray[np.int64]
    joint_names: tuple[str, ...]
    joints_3d: Array
    joints_2d: Array
    visibility: npt.NDArray[np.int64]
    object_names: tuple[str, ...]
    T_world_object: Array

    def __post_init__(self) -> None:
        moments, joints, objects = len(self.frame), len(self.joint_names), len(self.object_names)
        assert len(self.source_frame) == moments
        assert self.joints_3d.shape == (moments, joints, 3)
        assert self.joints_2d.shape[:1] == (moments,) and self.joints_2d.shape[2:] == (joints, 2)
        assert self.visibility.shape == self.joints_2d.shape[:3]
        assert self.T_world_object.shape == (moments, objects, 4, 4)

    def save(self, path: Path) -> None:
        """Write all fields to an npz file."""
        arrays: dict[str, Any] = {field.name: np.asarray(getattr(self, field.name)) for field in fields(self)}
        content = io.BytesIO()
        np.savez_compressed(content, **arrays)
        write_atomically(path, content.getvalue())


def load_truth(path: Path) -> Truth:
    """Read a `truth.npz`."""
    needed = [field.name for field in fields(Truth)]
    made_by = "a truth file as `handloom synthesize` writes it"
    with reading(SequenceError, path, made_by), np.load(path, allow_pickle=False) as archive:
        missing = [name for name in needed if name not in archive]
        if missing:
            raise SequenceError(f"{path}: no {', '.join(missing)} in it; a truth file holds {', '.join(needed)}.")
        values = {name: archive[name] for name in needed}
    for name in ("joint_names", "object_names"):
        values[name] = tuple(str(item) for item in np.ravel(values[name]))
    try:
        assert values["frame"].ndim == values["source_frame"].ndim == 1
        return Truth(**values)
    except AssertionError as error:
        shapes = ", ".join(f"{name} {np.shape(value)}" for name, value in values.items())
        raise SequenceError(f"{path}: the shapes in it do not match: {shapes}.") from error
