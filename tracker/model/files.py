"""Model files of every kind that Handloom reads, told apart by name and content."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tracker.errors import ModelFileError
from tracker.model.articulated import ArticulatedModel
from tracker.model.blend_articulated import articulated_of
from tracker.model.blend_files import BLEND_FORMAT, read_blend_fields
from tracker.model.blend_model import BLEND_PARENTS, BlendModel
from tracker.model.gltf_container import read_gltf
from tracker.model.gltf_files import load_gltf_model
from tracker.model.mano_conventions import ManoConvention
from tracker.model.mano_files import is_mano_npz, load_mano
from tracker.model.max_faces import MAX_FACES
from tracker.model.npz_arrays import NpzFields, list_npz_arrays, read_npz_arrays
from tracker.model.npz_files import read_npz_model, save_npz_model
from tracker.model.object_files import OBJECT_SUFFIXES, ObjectSize, is_skinned, load_object, measure_object
from tracker.model.t16_files import load_t16_model

KINDS = (
    "Handloom's .npz, MANO's .pkl or .npz, a skinned hand in .glb or .gltf, a T16 model's .OFF with .SKEL, .SKIN and "
    ".LIMITS beside it, or a rigid object in .obj, .ply, .stl, .off, .glb or .gltf"
)

TRACKED = ManoConvention(tips="manopth", fix_left_shape=True)
"""How a MANO file is read for tracking: no coefficients are compared, so the fault of the left hand is corrected."""


def load_model(path: Path, max_faces: int | None = MAX_FACES, metres_per_unit: float | None = None) -> ArticulatedModel:
    """A hand or object model from a file of any kind in KINDS.

    An .OFF is a T16 model when one of that model's other files lies beside it; a glTF is a hand when it has a skin.

    Args:
        path: The file.
        max_faces: Decimate a heavier mesh to so many faces; None keeps it. Our .npz and MANO's files stay as they are.
        metres_per_unit: Unit of a rigid object's file; guessed from its size when left out. Other kinds know theirs.

    Raises:
        ModelFileError: Of no such kind, or not usable; says what was found and what is needed.
    """
    path = Path(path)
    if not path.is_file():
        raise ModelFileError(path, "no such file", KINDS)
    suffix = path.suffix.lower()
    if suffix == ".npz":
        return _load_npz(path)
    if _is_t16(path):
        return load_t16_model(path, max_faces)
    if suffix in (".glb", ".gltf") and is_skinned(read_gltf(path)):
        return load_gltf_model(path, max_faces)
    if suffix in OBJECT_SUFFIXES:
        return load_object(path, max_faces, metres_per_unit)
    if suffix == ".pkl":
        return _follow(load_mano(path, convention=TRACKED), path)
    raise ModelFileError(path, f"the suffix {path.suffix[:20]!r}", KINDS)


def measure_model(path: Path) -> ObjectSize | None:
    """The size of a rigid object's mesh, in the file's unit; None of a model that knows its unit."""
    suffix = path.suffix.lower()
    if suffix not in OBJECT_SUFFIXES or _is_t16(path) or (suffix in (".glb", ".gltf") and is_skinned(read_gltf(path))):
        return None
    return measure_object(path)


def _is_t16(path: Path) -> bool:
    return path.suffix.lower() == ".off" and any(
        path.with_suffix(other).is_file() for other in (".SKEL", ".SKIN", ".LIMITS")
    )


def _load_npz(path: Path) -> ArticulatedModel:
    if is_mano_npz(list_npz_arrays(path)):
        return _follow(load_mano(path, convention=TRACKED), path)
    fields = NpzFields(path, read_npz_arrays(path))
    if fields.texts("format", 2)[0] == BLEND_FORMAT[0]:
        return _follow(read_blend_fields(fields), path)
    return read_npz_model(fields)


def _follow(model: BlendModel, path: Path) -> ArticulatedModel:
    if model.side == "body" or model.num_bones != len(BLEND_PARENTS) or np.any(model.parents != BLEND_PARENTS):
        raise ModelFileError(path, f"a model of {model.num_bones} joints", "a hand of MANO's 16 joints")
    return articulated_of(model)


def save_model(model: ArticulatedModel, path: Path) -> None:
    """Write a model to Handloom's .npz."""
    save_npz_model(model, Path(path))
