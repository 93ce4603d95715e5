"""Fewer faces for the tracker, with everything that hangs on the vertices carried over."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import fast_simplification
import numpy as np
import numpy.typing as npt
from scipy.spatial import KDTree

from tracker.errors import ModelFileError, TrackerError
from tracker.geometry.triangles import is_watertight
from tracker.model.articulated import ArticulatedModel, HandParts, ShapeBasis
from tracker.model.pose_blend import PoseBlend
from tracker.model.skeleton import Array
from tracker.model.skinning import keep_heaviest

Faces = npt.NDArray[np.int64]

AGGRESSIVENESS: tuple[float, ...] = (7.0, 5.0, 9.0)
"""Tried in turn; below 5 the simplifier gives up early and says nothing."""

COUNT_TOLERANCE = 0.02
"""Share by which the face count reached may exceed the one asked for."""


LEAST_WEIGHT = 0.01
"""Skinning weights below this are dropped: a tenth of a millimetre, but a quarter of the solver's work."""


@dataclass(frozen=True)
class SurfacePoints:
    """Points on a triangle mesh.

    Attributes:
        corners: (N, 3) vertices of the triangle that each point lies on.
        shares: (N, 3) barycentric coordinates.
    """

    corners: npt.NDArray[np.int64]
    shares: Array

    def interpolate(self, values: Array) -> Array:
        """Values (V, ...) on the vertices, at the points: (N, ...)."""
        return np.einsum("nk,nk...->n...", self.shares, values[self.corners])


def decimate(model: ArticulatedModel, max_faces: int, posed: Array | None = None) -> ArticulatedModel:
    """The model with at most `max_faces` faces (2 % more are let through); as it was if it has no more.

    Skinning weights and shape offsets are read off the old surface at the new vertices. Vertices that are joints of a
    hand stay where they were, as vertices that no face uses. A small offset along the normals gives the volume back.

    Args:
        model: Any model.
        max_faces: Faces to keep.
        posed: (V, 3) vertices in the pose whose shape is to be kept, such as a bent hand; the rest pose when left out.
    """
    if len(model.faces) <= max_faces:
        return model
    shape = model.vertices if posed is None else posed
    assert shape.shape == model.vertices.shape
    surface, faces = simplify(shape, model.faces, max_faces)
    landmarks = _landmarks(model)
    where = find_surface_points(surface, shape, model.faces)
    if posed is not None:
        surface = where.interpolate(model.vertices)
    surface = restore_volume(surface, faces, compute_volume(model.vertices, model.faces))
    corners = np.concatenate([where.corners, np.repeat(landmarks[:, None], 3, axis=1)])
    shares = np.concatenate([where.shares, np.tile([1.0, 0.0, 0.0], (len(landmarks), 1))])
    points = SurfacePoints(corners, shares)
    return replace(
        model,
        vertices=np.concatenate([surface, model.vertices[landmarks]]),
        faces=faces,
        skinning_weights=limit_weights(points.interpolate(model.skinning_weights)),
        hand=None if model.hand is None else _transfer_hand(model.hand, points, landmarks, len(surface)),
        shape=None if model.shape is None else _transfer_shape(model.shape, points),
        pose_blend=None if model.pose_blend is None else _transfer_blend(model.pose_blend, points),
    )


def decimate_file(path: Path, model: ArticulatedModel, max_faces: int) -> ArticulatedModel:
    """As `decimate`, for a model that came from this file, which is to blame if it fails."""
    try:
        return decimate(model, max_faces)
    except TrackerError as error:
        raise ModelFileError(path, f"a mesh that cannot be decimated ({error})", f"about {max_faces} faces") from error


def simplify(vertices: Array, faces: Faces, max_faces: int) -> tuple[Array, Faces]:
    """Quadric edge collapse to about `max_faces` faces; a closed mesh stays closed where that can be had.

    Raises:
        TrackerError: The simplifier stopped early whatever its setting.
    """
    reached = len(faces)
    open_mesh: tuple[Array, Faces] | None = None
    for aggressiveness in AGGRESSIVENESS:
        points, triangles, *_ = fast_simplification.simplify(
            np.ascontiguousarray(vertices, dtype=np.float64),
            np.ascontiguousarray(faces, dtype=np.int32),
            target_count=max_faces,
            agg=aggressiveness,
        )
        reached = min(reached, len(triangles))
        if 0 < len(triangles) <= max_faces * (1.0 + COUNT_TOLERANCE):
            found = np.asarray(points, dtype=np.float64), np.asarray(triangles, dtype=np.int64)
            if is_watertight(found[1]) or not is_watertight(faces):
                return found
            open_mesh = open_mesh or found
    if open_mesh is not None:
        return open_mesh
    raise TrackerError(
        f"The mesh of {len(faces)} faces could not be reduced to {max_faces}: the simplifier stopped at {reached}. "
        f"Give a mesh without loose pieces and duplicate vertices, or allow more faces."
    )


