"""Where a part of a hand is nearest to an object's surface."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from numba import njit

from tracker.model.scene import PosedScene

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class ClosestPoint:
    """The point of a part's skin nearest to an object, or deepest in it, and the point of the object nearest to that.

    Attributes:
        part_corners: (3,) vertices of the scene that span the part's point.
        part_shares: (3,) their barycentric shares.
        part_point: (3,) on the part, world, m.
        corners: (3,) vertices of the scene that span the object's point.
        shares: (3,) their barycentric shares.
        point: (3,) on the object, world, m.
        normal: (3,) unit, out of the object, world.
        distance: m, below 0 when the part is inside the object.
    """

    part_corners: npt.NDArray[np.int32]
    part_shares: Array
    part_point: Array
    corners: npt.NDArray[np.int32]
    shares: Array
    point: Array
    normal: Array
    distance: float

    @property
    def vertex(self) -> int:
        """Of the scene; the part's vertex nearest to its point."""
        return int(self.part_corners[np.argmax(self.part_shares)])


def find_closest_point(posed: PosedScene, hand: int, part: str, target: int) -> ClosestPoint:
    """The nearest pair of a point of a finger part and a point of an object's surface.

    Looked for are the part's vertices against the object's faces, exact for a closed object, and then the object's
    vertices against the part's faces, since a flat pad touches a round thing between its vertices. Two edges that
    cross in the air are the one case that is missed.

    Inside is where a vertex of the part lies behind the object's normals, interpolated at the nearest point, or a
    vertex of the object behind the part's. An object with holes has an inside only near its surface.

    Args:
        posed: The scene.
        hand: Index of the hand among the scene's models.
        part: One of its finger parts.
        target: Index of the object among the scene's models.
    """
    scene = posed.scene
    parts = scene.models[hand].hand
    assert parts is not None and len(parts.finger_parts.get(part, ())), f"no finger part {part!r}"
    ids = parts.finger_parts[part].astype(np.int64) + scene.vertex_slices[hand].start
    where = scene.vertex_slices[target]
    faces = scene.models[target].faces.astype(np.int64) + where.start
    shares, vertices, normals = np.zeros(3), posed.vertices, posed.normals
    place, face, distance = _find_into(shares, vertices, normals, ids, faces)
    part_corners, part_shares, corners = np.full(3, ids[place]), np.array([1.0, 0.0, 0.0]), faces[face]
    if distance > 0.0:
        skin = scene.models[hand].faces.astype(np.int64) + scene.vertex_slices[hand].start
        on_part = np.zeros(3)
        vertex, face, between = _find_on_part(
            on_part,
            vertices,
            normals,
            ids,
            skin,
            where.start,
            where.start + len(scene.models[target].vertices),
            distance,
        )
        if vertex >= 0:
            distance, part_corners, part_shares = between, skin[face], on_part
            corners, shares = np.full(3, vertex), np.array([1.0, 0.0, 0.0])
    normal = shares @ normals[corners]
    return ClosestPoint(
        part_corners.astype(np.int32),
        part_shares,
        part_shares @ vertices[part_corners],
        corners.astype(np.int32),
        shares,
        shares @ vertices[corners],
        normal / max(float(np.linalg.norm(normal)), 1e-12),
        float(distance),
    )


@njit(cache=True, nogil=True)
def _find_on_part(shares, vertices, normals, ids, faces, first, last, limit):
    """The vertex of an object nearer to a part's faces than `limit`, the face, their signed distance; or -1.

    The barycentric shares (3,) on the face are filled.
    """
    center, radius = np.zeros(3), 0.0
    is_part = np.zeros(ids.max() + 1, dtype=np.bool_)
    for place in ids:
        is_part[place] = True
        for axis in range(3):
            center[axis] += vertices[place, axis] / len(ids)
    for place in ids:
        squared = 0.0
        for axis in range(3):
            squared += (vertices[place, axis] - center[axis]) ** 2
        radius = max(radius, np.sqrt(squared))
    own = np.empty(len(faces), dtype=np.int64)
    count = 0
    for f in range(len(faces)):
        inside = True
        for corner in range(3):
            v = faces[f, corner]
            inside = inside and v < len(is_part) and is_part[v]
        if inside:
            own[count] = f
            count += 1
    trial = np.zeros(3)
    best_vertex, best_face, best = -1, -1, limit
    for vertex in range(first, last):
        p = vertices[vertex]
        squared = 0.0
        for axis in range(3):
            squared += (p[axis] - center[axis]) ** 2
        if squared >= (radius + best) ** 2:
            continue
        for f in own[:count]:
            a, b, c = vertices[faces[f, 0]], vertices[faces[f, 1]], vertices[faces[f, 2]]
            distance = np.sqrt(_closest_on_triangle(trial, p, a, b, c))
            if distance < best:
                best_vertex, best_face, best = vertex, f, distance
                shares[0], shares[1], shares[2] = trial[0], trial[1], trial[2]
    if best_vertex < 0:
        return best_vertex, best_face, best
    side = 0.0
    for axis in range(3):
        point, normal = 0.0, 0.0
        for corner in range(3):
            point += shares[corner] * vertices[faces[best_face, corner], axis]
            normal += shares[corner] * normals[faces[best_face, corner], axis]
        side += (vertices[best_vertex, axis] - point) * normal
    return best_vertex, best_face, -best if side < 0.0 else best


