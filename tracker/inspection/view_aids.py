"""What looking at the frames of a track needs besides the frames: made when first asked for, kept while one looks."""

from __future__ import annotations

from contextlib import ExitStack
from functools import cached_property

import numpy as np
import numpy.typing as npt

from tracker.detection import Forest
from tracker.fitting.setup import TrackSetup
from tracker.model.scene import PosedScene
from tracker.physics import PhysicsWorld
from tracker.search.tools import Tools, make_tools


class ViewAids:
    """The run's own tools, and a detector and a physics world whether the run had them or not; close it in the end."""

    def __init__(self, setup: TrackSetup, T_world_camera: npt.NDArray[np.float64]) -> None:
        self.setup = setup
        self._T_world_camera = T_world_camera
        self._stack = ExitStack()

    @cached_property
    def tools(self) -> Tools:
        """What the run itself had."""
        return self._stack.enter_context(make_tools(self.setup, self._T_world_camera))

    @cached_property
    def detector(self) -> Forest:
        return self.setup.fingertip_detector

    @cached_property
    def part_names(self) -> tuple[str, ...]:
        """(B,) what to call the skin of each bone of the scene: "right index distal", "ball", "rope bone_3"."""
        names: list[str] = []
        for name, model in zip(self.setup.names, self.setup.models, strict=True):
            bones = model.skeleton.bone_names
            if model.hand is None:
                names += [name] if len(bones) == 1 else [f"{name} {bone}" for bone in bones]
                continue
            own = [f"{name} {bone}" for bone in bones]
            heaviest = np.argmax(model.skinning_weights, axis=1)
            for part, ids in model.hand.finger_parts.items():
                if len(ids):
                    own[int(np.bincount(heaviest[ids]).argmax())] = f"{name} {part.replace('_', ' ')}"
            names += own
        return tuple(names)

    def world(self, posed: PosedScene) -> PhysicsWorld | None:
        """A world with the scene's hands and objects; None where there is not at least one of each."""
        models = self.setup.models
        if all(model.hand for model in models) or not any(model.hand for model in models):
            return None
        assert posed.scene is self.setup.scene
        return self._world

    @cached_property
    def _world(self) -> PhysicsWorld:
        return self._stack.enter_context(self.setup.make_world(self._T_world_camera))

    def close(self) -> None:
        self._stack.close()
