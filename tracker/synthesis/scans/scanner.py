"""What a scanner with five stereo heads makes of a surface: points with noise where two of its eyes see it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.rendering.zbuffer import render_depth
from tracker.synthesis.scans.tissue import vertex_normals

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

LEAST_COSINE = 0.22
"""Surfaces seen at a flatter angle give no points."""

ELEVATIONS_DEG = (18.0, -12.0, 22.0, -8.0, 14.0)
"""Of the heads above the middle, in turn."""


@dataclass(frozen=True)
class Scanner:
    """How a scan is made.

    Attributes:
        num_points: Of the scan.
        noise: Standard deviation of a point's error along the normal, m; [R17] 3.1 has 0.2 mm.
        normal_noise_deg: Standard deviation of a normal's error, about each of two axes.
        views: Number of heads, around the axis of the hand.
        holes: Fewest and most holes besides what no head sees.
        hole_radius: Least and greatest, m.
        distance: From a head to what it looks at, m.
        pixels: Width and height of the images that decide what a head sees; one is about 0.5 mm wide on a hand.
    """

    num_points: int = 50_000
    noise: float = 0.2e-3
    normal_noise_deg: float = 4.0
    views: int = 5
    holes: tuple[int, int] = (2, 5)
    hole_radius: tuple[float, float] = (3e-3, 8e-3)
    distance: float = 0.60
    pixels: int = 560


@dataclass(frozen=True)
class ScannedPoints:
    """Points of a scan in the coordinates of the surface.

    Attributes:
        points: (N, 3) m, with noise.
        normals: (N, 3) unit, with noise.
        faces: (N,) the face that each lies on.
    """

    points: Array
    normals: Array
    faces: Ints


def scan_surface(
    vertices: Array, faces: Ints, is_kept: npt.NDArray[np.bool_], scanner: Scanner, rng: np.random.Generator
) -> ScannedPoints:
    """Scan a surface; of the faces only those of is_kept (F,) can give points, but all of them hide others."""
    areas, normals = face_areas(vertices, faces)
    areas = np.where(is_kept, areas, 0.0)
    smooth = vertex_normals(vertices, faces)
    # First half as many again as wanted, then as many as it takes.
    wanted = scanner.num_points
    heads = place_heads(vertices, scanner, rng)
    images = [_look(vertices, faces, head) for head in heads]
    holes = _make_holes(vertices, faces, areas, scanner, rng)
    kept: list[tuple[Array, Array, Ints]] = []
    count, drawn = 0, 0
    while count < wanted:
        draws = int(1.9 * (wanted - count)) + 2000 if count == 0 else int(1.1 * (wanted - count) * drawn / count) + 500
        face, points, shares = _draw(vertices, faces, areas, draws, rng)
        normal = np.einsum("nk,nkx->nx", shares, smooth[faces[face]])
        normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-20)
        is_seen = np.zeros(draws, dtype=bool)
        for head, depth in zip(heads, images, strict=True):
            is_seen |= _is_seen(points, normals[face], head, depth)
        in_hole = np.zeros(draws, dtype=bool)
        for center, radius in holes:
            in_hole |= np.sum((points - center) ** 2, axis=1) < radius**2
        good = is_seen & ~in_hole
        kept.append((points[good], normal[good], face[good]))
        count, drawn = count + int(good.sum()), drawn + draws
        if drawn > 40 * wanted:
            break
    points, normal, face = (np.concatenate(parts)[:wanted] for parts in zip(*kept, strict=True))
    noisy = points + scanner.noise * rng.standard_normal(len(points))[:, None] * normal
    tilted = normal + np.tan(np.radians(scanner.normal_noise_deg)) * rng.standard_normal(normal.shape)
    tilted /= np.linalg.norm(tilted, axis=1, keepdims=True)
    return ScannedPoints(noisy, tilted, face)


@dataclass(frozen=True)
class Head:
    """A camera: rotation (3, 3) surface to camera, its centre (3,), K (3, 3) px, width and height of its image."""

    R: Array
    center: Array
    K: Array
    pixels: int


def place_heads(vertices: Array, scanner: Scanner, rng: np.random.Generator) -> list[Head]:
    """Heads around the long axis of what they look at, at slightly different heights, turned by chance."""
    middle = 0.5 * (vertices.min(axis=0) + vertices.max(axis=0))
    reach = float(np.linalg.norm(vertices - middle, axis=1).max())
    pixels, count = scanner.pixels, scanner.views
    focal = 0.47 * pixels * (scanner.distance - reach) / reach
    K = np.array([[focal, 0.0, 0.5 * (pixels - 1)], [0.0, focal, 0.5 * (pixels - 1)], [0.0, 0.0, 1.0]])
    start = rng.uniform(0.0, 2.0 * np.pi)
    heads = []
    for number in range(count):
        around = start + 2.0 * np.pi * number / count + rng.normal(0.0, 0.08)
        up = np.radians(ELEVATIONS_DEG[number % len(ELEVATIONS_DEG)] + rng.normal(0.0, 3.0))
        away = np.array([np.sin(up), np.cos(up) * np.cos(around), np.cos(up) * np.sin(around)])
        z = -away
        x = np.cross([1.0, 0.0, 0.0], z)
        x /= np.linalg.norm(x)
        heads.append(Head(np.stack([x, np.cross(z, x), z]), middle + scanner.distance * away, K, pixels))
    return heads


def _look(vertices: Array, faces: Ints, head: Head) -> Array:
    local = (vertices - head.center) @ head.R.T
    return render_depth(local, faces.astype(np.int32), head.K, head.pixels, head.pixels).depth


def _is_seen(points: Array, normals: Array, head: Head, depth: Array) -> npt.NDArray[np.bool_]:
    """Whether nothing lies before points (N, 3) with normals (N, 3) and they face the head."""
    local = (points - head.center) @ head.R.T
    cosine = np.einsum("nx,nx->n", head.center - points, normals) / np.linalg.norm(local, axis=1)
    pixel = np.rint(head.K[0, 0] * local[:, :2] / local[:, 2:] + head.K[0, 2]).astype(np.int64)
    inside = np.all((pixel >= 0) & (pixel < head.pixels), axis=1)
    column, row = np.clip(pixel, 0, head.pixels - 1).T
    front = depth[row, column]
    # A pixel's middle lies up to 0.7 pixel from the point, where a slanted surface is nearer or farther.
    slope = np.sqrt(np.maximum(1.0 - cosine**2, 0.0)) / np.maximum(cosine, 0.05)
    allowed = 0.3e-3 + 0.75 * slope * local[:, 2] / head.K[0, 0]
    return inside & (cosine > LEAST_COSINE) & ((front == 0.0) | (local[:, 2] <= front + allowed))


def _make_holes(
    vertices: Array, faces: Ints, areas: Array, scanner: Scanner, rng: np.random.Generator
) -> list[tuple[Array, float]]:
    count = int(rng.integers(scanner.holes[0], scanner.holes[1] + 1))
    _, centers, _ = _draw(vertices, faces, areas, count, rng)
    return [(center, float(rng.uniform(*scanner.hole_radius))) for center in centers]


def face_areas(vertices: Array, faces: Ints) -> tuple[Array, Array]:
    """(F,) areas m^2 and (F, 3) unit normals."""
    a, b, c = vertices[faces[:, 0]], vertices[faces[:, 1]], vertices[faces[:, 2]]
    crossed = np.cross(b - a, c - a)
    lengths = np.linalg.norm(crossed, axis=1)
    return 0.5 * lengths, crossed / np.maximum(lengths, 1e-20)[:, None]


def _draw(
    vertices: Array, faces: Ints, areas: Array, count: int, rng: np.random.Generator
) -> tuple[Ints, Array, Array]:
    """Faces (N,), points (N, 3) and barycentric coordinates (N, 3) spread evenly by chance."""
    ends = np.cumsum(areas)
    face = np.minimum(np.searchsorted(ends, rng.uniform(0.0, ends[-1], count), side="right"), len(faces) - 1)
    root, other = np.sqrt(rng.uniform(size=count)), rng.uniform(size=count)
    shares = np.stack([1.0 - root, root * (1.0 - other), root * other], axis=1)
    return face, np.einsum("nk,nkx->nx", shares, vertices[faces[face]]), shares
