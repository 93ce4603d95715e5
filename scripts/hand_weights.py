"""Skinning weights of the hand: heat for the palm, whose joints were moved, MakeHuman's own along the fingers."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from hand_geometry import FINGERS, STUMP, Hand
from scipy.sparse import coo_matrix, diags
from scipy.sparse.linalg import splu

Array = npt.NDArray[np.float64]

HEAT = 1.0
"""How strongly a vertex follows its nearest bone; a transition is about 1/sqrt(HEAT) of the depth of the bone wide."""


def compute_weights(hand: Hand, vertices: Array, chains: dict[str, Array], bones: tuple[str, ...]) -> Array:
    """Weights (V, B) for bones named "wrist" and "<finger>_<segment>", rows summing to one."""
    groups = bone_lines(chains)
    heat = diffuse(vertices, hand.faces, list(groups.values()))
    weights = np.zeros((len(vertices), len(bones)))
    original = np.asarray(hand.rows @ hand.wheel.bone_weights(_finger_bones()))
    for name, share in zip(groups, heat.T, strict=True):
        if not name.endswith("_ray"):
            weights[:, bones.index(name)] += share
            continue
        finger = name.removesuffix("_ray")
        segments = ("proximal", "distal") if finger == "thumb" else ("proximal", "middle", "distal")
        first = 3 * (FINGERS[finger] - 1) + (1 if finger == "thumb" else 0)
        own = original[:, first : first + len(segments)]
        total = own.sum(axis=1)
        known = total > 0.02
        split = np.zeros_like(own)
        split[known] = own[known] / total[known, None]
        split[~known, 0] = 1.0
        for column, segment in enumerate(segments):
            weights[:, bones.index(f"{finger}_{segment}")] += share * split[:, column]
    return weights / weights.sum(axis=1, keepdims=True)


def bone_lines(chains: dict[str, Array]) -> dict[str, Array]:
    """Lines (S, 2, 3) that heat the surface: the wrist with the carpus, the metacarpals, and a ray for each finger."""
    bases = [chains[finger][0] for finger in FINGERS]
    stump = np.array([-STUMP, 0.0, 0.0])
    lines = {"wrist": np.array([[stump, chains["wrist"][0]], *([chains["wrist"][0], 0.92 * base] for base in bases)])}
    for finger in FINGERS:
        chain = chains[finger]
        lines[f"{finger}_metacarpal"] = chain[None, :2]
        lines[f"{finger}_ray"] = np.stack([chain[1:-1], chain[2:]], axis=1)
    return lines


def diffuse(vertices: Array, faces: npt.NDArray[np.int64], groups: list[Array]) -> Array:
    """Heat of each group of lines (S, 2, 3) on the surface at rest, (V, G): (H - Laplacian) w = H p."""
    distances = np.stack([distance_to_lines(vertices, lines) for lines in groups], axis=1)
    nearest = np.argmin(distances, axis=1)
    heat = HEAT / np.maximum(distances.min(axis=1), 1e-4) ** 2
    laplacian, areas = surface_laplacian(vertices, faces)
    system = splu((diags(heat * areas) + laplacian).tocsc())
    sources = np.eye(len(groups))[nearest] * (heat * areas)[:, None]
    return np.clip(system.solve(sources), 0.0, 1.0)


def distance_to_lines(points: Array, lines: Array) -> Array:
    """(N,) distance of points (N, 3) to the nearest of lines (S, 2, 3)."""
    start, along = lines[:, 0], lines[:, 1] - lines[:, 0]
    share = np.einsum("nsx,sx->ns", points[:, None] - start, along) / np.einsum("sx,sx->s", along, along)
    closest = start + np.clip(share, 0.0, 1.0)[..., None] * along
    return np.linalg.norm(points[:, None] - closest, axis=2).min(axis=1)


def surface_laplacian(vertices: Array, faces: npt.NDArray[np.int64]) -> tuple[coo_matrix, Array]:
    """Positive cotangent Laplacian (V, V) and the area of each vertex (V,)."""
    rows, columns, values = [], [], []
    areas = np.zeros(len(vertices))
    for corner in range(3):
        a, b, c = faces[:, corner], faces[:, (corner + 1) % 3], faces[:, (corner + 2) % 3]
        u, v = vertices[b] - vertices[a], vertices[c] - vertices[a]
        cross = np.linalg.norm(np.cross(u, v), axis=1)
        np.add.at(areas, a, cross / 6.0)
        cotangent = np.clip(0.5 * np.einsum("fx,fx->f", u, v) / np.maximum(cross, 1e-15), 0.0, 20.0)
        rows += [b, c, b, c]
        columns += [c, b, b, c]
        values += [-cotangent, -cotangent, cotangent, cotangent]
    size = (len(vertices), len(vertices))
    return coo_matrix((np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))), shape=size), areas


def _finger_bones() -> list[str]:
    return [f"finger{number}-{k}.R" for number in FINGERS.values() for k in (1, 2, 3)]
