"""Handloom's own model file: one .npz that holds everything of an ArticulatedModel, to the last bit."""

from __future__ import annotations

import io
import json
import os
import threading
import zipfile
from pathlib import Path

import numpy as np

from tracker.errors import ModelFileError, reading, reads
from tracker.model.articulated import ArticulatedModel, HandParts, ShapeBasis
from tracker.model.joints import FINGERS, HAND_JOINTS
from tracker.model.npz_arrays import NpzFields, read_npz_arrays
from tracker.model.pose_blend import PoseBlend
from tracker.model.skeleton import Array, Skeleton
from tracker.model.skinning import MAX_WEIGHTS

FORMAT = "handloom-model"
VERSION = "1"
MAX_COORDINATE = 100.0
"""m; a bound of ours."""
MAX_ANGLE = 8.0
"""rad; a bound of ours, more than a whole turn."""


def save_npz_model(model: ArticulatedModel, path: Path) -> None:
    """Write a model; the file appears whole or not at all. Equal models give equal bytes."""
    path = Path(path)
    skeleton = model.skeleton
    arrays = {
        "format": np.array([FORMAT, VERSION]),
        "name": np.array([model.name]),
        "provenance": np.array([json.dumps(model.provenance, ensure_ascii=False)]),
        "vertices": model.vertices,
        "faces": model.faces,
        "skinning_weights": model.skinning_weights,
        "bone_names": np.array(skeleton.bone_names),
        "parents": skeleton.parents,
        "Ts_model_bone": skeleton.Ts_model_bone,
        "dof_bones": skeleton.dof_bones,
        "dof_axes": skeleton.dof_axes,
        "lower": skeleton.lower,
        "upper": skeleton.upper,
    }
    if model.hand is not None:
        hand = model.hand
        sets = [*hand.fingertips, *hand.finger_parts.values()]
        arrays |= {
            "hand_side": np.array([hand.side]),
            "hand_joint_bones": hand.joint_bones,
            "hand_joint_vertices": hand.joint_vertices,
            "hand_part_names": np.array(list(hand.finger_parts) or [""])[: len(hand.finger_parts)],
            "hand_set_sizes": np.array([len(ids) for ids in sets]),
            "hand_set_vertices": np.concatenate([np.zeros(0, dtype=np.int64), *sets]),
        }
        if np.any(hand.joint_offsets):
            arrays["hand_joint_offsets"] = hand.joint_offsets
    if model.shape is not None:
        arrays |= {
            "shape_names": np.array(model.shape.names),
            "shape_vertices": model.shape.vertices,
            "shape_joints": model.shape.joints,
            "shape_lower": model.shape.lower,
            "shape_upper": model.shape.upper,
        }
    if model.pose_blend is not None:
        arrays |= {"blend_bones": model.pose_blend.bones, "blend_directions": model.pose_blend.directions}
    write_npz_arrays(path, arrays)


@reads(ModelFileError, "a hand model as Handloom writes it")
def load_npz_model(path: Path) -> ArticulatedModel:
    """Read a model that `save_npz_model` wrote, checking every array of it.

    Raises:
        ModelFileError: With what was found and what is needed.
    """
    path = Path(path)
    return read_npz_model(NpzFields(path, read_npz_arrays(path)))


def read_npz_model(fields: NpzFields) -> ArticulatedModel:
    """A model from the arrays of its file."""
    path = fields.path
    form = fields.texts("format", 2)
    if form != (FORMAT, VERSION):
        raise ModelFileError(path, f"format {' '.join(form)[:60]}", f"{FORMAT} {VERSION}")
    vertices = fields.floats("vertices", (-1, 3), MAX_COORDINATE)
    bone_names = fields.texts("bone_names", -1)
    return ArticulatedModel(
        name=fields.texts("name", 1)[0],
        vertices=vertices,
        faces=fields.integers("faces", (-1, 3), 0, len(vertices)),
        skinning_weights=_read_weights(fields, len(vertices), len(bone_names)),
        skeleton=_read_skeleton(fields, bone_names),
        hand=_read_hand(fields, len(vertices), len(bone_names)) if "hand_side" in fields else None,
        shape=_read_shape(fields, len(vertices), len(bone_names)) if "shape_names" in fields else None,
        provenance=read_provenance(fields),
        pose_blend=_read_blend(fields, len(vertices), len(bone_names)) if "blend_bones" in fields else None,
    )


