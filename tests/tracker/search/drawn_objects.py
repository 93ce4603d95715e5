"""Small objects drawn as a noise-free camera would see them, alone or with a hand and a table."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import trimesh

from tracker.capture.camera import Camera
from tracker.capture.frame import Frame
from tracker.evaluation import compute_surface_distances
from tracker.geometry import se3
from tracker.model.articulated import ArticulatedModel
from tracker.model.default_hand import default_hand
from tracker.model.object_files import load_object
from tracker.model.scene import Scene
from tracker.rendering import render_view
from tracker.synthesis.motion import perform_motion

CAMERA = Camera("cam0", 320, 240, np.array([[262.5, 0.0, 159.5], [0.0, 262.5, 119.5], [0.0, 0.0, 1.0]]))

MESHES = {
    "ball": trimesh.creation.icosphere(subdivisions=3, radius=0.03),
    "box": trimesh.creation.box((0.04, 0.06, 0.10)),
    "cone": trimesh.creation.cone(radius=0.03, height=0.09, sections=24),
    "bracket": trimesh.util.concatenate(
        [
            trimesh.creation.box((0.10, 0.03, 0.03)),
            trimesh.creation.box((0.03, 0.06, 0.03), transform=se3.exp(np.r_[-0.035, 0.045, 0.0, 0.0, 0.0, 0.0])),
        ]
    ),
}


def load_mesh(folder: Path, name: str) -> ArticulatedModel:
    """One of MESHES through a file, as users bring it."""
    path = folder / f"{name}.ply"
    MESHES[name].export(path)
    return load_object(path)


def hand_pose(model: ArticulatedModel) -> np.ndarray:
    """An open hand left of the middle."""
    return perform_motion(model, "open-close", 2, 30.0, -0.09)[0]


@dataclass(frozen=True)
class Drawn:
    """A drawn frame and what is known of it."""

    frame: Frame
    hand: ArticulatedModel
    hand_pose: np.ndarray


def draw_frame(
    model: ArticulatedModel, pose: np.ndarray, coloured: bool, index: int = 0, table: float | None = None
) -> Drawn:
    """A hand and an object before nothing, or before a table at this depth, m; in colour or not."""
    hand = default_hand("right")
    scene = Scene((hand, model))
    at = hand_pose(hand)
    view = render_view(scene.pose_at(np.r_[at, pose]), CAMERA.K, CAMERA.T_world_camera, CAMERA.height, CAMERA.width)
    depth = view.depth.astype(np.float32)
    if table is not None:
        depth = np.where(depth > 0, depth, np.float32(table))
    color = np.zeros((*depth.shape, 3), dtype=np.uint8)
    color[depth > 0] = (60, 110, 170)
    color[(view.face >= 0) & (scene.face_models[view.face] == 0)] = (212, 153, 120)
    return Drawn(Frame(index, "cam0", color if coloured else None, depth), hand, at)


def surface_error(model: ArticulatedModel, found: np.ndarray, true: np.ndarray) -> float:
    """Greatest distance of the found surface from the true one, m: a turn that looks the same is no error."""
    scene, used = Scene((model,)), np.unique(model.faces)
    vertices = [scene.pose_at(pose).vertices[: len(model.vertices)] for pose in (found, true)]
    return float(compute_surface_distances(vertices[0][used], vertices[1], model.faces).max())
