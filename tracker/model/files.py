"""Model files of every kind that Handloom reads, told apart by name and content."""

from __future__ import annotations

from pathlib import Path

from tracker.errors import ModelFileError
from tracker.model.articulated import ArticulatedModel
from tracker.model.gltf_files import load_gltf_model
from tracker.model.npz_files import load_npz_model, save_npz_model
from tracker.model.t16_files import load_t16_model

KINDS = (
    "Handloom's .npz, a skinned hand in .glb or .gltf, or a T16 model's .OFF with .SKEL, .SKIN and .LIMITS beside it"
)

MAX_FACES = 1500
"""Heavier meshes are decimated to so many faces when they are loaded for tracking."""


def load_model(path: Path, max_faces: int | None = MAX_FACES) -> ArticulatedModel:
    """A hand or object model from a file of any kind in KINDS.

    Args:
        path: The file.
        max_faces: Decimate a heavier glTF or T16 mesh to so many faces; None keeps it. Our .npz is taken as it is.

    Raises:
        ModelFileError: Of no such kind, or not usable; says what was found and what is needed.
    """
    path = Path(path)
    if not path.is_file():
        raise ModelFileError(path, "no such file", KINDS)
    suffix = path.suffix.lower()
    if suffix == ".npz":
        return load_npz_model(path)
    if suffix == ".off":
        return load_t16_model(path, max_faces)
    if suffix in (".glb", ".gltf"):
        return load_gltf_model(path, max_faces)
    if suffix == ".pkl":
        raise ModelFileError(path, "a pickle, perhaps of MANO or SMPL-H, which this version cannot read yet", KINDS)
    raise ModelFileError(path, f"the suffix {path.suffix[:20]!r}", KINDS)


def save_model(model: ArticulatedModel, path: Path) -> None:
    """Write a model to Handloom's .npz."""
    save_npz_model(model, Path(path))
