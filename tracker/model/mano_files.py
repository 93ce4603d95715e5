"""Files of MANO and SMPL-H, pickled or .npz, read into a blend model."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy import sparse

from tracker.errors import ModelFileError, reads
from tracker.model.blend_model import BLEND_JOINTS, BlendModel
from tracker.model.hand_parts import find_tip
from tracker.model.joints import FINGERS
from tracker.model.mano_conventions import CONVENTIONS, SMPLH_TIP_VERTICES, TIP_VERTICES, ManoConvention
from tracker.model.npz_arrays import NpzFields, read_foreign_npz
from tracker.model.npz_files import MAX_COORDINATE
from tracker.model.restricted_pickle import read_restricted_pickle

NEEDED = "a MANO or SMPL-H model: v_template, f, weights, shapedirs, posedirs, J_regressor, kintree_table"

BODY_JOINTS: tuple[str, ...] = (
    *("pelvis", "left_hip", "right_hip", "spine1", "left_knee", "right_knee", "spine2", "left_ankle", "right_ankle"),
    *("spine3", "left_foot", "right_foot", "neck", "left_collar", "right_collar", "head", "left_shoulder"),
    *("right_shoulder", "left_elbow", "right_elbow", "left_wrist", "right_wrist"),
)
SMPLH_JOINTS = BODY_JOINTS + tuple(f"{side}_{joint}" for side in ("left", "right") for joint in BLEND_JOINTS[1:])
"""SMPL-H's 52 joints: the body's 22, then 15 of the left and 15 of the right hand in MANO's order."""


@reads(ModelFileError, NEEDED)
def load_mano(path: Path, side: str | None = None, convention: ManoConvention = CONVENTIONS["smplx"]) -> BlendModel:
    """A model from MANO_RIGHT.pkl, MANO_LEFT.pkl, SMPLH_*.pkl, or an .npz of the same arrays.

    Args:
        path: The file. A pickle is read without running it.
        side: "right" or "left" of a MANO file; taken from the file's name when left out, as in `smplx`.
        convention: Of it count `flat_hand_mean` (a mean pose of zero), `tips` and `fix_left_shape`.

    Raises:
        ModelFileError: No such model, or a damaged one; says what was found.
    """
    path = Path(path)
    if not path.is_file():
        raise ModelFileError(path, "no such file", NEEDED)
    parts = read_foreign_npz(path) if path.suffix.lower() == ".npz" else read_restricted_pickle(path)
    return _Builder(path, parts).build(side, convention)


def is_mano_npz(names: set[str]) -> bool:
    """Whether an .npz with these arrays is a MANO or SMPL-H model."""
    return {"v_template", "weights", "kintree_table"} <= names


