"""Model files of every kind that Handloom reads, told apart by name and content."""

from __future__ import annotations

from pathlib import Path

from tracker.errors import ModelFileError
from tracker.model.articulated import ArticulatedModel
from tracker.model.gltf_container import read_gltf
from tracker.model.gltf_files import load_gltf_model
from tracker.model.npz_files import load_npz_model, save_npz_model
from tracker.model.object_files import OBJECT_SUFFIXES, is_skinned, load_object
from tracker.model.t16_files import load_t16_model

KINDS = (
    "Handloom's .npz, a skinned hand in .glb or .gltf, a T16 model's .OFF with .SKEL, .SKIN and .LIMITS beside it, or "
    "a rigid object in .obj, .ply, .stl, .off, .glb or .gltf"
)

MAX_FACES = 1500
"""Heavier meshes are decimated to so many faces when they are loaded for tracking."""


def load_model(path: Path, max_faces: int | None = MAX_FACES, metres_per_unit: float | None = None) -> ArticulatedModel:
    """A hand or object model from a file of any kind in KINDS.

    An .OFF is a T16 model when one of that model's other files lies beside it; a glTF is a hand when it has a skin.

    Args:
        path: The file.
        max_faces: Decimate a heavier mesh to so many faces; None keeps it. Our .npz is taken as it is.
        metres_per_unit: Unit of a rigid object's file; guessed from its size when left out. Other kinds know theirs.

    Raises:
        ModelFileError: Of no such kind, or not usable; says what was found and what is needed.
    """
    path = Path(path)
    if not path.is_file():
        raise ModelFileError(path, "no such file", KINDS)
    suffix = path.suffix.lower()
    if suffix == ".npz":
        return load_npz_model(path)
    if suffix == ".off" and any(path.with_suffix(other).is_file() for other in (".SKEL", ".SKIN", ".LIMITS")):
        return load_t16_model(path, max_faces)
    if suffix in (".glb", ".gltf") and is_skinned(read_gltf(path)):
        return load_gltf_model(path, max_faces)
    if suffix in OBJECT_SUFFIXES:
        return load_object(path, max_faces, metres_per_unit)
    if suffix == ".pkl":
        raise ModelFileError(path, "a pickle, perhaps of MANO or SMPL-H, which this version cannot read yet", KINDS)
    raise ModelFileError(path, f"the suffix {path.suffix[:20]!r}", KINDS)


def save_model(model: ArticulatedModel, path: Path) -> None:
    """Write a model to Handloom's .npz."""
    save_npz_model(model, Path(path))