def write_npz_arrays(path: Path, arrays: dict[str, np.ndarray]) -> None:
    """Write arrays as float64, int64 and text; the file appears whole or not at all. Equal arrays give equal bytes."""
    kinds = {"f": "<f8", "i": "<i8"}
    write_plain_npz(path, {name: a.astype(kinds.get(a.dtype.kind, a.dtype)) for name, a in arrays.items()})


def write_plain_npz(path: Path, arrays: dict[str, np.ndarray]) -> None:
    """Write arrays as they are; the file appears whole or not at all. Equal arrays give equal bytes."""
    temporary = path.with_name(f".{path.name}.{os.getpid()}.{threading.get_ident()}.tmp")
    try:
        with temporary.open("wb") as file:
            file.write(pack_npz(arrays, 6))
            file.flush()
            os.fsync(file.fileno())
        os.replace(temporary, path)
    finally:
        temporary.unlink(missing_ok=True)


def pack_npz(arrays: dict[str, np.ndarray], level: int = 1) -> bytes:
    """The bytes of an .npz, compressed at a level of 1 to 9. Equal arrays give equal bytes: no times are stored."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, array in arrays.items():
            entry = zipfile.ZipInfo(f"{name}.npy", date_time=(1980, 1, 1, 0, 0, 0))
            entry.compress_type = zipfile.ZIP_DEFLATED
            content = io.BytesIO()
            np.lib.format.write_array(content, np.asarray(array, order="C"), allow_pickle=False)
            archive.writestr(entry, content.getvalue(), compresslevel=level)
    return buffer.getvalue()


def _read_weights(fields: NpzFields, num_vertices: int, num_bones: int) -> Array:
    weights = fields.floats("skinning_weights", (num_vertices, num_bones), 1.0 + 1e-9)
    sums = weights.sum(axis=1)
    if weights.size and (weights.min() < 0.0 or np.abs(sums - 1.0).max() > 1e-6):
        raise ModelFileError(fields.path, "skinning weights that do not sum to one", "rows >= 0 that sum to one")
    if np.sum(weights > 0.0, axis=1).max(initial=0) > MAX_WEIGHTS:
        raise ModelFileError(
            fields.path, "vertices that follow too many bones", f"at most {MAX_WEIGHTS} bones a vertex"
        )
    return weights


def _read_skeleton(fields: NpzFields, bone_names: tuple[str, ...]) -> Skeleton:
    path, bones = fields.path, len(bone_names)
    parents = fields.integers("parents", (bones,), -1, max(bones, 1))
    if bones == 0 or np.any(parents >= np.arange(bones)) or np.sum(parents < 0) != 1:
        raise ModelFileError(path, "bones that do not form one tree in order", "one root, parents before children")
    Ts = fields.floats("Ts_model_bone", (bones, 4, 4), MAX_COORDINATE)
    R = Ts[:, :3, :3]
    orthogonal = np.abs(np.einsum("bij,bkj->bik", R, R) - np.eye(3)).max() < 1e-5
    if not orthogonal or np.linalg.det(R).min() < 0 or np.any(Ts[:, 3] != [0.0, 0.0, 0.0, 1.0]):
        raise ModelFileError(path, "rest poses that are not rigid motions", "4x4 rigid motions")
    dof_bones = fields.integers("dof_bones", (-1,), 0, bones)
    dofs = len(dof_bones)
    axes = fields.floats("dof_axes", (dofs, 3), 1.0 + 1e-6)
    if dofs and np.abs(np.linalg.norm(axes, axis=1) - 1.0).max() > 1e-6:
        raise ModelFileError(path, "joint axes that are not of length 1", "unit axes")
    lower = fields.floats("lower", (dofs,), MAX_ANGLE)
    upper = fields.floats("upper", (dofs,), MAX_ANGLE)
    if np.any(lower > upper):
        raise ModelFileError(path, "a lower limit above its upper limit", "lower <= upper")
    return Skeleton(bone_names, parents, Ts, dof_bones, axes, lower, upper)


def _read_hand(fields: NpzFields, num_vertices: int, num_bones: int) -> HandParts:
    path = fields.path
    side = fields.texts("hand_side", 1)[0]
    if side not in ("right", "left"):
        raise ModelFileError(path, f"hand side {side[:40]!r}", "right or left")
    count = len(HAND_JOINTS)
    joint_bones = fields.integers("hand_joint_bones", (count,), -1, num_bones)
    joint_vertices = fields.integers("hand_joint_vertices", (count,), -1, num_vertices)
    if np.any((joint_bones < 0) == (joint_vertices < 0)):
        raise ModelFileError(path, "a hand joint with neither or both of bone and vertex", "one of them for each joint")
    names = fields.texts("hand_part_names", -1)
    sizes = fields.integers("hand_set_sizes", (len(FINGERS) + len(names),), 0, num_vertices + 1)
    ids = fields.integers("hand_set_vertices", (int(sizes.sum()),), 0, num_vertices)
    sets = np.split(ids, np.cumsum(sizes)[:-1])
    parts = dict(zip(names, sets[len(FINGERS) :], strict=True))
    has_offsets = "hand_joint_offsets" in fields
    offsets = fields.floats("hand_joint_offsets", (count, 3), MAX_COORDINATE) if has_offsets else np.zeros((count, 3))
    return HandParts(side, joint_bones, joint_vertices, tuple(sets[: len(FINGERS)]), parts, offsets)


def _read_shape(fields: NpzFields, num_vertices: int, num_bones: int) -> ShapeBasis:
    names = fields.texts("shape_names", -1)
    count = len(names)
    lower = fields.floats("shape_lower", (count,), 1e3)
    upper = fields.floats("shape_upper", (count,), 1e3)
    if np.any(lower > 0.0) or np.any(upper < 0.0):
        raise ModelFileError(fields.path, "shape bounds that leave the mean out", "lower <= 0 <= upper")
    vertices = fields.floats("shape_vertices", (count, num_vertices, 3), MAX_COORDINATE)
    joints = fields.floats("shape_joints", (count, num_bones, 3), MAX_COORDINATE)
    return ShapeBasis(names, vertices, joints, lower, upper)


def _read_blend(fields: NpzFields, num_vertices: int, num_bones: int) -> PoseBlend:
    bones = fields.integers("blend_bones", (-1,), 1, num_bones)
    directions = fields.floats("blend_directions", (num_vertices, 3, 9 * len(bones)), MAX_COORDINATE)
    if "hand_side" not in fields or len(set(bones.tolist())) != len(bones):
        found = "pose blend shapes of no hand, or of one bone twice"
        raise ModelFileError(fields.path, found, "those of a hand's bones")
    return PoseBlend(bones, directions)


def read_provenance(fields: NpzFields) -> dict[str, str]:
    """Where a model came from."""
    with reading(ModelFileError, fields.path, "a provenance that is a JSON object of texts"):
        provenance = json.loads(fields.texts("provenance", 1)[0])
    if not isinstance(provenance, dict) or not all(isinstance(value, str) for value in provenance.values()):
        raise ModelFileError(fields.path, "a provenance that is not an object of texts", "a JSON object of texts")
    return provenance
