"""Hands as MANO's files are and bodies as SMPL-H's, for the programs that read them."""
# pyright: reportAttributeAccessIssue=false
# The parts of pickle._Pickler that are used here are not in its types.

from __future__ import annotations

import os
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy import sparse

from tracker.model.blend_model import BlendModel
from tracker.model.body_hands import body_hand
from tracker.model.npz_files import write_plain_npz


def save_mano(model: BlendModel, path: Path) -> None:
    """Write a model as MANO's and SMPL-H's files are: .npz when the path ends so, else a pickle of plain arrays.

    `smplx` loads either (`ext="npz"`, for .npz). It takes the side of a hand from "RIGHT" in the file's name. A pose
    space of fewer than 3K components is completed by directions square to it. Vertices, unit and frame stay this
    model's: only a model with MANO's own 778 vertices has MANO's fingertips and axes, only one with SMPL-H's 6890 its
    landmarks (`smplx_vertex_ids` of another).
    """
    path = Path(path)
    bones = model.num_bones
    parts: dict[str, Any] = {
        "v_template": model.template,
        "f": model.faces.astype(np.uint32),
        "weights": model.skinning_weights,
        "shapedirs": model.shape_directions,
        "posedirs": model.pose_directions,
        "J_regressor": sparse.csc_matrix(model.joint_regressor),
        "J": model.joints_of(model.template),
        "kintree_table": np.stack([model.parents % 2**32, np.arange(bones)]).astype(np.uint32),
        **_pose_spaces(model),
        "bs_type": "lrotmin",
        "bs_style": "lbs",
        "tips": model.tips,
        "side": model.side,
        "name": model.name,
    }
    parts |= {f"provenance_{key}": text for key, text in model.provenance.items()}
    if path.suffix.lower() == ".npz":
        dense = {**parts, "J_regressor": model.joint_regressor.toarray()}
        write_plain_npz(path, {key: np.asarray(value) for key, value in dense.items()})
        return
    temporary = path.with_name(f".{path.name}.{os.getpid()}.tmp")
    try:
        with temporary.open("wb") as file:
            _Writer(file, protocol=2).dump(parts)
        os.replace(temporary, path)
    finally:
        temporary.unlink(missing_ok=True)


class _Writer(pickle._Pickler):
    """Names NumPy's and SciPy's parts as their older versions do, which the newer ones still know."""

    homes = {"numpy._core": "numpy.core", "scipy.sparse._csc": "scipy.sparse.csc"}  # noqa: RUF012

    def save_global(self, obj: Any, name: str | None = None) -> None:
        module = str(getattr(obj, "__module__", ""))
        for new, old in self.homes.items():
            if module.startswith(new):
                self.write(pickle.GLOBAL + f"{old}{module[len(new) :]}\n{name or obj.__qualname__}\n".encode())
                self.memoize(obj)
                return
        super().save_global(obj, name)


def smplx_vertex_ids(model: BlendModel) -> dict[str, int]:
    """Landmarks that `smplx.SMPLH` wants as `vertex_ids` of a body with other vertices than SMPL-H's.

    Fingertips are the model's own. Nose, eyes, ears, toes and heels, which it has no names for, are the vertices that
    lie farthest in the direction where each is looked for.
    """
    assert model.side == "body"
    joints = model.joints_of(model.template)
    named = dict(zip(model.joint_names, range(model.num_bones), strict=True))

    def farthest(joint: str, direction: tuple[float, float, float]) -> int:
        own = np.flatnonzero(model.skinning_weights.argmax(axis=1) == named[joint])
        return int(own[np.argmax((model.template[own] - joints[named[joint]]) @ np.array(direction))])

    ids = {"nose": farthest("head", (0.0, 0.0, 1.0))}
    for letter, side, x in (("r", "right", -1.0), ("l", "left", 1.0)):
        ids[f"{letter}eye"] = farthest("head", (0.4 * x, 0.3, 1.0))
        ids[f"{letter}ear"] = farthest("head", (x, 0.0, 0.0))
        ids["RBigToe" if letter == "r" else "LBigToe"] = farthest(f"{side}_foot", (-0.3 * x, 0.0, 1.0))
        ids["RSmallToe" if letter == "r" else "LSmallToe"] = farthest(f"{side}_foot", (x, 0.0, 0.3))
        ids["RHeel" if letter == "r" else "LHeel"] = farthest(f"{side}_ankle", (0.0, -0.5, -1.0))
        first = 0 if side == "right" else 5
        for number, finger in enumerate(("thumb", "index", "middle", "ring", "pinky")):
            ids[f"{letter}{finger}"] = int(model.tips[first + number])
    return ids


def _pose_spaces(model: BlendModel) -> dict[str, npt.NDArray[np.float64]]:
    """Mean, components and coefficients of the hand, or of a body's left and right hand."""
    if model.side != "body":
        return _pose_space(model.pose_mean, model.pose_components, "")
    arrays: dict[str, npt.NDArray[np.float64]] = {}
    for side in ("left", "right"):
        hand = body_hand(model, side)
        arrays |= _pose_space(model.pose_mean[hand.columns], hand.components_of(model), side[0])
    return arrays


def _pose_space(mean, components, letter: str) -> dict[str, npt.NDArray[np.float64]]:
    nobody = np.zeros((0, len(mean)))  # loaders of the authors' kind slice the poses learnt from
    found = {"components": _complete(components, len(mean)), "mean": mean, "coeffs": nobody}
    return {f"hands_{name}{letter}": array for name, array in found.items()}


def _complete(components: npt.NDArray[np.float64], count: int) -> npt.NDArray[np.float64]:
    """(count, count) the rows and, behind them, unit directions square to them."""
    if len(components) >= count:
        return components[:count]
    if not len(components):
        return np.eye(count)
    rest = np.linalg.svd(components)[2][np.linalg.matrix_rank(components) :]
    return np.concatenate([components, rest])[:count]
