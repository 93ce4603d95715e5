"""Actors before one camera or several, and what a camera would see without noise."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import numpy.typing as npt

from tracker.capture.camera import Camera
from tracker.geometry import se3
from tracker.rendering.zbuffer import render_depth
from tracker.synthesis.actor import Actor

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Performance:
    """Actors that move together, and the cameras that record them.

    Attributes:
        name: For people.
        fps: Moments a second.
        camera: Without distortion.
        actors: At least one, all with the same number of moments.
        other_cameras: That record the same moments, without distortion.
    """

    name: str
    fps: float
    camera: Camera
    actors: tuple[Actor, ...]
    other_cameras: tuple[Camera, ...] = ()

    def __post_init__(self) -> None:
        assert self.actors and len({actor.num_moments for actor in self.actors}) == 1
        assert all(camera.distortion.size == 0 for camera in self.cameras), "the renderer draws no lens distortion"

    @property
    def cameras(self) -> tuple[Camera, ...]:
        return (self.camera, *self.other_cameras)

    def seen_by(self, camera: Camera) -> Performance:
        """The same before one camera alone."""
        return replace(self, camera=camera, other_cameras=())

    @property
    def num_moments(self) -> int:
        return self.actors[0].num_moments

    @property
    def hands(self) -> tuple[Actor, ...]:
        return tuple(actor for actor in self.actors if actor.is_hand)

    @property
    def objects(self) -> tuple[Actor, ...]:
        return tuple(actor for actor in self.actors if not actor.is_hand)

    @property
    def joint_names(self) -> tuple[str, ...]:
        return tuple(name for actor in self.actors for name in actor.joint_names)

    @cached_property
    def faces(self) -> npt.NDArray[np.int32]:
        """(F, 3) of all actors, into their vertices stacked in order."""
        starts = np.cumsum([0, *(len(actor.model.vertices) for actor in self.actors)])
        faces = [actor.model.faces + start for actor, start in zip(self.actors, starts, strict=False)]
        return np.concatenate(faces).astype(np.int32)

    @cached_property
    def face_actors(self) -> npt.NDArray[np.int64]:
        """(F,) index of the actor that a face belongs to."""
        return np.repeat(np.arange(len(self.actors)), [len(actor.model.faces) for actor in self.actors])


@dataclass(frozen=True)
class Moment:
    """What is exactly true at one moment.

    Attributes:
        index: Moment of the performance, from 0.
        vertices: (V, 3) of all actors, world, m.
        joints: (J, 3) in the order of `Performance.joint_names`, world, m.
        pixels: (J, 2) their projections, px.
        depth: (H, W) along the optical axis, m; 0 where nothing is.
        face: (H, W) the face seen, -1 where nothing is.
    """

    index: int
    vertices: Array
    joints: Array
    pixels: Array
    depth: Array
    face: npt.NDArray[np.int32]


def render_moment(performance: Performance, index: int) -> Moment:
    """Pose the actors at a moment and draw them."""
    posed = [actor.vertices(index) for actor in performance.actors]
    joints = np.concatenate(
        [actor.joints(index, vertices) for actor, vertices in zip(performance.actors, posed, strict=True)]
    )
    vertices = np.concatenate(posed)
    camera = performance.camera
    vertices_camera = se3.transform(camera.T_camera_world, vertices)
    rendering = render_depth(vertices_camera, performance.faces, camera.K, camera.width, camera.height)
    return Moment(index, vertices, joints, camera.project(joints), rendering.depth, rendering.face)
