"""What looking at the frames of a track needs besides the frames: made when first asked for, kept while one looks."""

from __future__ import annotations

from contextlib import ExitStack
from functools import cached_property

import numpy as np
import numpy.typing as npt

from tracker.fitting.setup import TrackSetup
from tracker.physics import PhysicsWorld, find_physics_fault
from tracker.search.tools import Tools, make_tools


class ViewAids:
    """The run's own tools, and a physics world whether the run had one or not; close it in the end."""

    def __init__(self, setup: TrackSetup, T_world_camera: npt.NDArray[np.float64]) -> None:
        self.setup = setup
        self._T_world_camera = T_world_camera
        self._stack = ExitStack()

    @cached_property
    def tools(self) -> Tools:
        """What the run itself had."""
        return self._stack.enter_context(make_tools(self.setup, self._T_world_camera))

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

    @cached_property
    def world(self) -> PhysicsWorld | None:
        """A world with the scene's hands and objects; None without one of each, or without Bullet."""
        if not self.setup.hands or not self.setup.objects or find_physics_fault():
            return None
        return self._stack.enter_context(self.setup.make_world(self._T_world_camera))

    def close(self) -> None:
        self._stack.close()
