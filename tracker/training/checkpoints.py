"""Where the finished stages of a training are kept, so that an interrupted one continues instead of starting over.

What is kept are the exact bits, and training always goes on from what would be kept: whether it was interrupted, and
how often, changes nothing of the result.
"""

from __future__ import annotations

import contextlib
import hashlib
import io
import json
import logging
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Protocol

import numpy as np
import numpy.typing as npt

from tracker.capture.atomic_file import write_atomically
from tracker.errors import TrainingError, reading
from tracker.model.blend_model import BlendModel
from tracker.training.options import TrainingOptions
from tracker.training.training_set import TrainingSet

log = logging.getLogger(__name__)

VERSION = 3
"""Of what a stage leaves. Raise it when stages change: what an older program has kept is then refused."""

Arrays = Mapping[str, npt.NDArray]


class Checkpoints(Protocol):
    """Arrays by the name of the stage that left them; a name is letters, digits and hyphens."""

    def load(self, stage: str) -> dict[str, npt.NDArray] | None:
        """What a stage left; None when it was not finished, or what it left is damaged."""
        ...

    def save(self, stage: str, arrays: Arrays) -> None:
        """Keep what a stage leaves: whole, and on the disk before this returns."""
        ...


class NoCheckpoints:
    """Nothing is kept."""

    def load(self, stage: str) -> dict[str, npt.NDArray] | None:
        return None

    def save(self, stage: str, arrays: Arrays) -> None:
        pass


class FolderCheckpoints:
    """An .npz for each stage in a folder of their own."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def load(self, stage: str) -> dict[str, npt.NDArray] | None:
        path = self._folder / f"{stage}.npz"
        try:
            return unpack_arrays(path.read_bytes())
        except FileNotFoundError:
            return None
        except (OSError, TrainingError) as error:
            log.warning("%s is damaged (%s); that stage is done again", path, str(error)[:120])
            return None

    def save(self, stage: str, arrays: Arrays) -> None:
        self._folder.mkdir(parents=True, exist_ok=True)
        write_atomically(self._folder / f"{stage}.npz", pack_arrays(arrays))

    def remove(self, stages: Iterable[str]) -> None:
        """What these stages left, once the model is safe; the folder goes when nothing else is in it."""
        for stage in stages:
            (self._folder / f"{stage}.npz").unlink(missing_ok=True)
        with contextlib.suppress(OSError):
            self._folder.rmdir()


class PrefixedCheckpoints:
    """Those of one of several trainings that are kept in one place."""

    def __init__(self, kept: Checkpoints, prefix: str) -> None:
        self._kept, self._prefix = kept, prefix

    def load(self, stage: str) -> dict[str, npt.NDArray] | None:
        return self._kept.load(f"{self._prefix}-{stage}")

    def save(self, stage: str, arrays: Arrays) -> None:
        self._kept.save(f"{self._prefix}-{stage}", arrays)


def pack_arrays(arrays: Arrays) -> bytes:
    """The bytes of an .npz, uncompressed: noise does not become smaller."""
    buffer = io.BytesIO()
    np.savez(buffer, allow_pickle=False, **arrays)
    return buffer.getvalue()


def unpack_arrays(data: bytes) -> dict[str, npt.NDArray]:
    """Arrays of an .npz.

    Raises:
        TrainingError: It is none, or is damaged.
    """
    with (
        reading(TrainingError, "a checkpoint", "what training kept"),
        np.load(io.BytesIO(data), allow_pickle=False) as file,
    ):
        return {name: file[name] for name in file.files}


def compute_key(used: TrainingSet, initial: BlendModel, options: TrainingOptions) -> str:
    """Names exactly what a training does: only what was kept under the same name may be gone on with.

    Args:
        used: The registrations that are learnt from, in their order.
        initial: The model that training begins with.
        options: All but the name that the model gets and the threads, which do not matter.
    """
    described = {name: value for name, value in options.describe().items() if name != "name"}
    texts = [VERSION, described, used.subjects.tolist(), used.pose_names.tolist(), used.mirrored.tolist()]
    digest = hashlib.sha256(json.dumps(texts).encode())
    regressor = initial.joint_regressor.toarray()
    for array in (initial.template, initial.faces, initial.skinning_weights, regressor, initial.parents, used.vertices):
        digest.update(f"\0{array.dtype.str}{array.shape}".encode())
        digest.update(np.ascontiguousarray(array).tobytes())
    return digest.hexdigest()
