"""The surface of the untrained hand: the default hand, open at the wrist, with evener triangles."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import trimesh

from tracker.model.articulated import ArticulatedModel

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

STUB = 0.010
"""Forearm that is left behind the wrist, m."""
LONGEST = 0.015
"""Longer edges are halved, m."""
SHORTEST = 0.0035
"""Shorter edges are closed, m."""
ROUNDS = 5
FOLD = 0.85
"""Cosine between a triangle's normal and that of the surface there, below which a change is left undone."""


def open_surface(hand: ArticulatedModel) -> tuple[Array, Ints, Ints]:
    """Vertices (V, 3), faces (F, 3) and the (5,) tips of a hand cut off square to the forearm.

    The default hand is decimated for tracking: here and there it has slivers, which a free surface is pulled into folds
    by. Edges are halved, closed and turned, and vertices moved along the surface, until the triangles are even.
    """
    assert hand.hand is not None
    marks = hand.vertices[hand.hand.joint_vertices[hand.hand.joint_vertices >= 0]]
    mesh = trimesh.Trimesh(hand.vertices, hand.faces, process=False)
    mesh.remove_unreferenced_vertices()
    parts = trimesh.intersections.slice_faces_plane(
        mesh.vertices, mesh.faces, np.array([1.0, 0.0, 0.0]), np.array([-STUB, 0.0, 0.0])
    )
    cut = trimesh.Trimesh(parts[0], parts[1])
    vertices, faces = np.asarray(cut.vertices, dtype=np.float64), np.asarray(cut.faces, dtype=np.int64)
    for _ in range(ROUNDS):
        vertices, faces = _halve(vertices, faces)
        vertices, faces = _close(vertices, faces)
        faces = _turn(vertices, _drop_ears(faces))
        vertices = _relax(vertices, faces, mesh)
        vertices[_nearest(vertices, marks)] = marks
    used, flat = np.unique(faces, return_inverse=True)
    vertices = vertices[used]
    return vertices, flat.reshape(-1, 3), _nearest(vertices, marks)


def boundary_loop(faces: Ints) -> Ints:
    """The one closed loop of boundary vertices, in the order of the faces' edges."""
    directed = faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    present = {(int(a), int(b)) for a, b in directed}
    following = {a: b for a, b in present if (b, a) not in present}
    loop = [next(iter(following))]
    while following[loop[-1]] != loop[0]:
        loop.append(following[loop[-1]])
    assert len(loop) == len(following), "the boundary is not one loop"
    return np.array(loop)


def _nearest(vertices: Array, marks: Array) -> Ints:
    return np.argmin(np.linalg.norm(vertices[:, None] - marks, axis=2), axis=0)


def _edges(faces: Ints) -> dict[tuple[int, int], list[int]]:
    """Faces of each edge."""
    edges: dict[tuple[int, int], list[int]] = {}
    for f, (a, b, c) in enumerate(faces.tolist()):
        for edge in ((a, b), (b, c), (c, a)):
            edges.setdefault((min(edge), max(edge)), []).append(f)
    return edges


def _drop_ears(faces: Ints) -> Ints:
    """Faces without those that hang on the surface by one edge."""
    edges = _edges(faces)
    free = np.zeros(len(faces), dtype=np.int64)
    for around in edges.values():
        if len(around) == 1:
            free[around[0]] += 1
    return faces[free < 2]


def _halve(vertices: Array, faces: Ints) -> tuple[Array, Ints]:
    points, triangles = list(vertices), faces.tolist()
    touched: set[int] = set()
    lengths = sorted(((float(np.linalg.norm(vertices[a] - vertices[b])), a, b) for a, b in _edges(faces)), reverse=True)
    owners = _edges(faces)
    for length, a, b in lengths:
        if length < LONGEST:
            break
        around = owners[a, b]
        if touched & set(around):
            continue
        touched |= set(around)
        new = len(points)
        points.append(0.5 * (vertices[a] + vertices[b]))
        for f in around:
            triangle = triangles[f]
            triangles[f] = [new if v == b else v for v in triangle]
            triangles.append([new if v == a else v for v in triangle])
    return np.array(points), np.array(triangles)


