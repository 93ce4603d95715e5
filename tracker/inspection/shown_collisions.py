"""Where parts of a posed scene stand in each other, as people look at it."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.geometry.exits import find_distance
from tracker.model.scene import PosedScene
from tracker.terms.colliding_parts import find_crossings
from tracker.terms.penetration import find_swallowed

Points = npt.NDArray[np.float32]


@dataclass(frozen=True)
class CollidingPair:
    """Two parts that collide.

    Attributes:
        first, second: Their names.
        crossings: Pairs of triangles of theirs that cross.
        depth: The deepest that a vertex of one is in the other, m.
        deepest_at: (3,) that vertex, world, m; the origin where no vertex is inside.
    """

    first: str
    second: str
    crossings: int
    depth: float
    deepest_at: Points


@dataclass(frozen=True)
class ShownCollisions:
    """What the collision term sees, [T16] §3.2.4.

    Attributes:
        triangles: (C, 3, 3) corners of the triangles that cross others, each once, world, m.
        vertices: (N, 3) vertices inside a part that they may not enter, world, m.
        depths: (N,) their distance to the surface there, m.
        pairs: Parts that collide, the deepest first.
    """

    triangles: Points
    vertices: Points
    depths: npt.NDArray[np.float32]
    pairs: tuple[CollidingPair, ...]


def show_collisions(posed: PosedScene, part_names: tuple[str, ...]) -> ShownCollisions:
    """Crossing triangles and penetrating vertices of a posed scene.

    Args:
        posed: The scene.
        part_names: (B,) of the scene's bones.
    """
    found = find_crossings(posed)
    parts, fitted = found.parts, found.fitted
    inside = find_swallowed(posed, found, on_crossing_triangles=True)
    groups = parts.tree.groups.tolist()
    crossings: dict[tuple[int, int], int] = defaultdict(int)
    deepest: dict[tuple[int, int], int] = {}
    for first, second in found.pairs.tolist():
        a, b = sorted((groups[first], groups[second]))
        crossings[a, b] += 1
    depths = np.zeros(len(inside.ids), dtype=np.float32)
    for place, (vertex, receiver) in enumerate(zip(inside.ids, inside.receivers, strict=True)):
        own, other = int(parts.vertex_groups[vertex]), groups[receiver]
        model = int(np.searchsorted(parts.model_starts, other, side="right")) - 1
        start, stop = parts.model_starts[model], parts.model_starts[model + 1]
        may_meet = parts.vertices_may_meet[vertex]
        depths[place] = find_distance(fitted, may_meet, own, start, stop, posed.vertices[vertex])
        key = min(own, other), max(own, other)
        if key not in deepest or depths[place] > depths[deepest[key]]:
            deepest[key] = place
    vertices = posed.vertices[inside.ids].astype(np.float32)
    pairs = []
    for key in crossings.keys() | deepest.keys():
        depth, at = 0.0, np.zeros(3, dtype=np.float32)
        if key in deepest:
            depth, at = float(depths[deepest[key]]), vertices[deepest[key]]
        pairs.append(CollidingPair(part_names[key[0]], part_names[key[1]], crossings[key], depth, at))
    triangles = np.unique(found.pairs)
    return ShownCollisions(
        posed.vertices[posed.scene.arrays.faces[triangles]].astype(np.float32).reshape(-1, 3, 3),
        vertices,
        depths,
        tuple(sorted(pairs, key=lambda pair: (-pair.depth, -pair.crossings, pair.first, pair.second))),
    )
