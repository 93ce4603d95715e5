"""One frame of a track as people look at it: cloud, meshes, joints, correspondences; and the overlay on the image."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.capture.sequence import Sequence
from tracker.geometry import se3
from tracker.model.joints import HAND_EDGES
from tracker.observation import observe
from tracker.rendering import render_view
from tracker.tracking.frame_fit import find_residuals
from tracker.tracking.region import region_around
from tracker.tracking.setup import TrackSetup
from tracker.tracking.tools import make_tools

Array = npt.NDArray[np.float64]

COLORS = {"right": (255, 146, 43), "left": (51, 154, 240), "object": (81, 207, 102)}
"""RGB of right hands, left hands and objects, the same everywhere in the studio."""

CLOUD_MARGIN = 0.6
"""The cloud is shown as far as this around the hands, m."""


@dataclass(frozen=True)
class ModelView:
    """A posed model.

    Attributes:
        name: `right`, `left` or the object's.
        color: RGB.
        vertices: (V, 3) float32 world, m.
        faces: (F, 3).
        joints: (J, 3) float32 world, m.
        edges: (E, 2) pairs of joints to connect.
    """

    name: str
    color: tuple[int, int, int]
    vertices: npt.NDArray[np.float32]
    faces: npt.NDArray[np.int32]
    joints: npt.NDArray[np.float32]
    edges: npt.NDArray[np.int32]


@dataclass(frozen=True)
class FrameView:
    """What there is to see of a frame.

    Attributes:
        cloud: (N, 3) float32 points of the depth image, world, m.
        colors: (N, 3) uint8 RGB.
        models: Posed models.
        correspondences: Name of a term to (M, 2, 3) float32 segments from model to data, world, m.
        T_world_camera: (4, 4) of the depth camera.
    """

    cloud: npt.NDArray[np.float32]
    colors: npt.NDArray[np.uint8]
    models: tuple[ModelView, ...]
    correspondences: dict[str, npt.NDArray[np.float32]]
    T_world_camera: Array


def describe_frame(sequence: Sequence, setup: TrackSetup, pose: Array, index: int) -> FrameView:
    """All that can be shown of a frame at a pose (D,)."""
    frame, camera = setup.read(sequence, index)
    posed = setup.scene.pose_at(np.asarray(pose, dtype=np.float64))
    assert frame.depth is not None
    center = posed.vertices.mean(axis=0)
    rows, columns = np.nonzero(frame.depth)
    depths = frame.depth[rows, columns].astype(np.float64)
    x = (columns - camera.K[0, 2]) / camera.K[0, 0] * depths
    y = (rows - camera.K[1, 2]) / camera.K[1, 1] * depths
    cloud = se3.transform(camera.T_world_camera, np.stack([x, y, depths], axis=1))
    near = np.linalg.norm(cloud - center, axis=1) < CLOUD_MARGIN if np.any(pose) else np.ones(len(cloud), dtype=bool)
    if frame.color is not None:
        colors = frame.color[rows, columns][near]
    else:
        shade = 90 + 140 * (1.0 - np.clip((depths[near] - depths[near].min(initial=9.0)) / 0.4, 0.0, 1.0))
        colors = np.repeat(shade[:, None], 3, axis=1).astype(np.uint8)
    region = region_around(posed.vertices, camera)
    correspondences: dict[str, npt.NDArray[np.float32]] = {}
    if region is not None:
        seen = observe(frame, camera, region, setup.preprocessing)
        with make_tools(setup, camera.T_world_camera) as tools:
            objective = tools.with_fingertips(seen)
            found = find_residuals(posed, seen, tools.with_support(objective, setup, posed.pose) or objective)
        correspondences = {name: residual.segments(posed).astype(np.float32) for name, residual in found.items()}
    models = []
    for place, (name, model) in enumerate(zip(setup.names, setup.models, strict=True)):
        models.append(
            ModelView(
                name,
                COLORS.get(name if model.hand else "object", COLORS["object"]),
                posed.vertices[setup.scene.vertex_slices[place]].astype(np.float32),
                model.faces.astype(np.int32),
                posed.landmarks(place).astype(np.float32),
                np.array(HAND_EDGES if model.hand else _bone_edges(model.skeleton.parents), dtype=np.int32).reshape(
                    -1, 2
                ),
            )
        )
    return FrameView(cloud[near].astype(np.float32), colors, tuple(models), correspondences, camera.T_world_camera)


def render_overlay(
    sequence: Sequence, setup: TrackSetup, pose: Array, index: int, camera_id: str
) -> npt.NDArray[np.uint8]:
    """(H, W, 4) RGBA: the shaded models on a transparent ground, as a camera of the recording sees them.

    Lens distortion is left out: the overlay fits the undistorted image.
    """
    camera = sequence.camera(camera_id)
    posed = setup.scene.pose_at(np.asarray(pose, dtype=np.float64))
    view = render_view(posed, camera.K, camera.T_world_camera, camera.height, camera.width)
    drawn = view.face >= 0
    image = np.zeros((camera.height, camera.width, 4), dtype=np.uint8)
    palette = np.array(
        [
            COLORS.get(n if m.hand else "object", COLORS["object"])
            for n, m in zip(setup.names, setup.models, strict=True)
        ]
    )
    faces = view.face[drawn]
    towards = -(view.face_normals[faces] @ camera.T_world_camera[:3, 2])
    shade = 0.35 + 0.65 * np.clip(towards, 0.0, 1.0)
    image[drawn, :3] = (palette[setup.scene.face_models[faces]] * shade[:, None]).astype(np.uint8)
    image[drawn, 3] = 165
    return image


def _bone_edges(parents: npt.NDArray[np.int64]) -> list[tuple[int, int]]:
    return [(int(parent), bone) for bone, parent in enumerate(parents) if parent >= 0]