def _close(vertices: Array, faces: Ints) -> tuple[Array, Ints]:
    loop = set(boundary_loop(faces).tolist())
    neighbours: dict[int, set[int]] = {}
    owners = _edges(faces)
    for a, b in owners:
        neighbours.setdefault(a, set()).add(b)
        neighbours.setdefault(b, set()).add(a)
    target = np.arange(len(vertices))
    vertices, busy = vertices.copy(), set()
    for (a, b), around in owners.items():
        if np.linalg.norm(vertices[a] - vertices[b]) > SHORTEST or (a in loop and b in loop and len(around) == 2):
            continue
        close = {a, b} | neighbours[a] | neighbours[b]
        if busy & close or len(neighbours[a] & neighbours[b]) != len(around):
            continue
        busy |= close
        if (a in loop) == (b in loop):
            vertices[[a, b]] = 0.5 * (vertices[a] + vertices[b])
        target[b if a in loop or b not in loop else a] = a if a in loop or b not in loop else b
    faces = target[faces]
    distinct = (faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 2] != faces[:, 0])
    return vertices, faces[distinct]


def _turn(vertices: Array, faces: Ints) -> Ints:
    """Turn edges where the smallest angle of the two triangles grows and the surface does not fold."""
    triangles = faces.tolist()
    for _ in range(4):
        turned, busy = 0, set()
        owners = _edges(np.array(triangles))
        for (a, b), around in owners.items():
            if len(around) != 2 or busy & set(around):
                continue
            first, second = (triangles[f] for f in around)
            if first[(first.index(a) + 1) % 3] != b:
                first, second = second, first
            c = next(v for v in first if v not in (a, b))
            d = next(v for v in second if v not in (a, b))
            if (min(c, d), max(c, d)) in owners:
                continue
            old, new = [(a, b, c), (b, a, d)], [(a, d, c), (d, b, c)]
            if _least_angle(vertices, new) > _least_angle(vertices, old) + 1e-3 and _is_flat(vertices, old, new):
                busy |= set(around)
                for f, triangle in zip(around, new, strict=True):
                    triangles[f] = list(triangle)
                turned += 1
        if not turned:
            break
    return np.array(triangles)


def _least_angle(vertices: Array, triangles: list) -> float:
    least = np.pi
    for triangle in triangles:
        for n in range(3):
            p, q, r = (vertices[triangle[(n + k) % 3]] for k in range(3))
            u, w = q - p, r - p
            least = min(least, float(np.arctan2(np.linalg.norm(np.cross(u, w)), u @ w)))
    return least


def _is_flat(vertices: Array, old: list, new: list) -> bool:
    def normals(triangles: list) -> Array:
        crossed = np.array([np.cross(vertices[b] - vertices[a], vertices[c] - vertices[a]) for a, b, c in triangles])
        return crossed / np.maximum(np.linalg.norm(crossed, axis=1, keepdims=True), 1e-15)

    before, after = normals(old), normals(new)
    return bool(before[0] @ before[1] > FOLD and (after @ before.sum(axis=0) > FOLD * 2.0 * FOLD).all())


def _relax(vertices: Array, faces: Ints, surface: trimesh.Trimesh) -> Array:
    """Move each vertex along the surface towards the middle of its neighbours; the boundary along itself."""
    loop = boundary_loop(faces)
    sums, counts = np.zeros_like(vertices), np.zeros(len(vertices))
    edges = np.array(list(_edges(faces)))
    for a, b in ((0, 1), (1, 0)):
        np.add.at(sums, edges[:, a], vertices[edges[:, b]])
        np.add.at(counts, edges[:, a], 1.0)
    middle = sums / np.maximum(counts, 1.0)[:, None]
    middle[loop] = 0.5 * (vertices[np.roll(loop, 1)] + vertices[np.roll(loop, -1)])
    normals = np.zeros_like(vertices)
    crossed = np.cross(vertices[faces[:, 1]] - vertices[faces[:, 0]], vertices[faces[:, 2]] - vertices[faces[:, 0]])
    for corner in range(3):
        np.add.at(normals, faces[:, corner], crossed)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-15)
    step = 0.4 * (middle - vertices)
    moved = vertices + step - np.einsum("vx,vx->v", step, normals)[:, None] * normals
    moved[loop] = vertices[loop] + step[loop]
    moved = _closest(surface, moved)
    moved[loop, 0] = -STUB
    return moved


def _closest(surface: trimesh.Trimesh, points: Array, tried: int = 150) -> Array:
    """(N, 3) the nearest points of the surface, among the triangles whose middles are nearest."""
    away = np.linalg.norm(points[:, None] - surface.triangles_center, axis=2)
    near = np.argsort(away, axis=1)[:, :tried]
    found = trimesh.triangles.closest_point(surface.triangles[near.ravel()], np.repeat(points, tried, axis=0)).reshape(
        len(points), tried, 3
    )
    best = np.linalg.norm(found - points[:, None], axis=2).argmin(axis=1)
    return found[np.arange(len(points)), best]