class _Builder:
    """Checks the arrays of a file one by one."""

    def __init__(self, path: Path, parts: dict[str, Any]) -> None:
        self.path, self.parts = path, parts

    def build(self, side: str | None, convention: ManoConvention) -> BlendModel:
        template = self.floats("v_template", (-1, 3))
        weights = self.floats("weights", (len(template), -1))
        vertices, bones = weights.shape
        if bones not in (len(BLEND_JOINTS), len(SMPLH_JOINTS)):
            raise ModelFileError(self.path, f"weights for {bones} joints", "16 of a MANO hand or 52 of SMPL-H")
        if vertices == 0 or np.abs(weights.sum(axis=1) - 1.0).max() > 1e-3:
            raise ModelFileError(self.path, "skinning weights that do not sum to one", "rows that sum to one")
        is_hand = bones == len(BLEND_JOINTS)
        side = self._side(side) if is_hand else "body"
        directions = self.floats("shapedirs", (vertices, 3, -1))
        if side == "left" and convention.fix_left_shape and "tips" not in self.parts:
            directions = directions * np.array([-1.0, 1.0, 1.0])[:, None]
        mean, components = self._pose_space(is_hand)
        if convention.flat_hand_mean:
            mean = np.zeros_like(mean)
        regressor = self._regressor(bones, vertices)
        return BlendModel(
            name=str(self.parts.get("name", self.path.stem)),
            side=side,
            template=template,
            faces=self._faces(vertices),
            shape_directions=directions,
            pose_directions=self.floats("posedirs", (vertices, 3, 9 * (bones - 1))),
            skinning_weights=weights,
            joint_regressor=regressor,
            parents=self._parents(bones),
            joint_names=BLEND_JOINTS if is_hand else SMPLH_JOINTS,
            pose_mean=mean,
            pose_components=components,
            tips=self._tips(side, convention, template, weights, regressor @ template),
            provenance=self._provenance(),
        )

    def floats(self, name: str, shape: tuple[int, ...]) -> npt.NDArray[np.float64]:
        value: Any = self.parts.get(name)
        array = value.toarray() if sparse.issparse(value) else value
        known = {name: array} if isinstance(array, np.ndarray) else {}
        return NpzFields(self.path, known).numbers(name, shape, MAX_COORDINATE)

    def _side(self, side: str | None) -> str:
        told = side or self.parts.get("side")
        told = str(told) if isinstance(told, (str, np.ndarray)) else None
        if told is None:
            name = self.path.name.upper()
            told = "right" if "RIGHT" in name else "left" if "LEFT" in name else None
        if told not in ("right", "left"):
            needed = "RIGHT or LEFT in the file's name, or the side said"
            raise ModelFileError(self.path, "a hand of unknown side", needed)
        return told

    def _faces(self, vertices: int) -> npt.NDArray[np.int64]:
        faces: Any = self.parts.get("f")
        good = isinstance(faces, np.ndarray) and faces.dtype.kind in "iu" and faces.ndim == 2 and faces.shape[1] == 3
        if not good or (faces.size and (int(faces.min()) < 0 or int(faces.max()) >= vertices)):
            raise ModelFileError(self.path, "no faces 'f' of its vertices", NEEDED)
        return np.ascontiguousarray(faces, dtype=np.int64)

    def _parents(self, bones: int) -> npt.NDArray[np.int64]:
        table = self.parts.get("kintree_table")
        if not isinstance(table, np.ndarray) or table.dtype.kind not in "iuf" or table.shape != (2, bones):
            raise ModelFileError(self.path, "no 'kintree_table' of its joints", f"'kintree_table', 2x{bones}")
        parents = table[0].astype(np.int64)
        parents[0] = -1  # stands there as 2^32 - 1
        if np.any(parents[1:] < 0) or np.any(parents >= np.arange(bones)):
            raise ModelFileError(self.path, "joints that do not form one tree in order", "parents before children")
        return parents

    def _regressor(self, bones: int, vertices: int) -> sparse.csr_array:
        return sparse.csr_array(self.floats("J_regressor", (bones, vertices)))

    def _pose_space(self, is_hand: bool) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
        """Mean and components; identity and zero where a repacked file has none, zero rows for the body's joints."""
        count = 3 * (len(BLEND_JOINTS) - 1)

        def part(letter: str) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
            if f"hands_mean{letter}" not in self.parts:
                return np.zeros(count), np.eye(count)
            return self.floats(f"hands_mean{letter}", (count,)), self.floats(f"hands_components{letter}", (-1, count))

        if is_hand:
            return part("")
        (mean_l, left), (mean_r, right) = part("l"), part("r")
        body = 3 * (len(BODY_JOINTS) - 1)
        components = np.zeros((len(left) + len(right), body + 2 * count))
        components[: len(left), body : body + count] = left
        components[len(left) :, body + count :] = right
        return np.concatenate([np.zeros(body), mean_l, mean_r]), components

    def _tips(self, side, convention, template, weights, joints) -> npt.NDArray[np.int64]:
        own: Any = self.parts.get("tips")
        if _are_vertices(own, 10 if side == "body" else 5, len(template)):
            return own.astype(np.int64)
        if side == "body" and len(template) == 6890:
            return np.array([SMPLH_TIP_VERTICES[s] for s in ("right", "left")]).ravel()
        if side != "body" and len(template) == 778:
            return np.array(TIP_VERTICES[convention.tips][side])
        ends = _last_joints(side)
        chains = [np.stack([joints[end], 2.0 * joints[end] - joints[end - 1]]) for end in ends]
        return np.array([find_tip(template, weights[:, end], chain) for end, chain in zip(ends, chains, strict=True)])

    def _provenance(self) -> dict[str, str]:
        start = "provenance_"
        told = {key[len(start) :]: str(value) for key, value in self.parts.items() if key.startswith(start)}
        return told or {"source": f"{self.path.name}, a file of MANO's or SMPL-H's kind", "licence": "see its source"}


def _are_vertices(value: Any, count: int, vertices: int) -> bool:
    if not isinstance(value, np.ndarray) or value.shape != (count,) or value.dtype.kind not in "iu":
        return False
    return bool(value.min() >= 0 and value.max() < vertices)


def _last_joints(side: str) -> list[int]:
    """The last joint of each finger; of the body's fingers, first those of the right hand."""
    last = [f"{finger}3" for finger in FINGERS]
    if side != "body":
        return [BLEND_JOINTS.index(joint) for joint in last]
    return [SMPLH_JOINTS.index(f"{hand}_{joint}") for hand in ("right", "left") for joint in last]
