"""The colour image of a synthetic recording: shaded surfaces before a plain background."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from tracker.geometry import se3
from tracker.synthesis.performance import Moment, Performance

Array = npt.NDArray[np.float64]

SKIN = (0.66, 0.36, 0.24)
"""Albedo of hands, linear light; shaded, it stays within what Jones and Rehg's mixtures call skin."""

OBJECT_COLORS = ((0.05, 0.35, 0.12), (0.06, 0.16, 0.45), (0.30, 0.32, 0.33), (0.22, 0.08, 0.36))
"""Albedos of objects, linear light, none of them skin."""

BACKGROUND = (0.018, 0.045, 0.060)
"""Linear light of what is behind."""

AMBIENT = 0.45
"""Share of light that comes from everywhere; the rest comes from the camera."""

SENSOR_STD = 2.0
"""Standard deviation of the noise of a colour channel, levels of 255."""


def compute_cosines(performance: Performance, moment: Moment) -> Array:
    """Cosine (H, W) between the normal of the face seen and the direction to the camera; 0 where nothing is."""
    camera = performance.camera
    corners = se3.transform(camera.T_camera_world, moment.vertices)[performance.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    rows, columns = np.nonzero(moment.face >= 0)
    rays = np.stack(
        [
            (columns - camera.K[0, 2]) / camera.K[0, 0],
            (rows - camera.K[1, 2]) / camera.K[1, 1],
            np.ones(len(rows)),
        ],
        axis=1,
    )
    rays /= np.linalg.norm(rays, axis=1, keepdims=True)
    cosines = np.zeros(moment.face.shape)
    cosines[rows, columns] = np.abs(np.einsum("ni,ni->n", normals[moment.face[rows, columns]], rays))
    return cosines


def shade(
    performance: Performance, moment: Moment, cosines: Array, rng: np.random.Generator | None
) -> npt.NDArray[np.uint8]:
    """Colour image (H, W, 3) RGB of a moment, lit from the camera; `rng` adds sensor noise to the surfaces."""
    image = np.empty((*moment.face.shape, 3), dtype=np.uint8)
    image[:] = np.rint(encode(np.array(BACKGROUND))).astype(np.uint8)
    rows, columns = np.nonzero(moment.face >= 0)
    albedos = np.array([actor.albedo for actor in performance.actors])
    albedo = albedos[performance.face_actors[moment.face[rows, columns]]]
    light = AMBIENT + (1.0 - AMBIENT) * cosines[rows, columns]
    levels = encode(albedo * light[:, None])
    if rng is not None:
        levels += rng.normal(0.0, SENSOR_STD, levels.shape)
    image[rows, columns] = np.clip(np.rint(levels), 0, 255).astype(np.uint8)
    return image


def encode(linear: Array) -> Array:
    """Linear light in 0..1 to levels of 255, with a display's exponent of 2.2."""
    return 255.0 * np.clip(linear, 0.0, 1.0) ** (1.0 / 2.2)
