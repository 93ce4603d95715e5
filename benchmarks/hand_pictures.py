"""Pictures of registered hands: meshes from four sides, coloured by finger or by error."""

from __future__ import annotations

import cv2
import numpy as np
import numpy.typing as npt

from tracker.geometry.vertex_normals import find_unit_normals
from tracker.model.untrained_hand import untrained_hand
from tracker.rendering.zbuffer import render_depth

Array = npt.NDArray[np.float64]

SIZE, FOCAL = 420, 1500.0
PALM, FINGERS = (200, 200, 200), ((90, 90, 230), (90, 200, 90), (220, 180, 60), (220, 90, 160), (60, 170, 240))
NOTHING = 225.0


def find_upright(vertices: Array) -> Array:
    """(3, 3) rotation to where the hand's longest axis is upright, fingers up."""
    offsets = vertices - vertices.mean(axis=0)
    axes = np.linalg.eigh(offsets.T @ offsets)[1]
    up = axes[:, 2] * np.sign(axes[:, 2] @ (vertices[untrained_hand().tips].mean(axis=0) - vertices.mean(axis=0)))
    side = np.cross(up, axes[:, 0])
    return np.stack([side, -up, np.cross(side, -up)])


def draw(vertices: Array, faces: npt.NDArray, colors: Array, T: Array, middle: Array) -> npt.NDArray[np.uint8]:
    """One view: vertices turned by T (3, 3) about a middle, 1 m away, faces in colours (F, 3) BGR."""
    placed = (vertices - middle) @ T.T + [0.0, 0.0, 1.0]
    K = np.array([[FOCAL, 0.0, SIZE / 2], [0.0, FOCAL, SIZE / 2], [0.0, 0.0, 1.0]])
    face = render_depth(placed, np.asarray(faces, dtype=np.int32), K, SIZE, SIZE).face
    normals = find_unit_normals(placed, faces)[faces].mean(axis=1)
    light = 0.2 + 0.8 * np.clip(-normals[:, 2], 0.0, 1.0)
    image = np.full((SIZE, SIZE, 3), 255, dtype=np.uint8)
    shown = face >= 0
    image[shown] = np.clip(colors[face[shown]] * light[face[shown], None], 0, 255).astype(np.uint8)
    return image


def draw_four(vertices: Array, faces: npt.NDArray, colors: Array, like: Array | None = None) -> npt.NDArray[np.uint8]:
    """Four views a quarter turn apart, fingers up, placed as the hand `like` (V, 3) would be when it is given."""
    like = vertices if like is None else like
    upright, middle, views = find_upright(like), like.mean(axis=0), []
    for angle in np.radians([0.0, 90.0, 180.0, 270.0]):
        c, s = np.cos(angle), np.sin(angle)
        turn = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]) @ upright
        views.append(draw(vertices, faces, colors, turn, middle))
    return np.concatenate(views, axis=1)


def color_fingers(faces: npt.NDArray) -> Array:
    """(F, 3) BGR: a colour for each finger, darker towards the tip."""
    part = np.argmax(untrained_hand().skinning_weights, axis=1)
    palette = np.array([PALM, *(np.array(finger) * share for finger in FINGERS for share in (1.0, 0.85, 0.7))])
    return palette[part][faces].mean(axis=1)


def color_shares(shares: Array) -> Array:
    """(F, 3) BGR of shares (F,) from 0, dark, to 1, yellow; grey where NaN."""
    known = (255 * np.clip(np.nan_to_num(shares), 0.0, 1.0)).astype(np.uint8)
    colors = cv2.applyColorMap(known[:, None], cv2.COLORMAP_VIRIDIS)[:, 0].astype(np.float64)
    colors[np.isnan(shares)] = NOTHING
    return colors


def draw_beside_truth(found: Array, truth: Array, faces: npt.NDArray, most: float) -> npt.NDArray[np.uint8]:
    """A registration (V, 3) above, the true hand in the middle, both by finger; below how far each vertex is off.

    Args:
        most: The distance, m, that is shown in yellow.
    """
    away = np.linalg.norm(found - truth, axis=1) / most
    fingers = color_fingers(faces)
    return np.concatenate([
        draw_four(found, faces, fingers, truth),
        draw_four(truth, faces, fingers, truth),
        draw_four(found, faces, color_shares(away[faces].mean(axis=1)), truth),
    ])  # fmt: skip
