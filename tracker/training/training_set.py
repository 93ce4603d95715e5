"""Registrations to learn a hand model from: whose, in which pose, and a digest of it all."""

from __future__ import annotations

import hashlib
import zipfile
from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from tracker.errors import TrainingError, reading

MIRROR = np.array([-1.0, 1.0, 1.0])
FARTHEST = 100.0
"""A vertex farther from the origin than this, m, is no hand's."""

TEXTS = ("scan", "verdict", "side", "subject", "pose_name")
MAX_BYTES, MAX_VERTICES = 256 * 2**20, 100_000
"""Of one registration; bounds of ours."""


@dataclass(frozen=True)
class TrainingSet:
    """N registrations, all as right hands.

    Attributes:
        vertices: (N, V, 3) m; left hands mirrored in x.
        subjects: (N,) whose hand.
        pose_names: (N,) which pose of the protocol, or "".
        mirrored: (N,) whether it was a left hand.
    """

    vertices: npt.NDArray[np.float64]
    subjects: npt.NDArray[np.str_]
    pose_names: npt.NDArray[np.str_]
    mirrored: npt.NDArray[np.bool_]

    def __post_init__(self) -> None:
        count = len(self.vertices)
        assert self.vertices.ndim == 3 and self.vertices.shape[2] == 3
        assert self.subjects.shape == self.pose_names.shape == self.mirrored.shape == (count,)

    def __len__(self) -> int:
        return len(self.vertices)

    @property
    def hands(self) -> npt.NDArray[np.str_]:
        """(N,) the subject, and which of their hands where it is the left one."""
        return np.array(
            [f"{s}{' (left)' * bool(m)}" for s, m in zip(self.subjects, self.mirrored, strict=True)], dtype=str
        )

    @cached_property
    def digest(self) -> str:
        """Names exactly this set, whatever the order of its registrations."""
        each = sorted(
            hashlib.sha256(
                np.ascontiguousarray(v).tobytes() + f"\0{subject}\0{pose}\0{int(mirrored)}".encode()
            ).hexdigest()
            for v, subject, pose, mirrored in zip(
                self.vertices, self.subjects, self.pose_names, self.mirrored, strict=True
            )
        )
        return hashlib.sha256("".join(each).encode()).hexdigest()

    def select(self, chosen: npt.NDArray) -> TrainingSet:
        """The registrations that a mask (N,) or indices choose."""
        return TrainingSet(self.vertices[chosen], self.subjects[chosen], self.pose_names[chosen], self.mirrored[chosen])


def make_training_set(
    vertices: Sequence[npt.NDArray] | npt.NDArray,
    subjects: Iterable[str],
    pose_names: Iterable[str],
    is_left: Iterable[bool],
) -> TrainingSet:
    """A training set of registrations in the frames of their scans: left hands, (V, 3) m, are mirrored.

    Raises:
        TrainingError: Registrations of different templates, or vertices that are no numbers or far away.
    """
    subjects, pose_names = np.array(list(subjects), dtype=str), np.array(list(pose_names), dtype=str)
    mirrored = np.array(list(is_left), dtype=bool)
    counts = sorted({len(v) for v in vertices})
    if len(counts) > 1:
        raise TrainingError(
            f"Registrations have {', '.join(map(str, counts))} vertices; all must be of one template: "
            "register again those that were made with another model."
        )
    if not counts:
        return TrainingSet(np.empty((0, 0, 3)), subjects, pose_names, mirrored)
    points = np.array(vertices, dtype=np.float64)
    is_bad = ~np.isfinite(points).all((1, 2)) | (np.abs(np.nan_to_num(points)).max((1, 2)) > FARTHEST)
    if is_bad.any():
        raise TrainingError(
            f"{is_bad.sum()} of {len(points)} registrations, first number {np.flatnonzero(is_bad)[0]}, have vertices "
            f"that are no numbers or farther away than {FARTHEST:g} m; leave them out."
        )
    points[mirrored] *= MIRROR
    return TrainingSet(points, subjects, pose_names, mirrored)


def load_training_set(
    folder: Path | str, scans: Collection[str] | None = None, verdicts: Collection[str] = ("good",)
) -> TrainingSet:
    """The registrations below a folder.

    Args:
        folder: Every `*.npz` in it or below it that is a registration is read, in the order of their paths.
        scans: Names of the scans that were accepted; None: the verdict of the registration decides.
        verdicts: Which verdicts are good enough, when no scans are named.

    Raises:
        TrainingError: No such registration, or one that cannot be read or does not fit the others.
    """
    folder = Path(folder)
    if not folder.is_dir():
        raise TrainingError(f"{folder}: there is no such folder; give the folder that `handloom register` wrote to.")
    vertices, subjects, pose_names, is_left, seen = [], [], [], [], 0
    for path in sorted(folder.rglob("*.npz")):
        fields = _read_registration(path)
        if fields is None:
            continue
        seen += 1
        if fields["scan"] in scans if scans is not None else fields["verdict"] in verdicts:
            vertices.append(fields["vertices"])
            subjects.append(fields["subject"])
            pose_names.append(fields["pose_name"])
            is_left.append(fields["side"] == "left")
    if not vertices:
        which = "that were accepted" if scans is not None else f"with the verdict {' or '.join(sorted(verdicts))}"
        raise TrainingError(f"{folder}: {seen} registrations, none of those {which}; nothing to learn from.")
    return make_training_set(vertices, subjects, pose_names, is_left)


def _read_registration(path: Path) -> dict[str, Any] | None:
    """What training needs of a `registration.npz`; None for an .npz of another kind."""
    with reading(TrainingError, path, "a registration; register its scan again, or remove the file"):
        with zipfile.ZipFile(path) as archive:
            if sum(member.file_size for member in archive.infolist()) > MAX_BYTES:
                raise TrainingError(f"{path}: more than {MAX_BYTES} bytes; no registration is so large.")
            names = {member.filename.removesuffix(".npy") for member in archive.infolist()}
        if not {"vertices", "verdict", "scan_to_mesh"} <= names:
            return None
        with np.load(path, allow_pickle=False) as arrays:
            texts = {name: str(arrays[name]) for name in TEXTS if name in names and arrays[name].dtype.kind == "U"}
            vertices = arrays["vertices"]
    is_mesh = vertices.ndim == 2 and vertices.shape[1] == 3 and len(vertices) <= MAX_VERTICES
    if not is_mesh or vertices.dtype.kind != "f" or len(texts) < len(TEXTS) or texts["side"] not in ("right", "left"):
        raise TrainingError(
            f"{path}: vertices of shape {vertices.shape}, texts {', '.join(sorted(texts)) or 'none'}; needed (V, 3) "
            f"vertices and {', '.join(TEXTS)}, side 'right' or 'left'. Register its scan again."
        )
    return {**texts, "vertices": vertices.astype(np.float64)}
