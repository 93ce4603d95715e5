"""Colour images with skin and walls that are not plain, so that they have edges and optical flow."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import cv2
import numpy as np
import numpy.typing as npt
from scipy.ndimage import map_coordinates

from tracker.geometry import se3
from tracker.synthesis.nail_paint import NailPaint
from tracker.synthesis.performance import Moment, Performance
from tracker.synthesis.shading import AMBIENT, BACKGROUND, SENSOR_STD, encode

Array = npt.NDArray[np.float64]

CELLS = 32
"""Cells after which the volume of noise repeats."""

OCTAVES = 4
"""Each twice as coarse as the one before."""

TOWARDS_LIGHT = np.array([0.3, -0.8, -0.52])
"""World; a lamp above and before the first camera's subject."""

WALL_CELLS = (9, 30, 90, 270)
"""px, of the patches on the wall."""

LENS_BLUR = 0.6
"""Standard deviation of the lens's and the pixel's spread, px."""


@dataclass(frozen=True)
class Texture:
    """A pattern that sticks to surfaces, and a still wall behind each camera.

    Attributes:
        seed: Of both.
        grain: Size of the finest spots, m.
        contrast: Standard deviation of a surface's albedo, share of it.
        wall_contrast: The same of the wall.
        nails: Colours of the finger nails; None leaves skin there.
    """

    seed: int = 0
    grain: float = 0.002
    contrast: float = 0.12
    wall_contrast: float = 0.35
    nails: NailPaint | None = None

    def shade(self, performance: Performance, moment: Moment, rng: np.random.Generator | None) -> npt.NDArray[np.uint8]:
        """Colour image (H, W, 3) RGB of a moment, lit by a lamp that stands still; `rng` adds sensor noise."""
        camera = performance.camera
        levels = _paint_wall(camera.id, camera.width, camera.height, self.seed, self.wall_contrast).copy()
        rows, columns = np.nonzero(moment.face >= 0)
        faces = moment.face[rows, columns]
        shares = _find_shares(performance, moment, rows, columns)
        corners = performance.faces[faces]
        rest = np.concatenate([actor.model.vertices for actor in performance.actors])
        places = np.einsum("nc,nci->ni", shares, rest[corners])
        owner = performance.face_actors[faces]
        spots = 1.0 + self.contrast * _sample(places / self.grain + 7.3 * owner[:, None], self.seed)
        normals = np.einsum("nc,nci->ni", shares, _vertex_normals(moment.vertices, performance.faces)[corners])
        normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
        towards = TOWARDS_LIGHT / np.linalg.norm(TOWARDS_LIGHT)
        light = AMBIENT + (1.0 - AMBIENT) * np.maximum(normals @ towards, 0.0)
        albedos = np.array([actor.albedo for actor in performance.actors])[owner]
        if self.nails is not None:
            self.nails.cover(performance.actors, owner, places, albedos, spots)
        levels[rows, columns] = encode(albedos * (light * np.maximum(spots, 0.05))[:, None])
        image = cv2.GaussianBlur(levels, (0, 0), LENS_BLUR)
        if rng is not None:
            image += SENSOR_STD * rng.standard_normal(image.shape, dtype=np.float32)
        return np.clip(np.rint(image), 0, 255).astype(np.uint8)


def _find_shares(
    performance: Performance, moment: Moment, rows: npt.NDArray[np.int64], columns: npt.NDArray[np.int64]
) -> Array:
    """(N, 3) shares of the corners of the face that each pixel shows, where its ray meets the face."""
    camera = performance.camera
    corners = se3.transform(camera.T_camera_world, moment.vertices)[performance.faces[moment.face[rows, columns]]]
    rays = np.column_stack(
        [(columns - camera.K[0, 2]) / camera.K[0, 0], (rows - camera.K[1, 2]) / camera.K[1, 1], np.ones(len(rows))]
    )
    points = rays * moment.depth[rows, columns, None]
    a, u, v = corners[:, 0], corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    normal = np.cross(u, v)
    square = np.maximum(np.einsum("ni,ni->n", normal, normal), 1e-24)
    beside = points - a
    b = np.einsum("ni,ni->n", np.cross(beside, v), normal) / square
    c = np.einsum("ni,ni->n", np.cross(u, beside), normal) / square
    return np.column_stack([1.0 - b - c, b, c])


def _vertex_normals(vertices: Array, faces: npt.NDArray[np.int32]) -> Array:
    """(V, 3) sums of the normals of a vertex's faces, by area."""
    corners = vertices[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    sums = np.zeros_like(vertices)
    for corner in range(3):
        np.add.at(sums, faces[:, corner], normals)
    return sums


@lru_cache(maxsize=2)
def _volume(seed: int) -> npt.NDArray[np.float32]:
    """(CELLS, CELLS, CELLS) standard normal."""
    return np.random.default_rng([seed, 1]).standard_normal((CELLS, CELLS, CELLS), dtype=np.float32)


def _sample(places: Array, seed: int) -> Array:
    """(N,) smooth noise of standard deviation near 1 at places (N, 3), in cells of the finest octave."""
    volume = _volume(seed)
    total = np.zeros(len(places))
    for octave in range(OCTAVES):
        at = (places / 2.0**octave + 11.0 * octave).T % CELLS
        total += map_coordinates(volume, at, order=1, mode="grid-wrap", output=np.float64)
    return total / np.sqrt(OCTAVES * 0.3)


@lru_cache(maxsize=16)
def _paint_wall(camera_id: str, width: int, height: int, seed: int, contrast: float) -> npt.NDArray[np.float32]:
    """(H, W, 3) levels of a wall that stands still behind a camera's subject."""
    rng = np.random.default_rng([seed, 2, *camera_id.encode()])
    pattern = np.zeros((height, width, 3))
    for cells in WALL_CELLS:
        shape = height // cells + 3, width // cells + 3
        both = rng.standard_normal((*shape, 1)) + 0.4 * rng.standard_normal((*shape, 3))
        pattern += cv2.resize(both, None, fx=cells, fy=cells, interpolation=cv2.INTER_CUBIC)[:height, :width]
    linear = 2.0 * np.array(BACKGROUND) * np.exp(contrast * pattern / np.sqrt(len(WALL_CELLS)))
    return encode(linear).astype(np.float32)
