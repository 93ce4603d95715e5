"""An object that the hands of a recording handle."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from tracker.capture.calibration import check_rigid
from tracker.capture.document import Node
from tracker.capture.relative_path import find_path_fault

Array = npt.NDArray[np.float64]


UNIT_LIMITS = (1e-6, 1e3)
"""m; lengths that the unit of a model file may have."""


@dataclass(frozen=True, eq=False)
class RecordedObject:
    """An object's model and, if somebody placed it, where it is in the first frame.

    Attributes:
        name: Its name.
        model: Path of the model file, relative to the recording.
        T_world_object: (4, 4) the model file's coordinates to world, m, or None.
        joints: Bone to (3,) world, m; empty when it is not articulated or nobody placed it.
        metres_per_unit: Length of the model file's unit, or None when the file knows it or nobody said it.
    """

    name: str
    model: str
    T_world_object: Array | None = None
    joints: dict[str, Array] = field(default_factory=dict)
    metres_per_unit: float | None = None

    def to_json(self) -> dict:
        """Its entry in `sequence.json`."""
        entry: dict = {"name": self.name, "model": self.model}
        if self.metres_per_unit is not None:
            entry["metres_per_unit"] = self.metres_per_unit
        initial: dict = {}
        if self.T_world_object is not None:
            initial["T_world_object"] = np.asarray(self.T_world_object, dtype=np.float64).tolist()
        if self.joints:
            initial["joints"] = {bone: np.asarray(p, dtype=np.float64).tolist() for bone, p in self.joints.items()}
        return entry | ({"initial": initial} if initial else {})


def parse_object(node: Node) -> RecordedObject:
    """An object from its entry in `sequence.json`."""
    name, model = node.get("name").text(100), node.get("model").text(1024)
    fault = find_path_fault(model)
    if fault:
        raise node.error(f"{node.file}: {node.where}.model {model!r} {fault}.")
    unit = node.get("metres_per_unit").number(*UNIT_LIMITS) if node.has("metres_per_unit") else None
    T, joints = None, {}
    if node.has("initial"):
        initial = node.get("initial")
        if initial.has("T_world_object"):
            T = initial.get("T_world_object").matrix(4, 4)
            check_rigid(f"{node.file}: {node.where}.initial.T_world_object", T)
        if initial.has("joints"):
            bones = initial.get("joints")
            if len(bones.members()) > 1000:
                bones.fail("at most 1000 bones")
            for bone in bones.members():
                point = bones.get(bone).vector(3, 1000.0)
                if point.shape != (3,):
                    bones.get(bone).fail("three numbers, m")
                joints[bone] = point
    return RecordedObject(name, model, T, joints, unit)