def find_surface_points(points: Array, vertices: Array, faces: Faces, num_near: int = 8) -> SurfacePoints:
    """Nearest point of a mesh to each of the points (N, 3), among the faces around the `num_near` nearest vertices."""
    used = np.unique(faces)
    _, near = KDTree(vertices[used]).query(points, k=min(num_near, len(used)))
    near = used[np.asarray(near).reshape(len(points), -1)]
    order = np.argsort(faces.ravel(), kind="stable")
    starts = np.searchsorted(faces.ravel()[order], np.arange(len(vertices) + 1))
    corners, shares = [], []
    for point, ids in zip(points, near, strict=True):
        around = np.unique(np.concatenate([order[starts[v] : starts[v + 1]] for v in ids]) // 3)
        barycentric = closest_on_triangles(point, vertices[faces[around]])
        closest = np.einsum("fk,fkx->fx", barycentric, vertices[faces[around]])
        best = int(np.argmin(np.sum((closest - point) ** 2, axis=1)))
        corners.append(faces[around[best]])
        shares.append(barycentric[best])
    return SurfacePoints(np.array(corners, dtype=np.int64), np.array(shares))


def closest_on_triangles(point: Array, triangles: Array) -> Array:
    """Barycentric coordinates (F, 3) of the point of each triangle (F, 3, 3) nearest to a point (3,)."""
    candidates = [_inside(point, triangles)]
    for a, b in ((0, 1), (1, 2), (2, 0)):
        edge = triangles[:, b] - triangles[:, a]
        length2 = np.maximum(np.einsum("fx,fx->f", edge, edge), 1e-30)
        share = np.clip(np.einsum("fx,fx->f", point - triangles[:, a], edge) / length2, 0.0, 1.0)
        on_edge = np.zeros((len(triangles), 3))
        on_edge[:, a], on_edge[:, b] = 1.0 - share, share
        candidates.append(on_edge)
    stacked = np.stack(candidates)
    distances = np.sum((np.einsum("cfk,fkx->cfx", stacked, triangles) - point) ** 2, axis=2)
    distances[0, np.any(stacked[0] < 0.0, axis=1)] = np.inf
    return stacked[np.argmin(distances, axis=0), np.arange(len(triangles))]


def limit_weights(weights: Array) -> Array:
    """Rows (V, B) with the MAX_WEIGHTS heaviest entries of at least LEAST_WEIGHT kept, summing to one."""
    return keep_heaviest(np.where(weights < LEAST_WEIGHT, 0.0, weights))


def compute_volume(vertices: Array, faces: Faces) -> float:
    """Signed volume inside a closed mesh, m^3; positive when the faces look outwards."""
    a, b, c = vertices[faces[:, 0]], vertices[faces[:, 1]], vertices[faces[:, 2]]
    return float(np.einsum("fx,fx->", a, np.cross(b, c)) / 6.0)


def restore_volume(vertices: Array, faces: Faces, volume: float) -> Array:
    """Vertices moved along their normals by the one distance that gives the mesh this volume, to first order."""
    if not is_watertight(faces):
        return vertices
    crossed = np.cross(
        vertices[faces[:, 1]] - vertices[faces[:, 0]],
        vertices[faces[:, 2]] - vertices[faces[:, 0]],
    )
    normals = np.zeros_like(vertices)
    for corner in range(3):
        np.add.at(normals, faces[:, corner], crossed)
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    normals = np.divide(normals, lengths, out=np.zeros_like(normals), where=lengths > 0)
    area = 0.5 * float(np.linalg.norm(crossed, axis=1).sum())
    return vertices + normals * (volume - compute_volume(vertices, faces)) / area


def _inside(point: Array, triangles: Array) -> Array:
    a, b, c = triangles[:, 0], triangles[:, 1], triangles[:, 2]
    normal = np.cross(b - a, c - a)
    area2 = np.maximum(np.einsum("fx,fx->f", normal, normal), 1e-30)
    v = np.einsum("fx,fx->f", np.cross(point - a, c - a), normal) / area2
    w = np.einsum("fx,fx->f", np.cross(b - a, point - a), normal) / area2
    return np.stack([1.0 - v - w, v, w], axis=1)


def _landmarks(model: ArticulatedModel) -> npt.NDArray[np.int64]:
    if model.hand is None:
        return np.zeros(0, dtype=np.int64)
    return np.unique(model.hand.joint_vertices[model.hand.joint_vertices >= 0])


def _transfer_hand(
    hand: HandParts, points: SurfacePoints, landmarks: npt.NDArray[np.int64], num_surface: int
) -> HandParts:
    source = points.corners[np.arange(len(points.corners)), np.argmax(points.shares, axis=1)]
    joint_vertices = hand.joint_vertices.copy()
    for number, landmark in enumerate(landmarks):
        joint_vertices[hand.joint_vertices == landmark] = num_surface + number

    def carry(ids: npt.NDArray[np.int64]) -> npt.NDArray[np.int64]:
        return np.flatnonzero(np.isin(source[:num_surface], ids))

    return replace(
        hand,
        joint_vertices=joint_vertices,
        fingertips=tuple(carry(ids) for ids in hand.fingertips),
        finger_parts={name: carry(ids) for name, ids in hand.finger_parts.items()},
    )


def _transfer_blend(blend: PoseBlend, points: SurfacePoints) -> PoseBlend:
    flat = points.interpolate(blend.directions.reshape(len(blend.directions), -1))
    return replace(blend, directions=flat.reshape(len(flat), 3, -1))


def _transfer_shape(shape: ShapeBasis, points: SurfacePoints) -> ShapeBasis:
    return replace(shape, vertices=np.stack([points.interpolate(offsets) for offsets in shape.vertices]))
