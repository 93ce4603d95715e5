"""The state after a stage of a training, as arrays: all of it, because the next stage has nothing else."""

from __future__ import annotations

import logging
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.sparse import csr_array

from tracker.training.checkpoints import VERSION, Checkpoints
from tracker.training.learn import Learnt
from tracker.training.pose_fit import Poses
from tracker.training.rig import Rig

log = logging.getLogger(__name__)

FIRST, LAST = "first-poses", "last-poses"


@dataclass(frozen=True)
class Stage:
    """What stands after a stage.

    Attributes:
        learnt: All parameters.
        errors: Root mean square distance to the registrations after the first poses and after each round, m.
        seconds: By what was done, so far.
    """

    learnt: Learnt
    errors: tuple[float, ...]
    seconds: Mapping[str, float]


def list_stages(rounds: int) -> list[str]:
    """Names of the stages in their order: two a round, for poses with joints take more than half of it."""
    each = [(f"round-{number + 1}-joints", f"round-{number + 1}") for number in range(rounds)]
    return [FIRST, *(name for pair in each for name in pair), LAST]


def find_last(kept: Checkpoints, names: list[str], key: str) -> tuple[int, Stage | None]:
    """How many stages need not be done again, and what stands after them."""
    for done in range(len(names), 0, -1):
        arrays = kept.load(names[done - 1])
        if arrays is None:
            continue
        version = str(arrays.get("version", "1"))
        if version != str(VERSION):
            log.warning(
                "The stage %s was kept by another version of Handloom (its checkpoints are of version %s, this one "
                "reads version %d); the stage is done again.",
                names[done - 1],
                version[:20],
                VERSION,
            )
        elif str(arrays.get("key", "")) == key:
            return done, unpack_stage(arrays)
    return 0, None


def pack_stage(stage: Stage, key: str) -> dict[str, npt.NDArray]:
    """As arrays in C order; `key` says of which training."""
    learnt = stage.learnt
    arrays = {
        "templates": learnt.templates,
        "joints": learnt.joints,
        "rotations": learnt.poses.rotations,
        "translations": learnt.poses.translations,
        "pose_errors": learnt.poses.errors,
        "parents": learnt.rig.parents,
        "skinning_weights": learnt.rig.skinning_weights,
        "directions": learnt.rig.directions,
        "regressor_data": learnt.regressor.data,
        "regressor_indices": learnt.regressor.indices,
        "regressor_starts": learnt.regressor.indptr,
        "errors": np.array(stage.errors),
        "seconds_names": np.array(list(stage.seconds), dtype=str),
        "seconds": np.array(list(stage.seconds.values()), dtype=np.float64),
        "key": np.array(key),
        "version": np.array(VERSION),
    }
    return {name: np.ascontiguousarray(array).reshape(np.shape(array)) for name, array in arrays.items()}


def unpack_stage(arrays: Mapping[str, npt.NDArray]) -> Stage:
    """The inverse of `pack_stage`."""
    parts = arrays["regressor_data"], arrays["regressor_indices"], arrays["regressor_starts"]
    shape = len(arrays["parents"]), arrays["templates"].shape[1]
    learnt = Learnt(
        templates=arrays["templates"],
        joints=arrays["joints"],
        poses=Poses(arrays["rotations"], arrays["translations"], arrays["pose_errors"]),
        rig=Rig(arrays["parents"], arrays["skinning_weights"], arrays["directions"]),
        regressor=csr_array(parts, shape=shape),
    )
    seconds = zip(arrays["seconds_names"].tolist(), arrays["seconds"].tolist(), strict=True)
    return Stage(learnt, tuple(arrays["errors"].tolist()), dict(seconds))