@njit(cache=True, nogil=True)
def _find_into(shares, vertices, normals, ids, faces):
    """The place in ids, the face and the signed distance of the nearest pair; its barycentric shares (3,) are filled.

    Faces whose bounding sphere is farther than the best so far are passed over. So are vertices too near to one that
    was far: from one point to another the signed distance changes by no more than the way between them.
    """
    count = len(faces)
    centers, radii = np.zeros((count, 3)), np.zeros(count)
    for f in range(count):
        for corner in range(3):
            for axis in range(3):
                centers[f, axis] += vertices[faces[f, corner], axis] / 3.0
        for corner in range(3):
            squared = 0.0
            for axis in range(3):
                squared += (vertices[faces[f, corner], axis] - centers[f, axis]) ** 2
            radii[f] = max(radii[f], np.sqrt(squared))
    trial, own = np.zeros(3), np.zeros(3)
    best_place, best_face, best_distance = 0, 0, np.inf
    known = np.full(len(ids), -np.inf)
    for place in range(len(ids)):
        p = vertices[ids[place]]
        is_farther = False
        for before in range(place):
            if known[before] > best_distance:
                q = vertices[ids[before]]
                way = np.sqrt((p[0] - q[0]) ** 2 + (p[1] - q[1]) ** 2 + (p[2] - q[2]) ** 2)
                if known[before] - way >= best_distance:
                    is_farther = True
                    break
        if is_farther:
            continue
        nearest, nearest_face = np.inf, -1
        for f in range(count):
            squared = 0.0
            for axis in range(3):
                squared += (p[axis] - centers[f, axis]) ** 2
            if squared >= (nearest + radii[f]) ** 2:
                continue
            a, b, c = vertices[faces[f, 0]], vertices[faces[f, 1]], vertices[faces[f, 2]]
            distance = np.sqrt(_closest_on_triangle(trial, p, a, b, c))
            if distance < nearest:
                nearest, nearest_face = distance, f
                own[0], own[1], own[2] = trial[0], trial[1], trial[2]
        side = 0.0
        for axis in range(3):
            point, normal = 0.0, 0.0
            for corner in range(3):
                point += own[corner] * vertices[faces[nearest_face, corner], axis]
                normal += own[corner] * normals[faces[nearest_face, corner], axis]
            side += (p[axis] - point) * normal
        signed = -nearest if side < 0.0 else nearest
        known[place] = signed
        if signed < best_distance:
            best_place, best_face, best_distance = place, nearest_face, signed
            shares[0], shares[1], shares[2] = own[0], own[1], own[2]
    return best_place, best_face, best_distance


@njit(cache=True, nogil=True)
def _closest_on_triangle(shares, p, a, b, c):
    """Fill the barycentric shares of the point of a triangle nearest to p; its squared distance."""
    abx, aby, abz = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    acx, acy, acz = c[0] - a[0], c[1] - a[1], c[2] - a[2]
    apx, apy, apz = p[0] - a[0], p[1] - a[1], p[2] - a[2]
    bb, cc = abx * abx + aby * aby + abz * abz, acx * acx + acy * acy + acz * acz
    bc = abx * acx + aby * acy + abz * acz
    pb, pc = apx * abx + apy * aby + apz * abz, apx * acx + apy * acy + apz * acz
    area = bb * cc - bc * bc
    v, w = -1.0, -1.0
    if area > 0.0:
        v, w = (cc * pb - bc * pc) / area, (bb * pc - bc * pb) / area
    if v < 0.0 or w < 0.0 or v + w > 1.0:
        # The nearest point is on an edge: the best of the three.
        best = np.inf
        edge = bb - 2.0 * bc + cc
        for side in range(3):
            if side == 0:
                tv, tw = min(max(pb / bb if bb > 0.0 else 0.0, 0.0), 1.0), 0.0
            elif side == 1:
                tv, tw = 0.0, min(max(pc / cc if cc > 0.0 else 0.0, 0.0), 1.0)
            else:
                tw = min(max((bb - bc + pc - pb) / edge if edge > 0.0 else 0.0, 0.0), 1.0)
                tv = 1.0 - tw
            dx, dy, dz = apx - tv * abx - tw * acx, apy - tv * aby - tw * acy, apz - tv * abz - tw * acz
            squared = dx * dx + dy * dy + dz * dz
            if squared < best:
                best, v, w = squared, tv, tw
    shares[0], shares[1], shares[2] = 1.0 - v - w, v, w
    dx, dy, dz = apx - v * abx - w * acx, apy - v * aby - w * acy, apz - v * abz - w * acz
    return dx * dx + dy * dy + dz * dz
