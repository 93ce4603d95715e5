"""Some models of a scene, followed while the others are lost."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import numpy.typing as npt

from tracker.fitting.attempt import Attempt
from tracker.fitting.setup import TrackSetup

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Part:
    """Some models of a scene.

    Attributes:
        whole: The scene's setup.
        kept: Indices of the models, rising.
    """

    whole: TrackSetup
    kept: tuple[int, ...]

    @classmethod
    def without(cls, whole: TrackSetup, lost: tuple[int, ...]) -> Part:
        """All models but those that are lost."""
        return cls(whole, tuple(index for index in range(len(whole.models)) if index not in lost))

    @cached_property
    def setup(self) -> TrackSetup:
        """Of these models alone; the very setup where none is missing."""
        if len(self.kept) == len(self.whole.models):
            return self.whole
        names = tuple(self.whole.names[index] for index in self.kept)
        return replace(self.whole, names=names, models=tuple(self.whole.models[index] for index in self.kept))

    def take(self, pose: Array) -> Array:
        """The part (d,) of a pose (D,)."""
        return np.concatenate([np.zeros(0), *(pose[self.whole.scene.pose_slices[index]] for index in self.kept)])

    def put(self, own: Array, pose: Array) -> Array:
        """The pose (D,) with the part (d,) in its place."""
        result = pose.copy()
        for index, where in zip(self.kept, self.setup.scene.pose_slices, strict=True):
            result[self.whole.scene.pose_slices[index]] = own[where]
        return result

    def widen(self, attempt: Attempt, pose: Array) -> Attempt:
        """An attempt at this part as one at the whole scene, the other models at a pose (D,)."""
        return Attempt(
            self.put(attempt.pose, pose),
            {self.kept[index]: quality for index, quality in attempt.qualities.items()},
            attempt.fit,
            {self.kept[index]: quality for index, quality in attempt.objects.items()},
        )
