"""Handloom's own file of a blend model: one .npz, to the last bit."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
from scipy import sparse

from tracker.errors import ModelFileError, reads
from tracker.model.blend_model import BlendModel
from tracker.model.npz_arrays import NpzFields, read_npz_arrays
from tracker.model.npz_files import MAX_ANGLE, MAX_COORDINATE, read_provenance, write_npz_arrays

BLEND_FORMAT = ("handloom-blend-model", "1")


def save_blend_model(model: BlendModel, path: Path) -> None:
    """Write a model; the file appears whole or not at all. Equal models give equal bytes."""
    write_npz_arrays(Path(path), blend_arrays(model))


def blend_arrays(model: BlendModel) -> dict[str, np.ndarray]:
    """What is in the file of a model."""
    regressor = sparse.coo_array(model.joint_regressor)
    order = np.lexsort((regressor.col, regressor.row))
    return {
        "format": np.array(BLEND_FORMAT),
        "name": np.array([model.name]),
        "side": np.array([model.side]),
        "provenance": np.array([json.dumps(model.provenance, ensure_ascii=False)]),
        "template": model.template,
        "faces": model.faces,
        "shape_directions": model.shape_directions,
        "pose_directions": model.pose_directions,
        "skinning_weights": model.skinning_weights,
        "regressor_rows": regressor.row[order],
        "regressor_columns": regressor.col[order],
        "regressor_values": regressor.data[order],
        "parents": model.parents,
        "joint_names": np.array(model.joint_names),
        "pose_mean": model.pose_mean,
        "pose_components": model.pose_components,
        "tips": model.tips,
    }


@reads(ModelFileError, "a trained hand model as Handloom writes it")
def load_blend_model(path: Path) -> BlendModel:
    """Read a model that `save_blend_model` wrote, checking every array of it.

    Raises:
        ModelFileError: With what was found and what is needed.
    """
    path = Path(path)
    return read_blend_fields(NpzFields(path, read_npz_arrays(path)))


def read_blend_fields(fields: NpzFields) -> BlendModel:
    """A model from the arrays of its file."""
    path = fields.path
    form = fields.texts("format", 2)
    if form != BLEND_FORMAT:
        raise ModelFileError(path, f"format {' '.join(form)[:60]}", " ".join(BLEND_FORMAT))
    side = fields.texts("side", 1)[0]
    if side not in ("right", "left", "body"):
        raise ModelFileError(path, f"side {side[:40]!r}", "right, left or body")
    template = fields.floats("template", (-1, 3), MAX_COORDINATE)
    names = fields.texts("joint_names", -1)
    vertices, bones = len(template), len(names)
    if not vertices or bones < 2:
        raise ModelFileError(path, f"{vertices} vertices and {bones} joints", "a surface and at least two joints")
    parents = fields.integers("parents", (bones,), -1, bones)
    if parents[0] != -1 or np.any(parents[1:] < 0) or np.any(parents >= np.arange(bones)):
        raise ModelFileError(path, "joints that do not form one tree in order", "one root, parents before children")
    weights = fields.floats("skinning_weights", (vertices, bones), 10.0)
    if np.abs(weights.sum(axis=1) - 1.0).max() > 1e-5:
        raise ModelFileError(path, "skinning weights that do not sum to one", "rows that sum to one")
    rows = fields.integers("regressor_rows", (-1,), 0, bones)
    columns = fields.integers("regressor_columns", (len(rows),), 0, vertices)
    values = fields.floats("regressor_values", (len(rows),), MAX_COORDINATE)
    return BlendModel(
        name=fields.texts("name", 1)[0],
        side=side,
        template=template,
        faces=fields.integers("faces", (-1, 3), 0, vertices),
        shape_directions=fields.floats("shape_directions", (vertices, 3, -1), MAX_COORDINATE),
        pose_directions=fields.floats("pose_directions", (vertices, 3, 9 * (bones - 1)), MAX_COORDINATE),
        skinning_weights=weights,
        joint_regressor=sparse.csr_array((values, (rows, columns)), shape=(bones, vertices)),
        parents=parents,
        joint_names=names,
        pose_mean=fields.floats("pose_mean", (3 * (bones - 1),), MAX_ANGLE),
        pose_components=fields.floats("pose_components", (-1, 3 * (bones - 1)), MAX_ANGLE),
        tips=fields.integers("tips", (10 if side == "body" else 5,), 0, vertices),
        provenance=read_provenance(fields),
    )
