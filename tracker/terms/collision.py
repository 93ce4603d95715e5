"""Keep parts out of each other, [T16] §3.2.4, Eq. 9-13."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numba import njit

from tracker.model.scene import PosedScene
from tracker.terms.colliding_parts import find_crossings
from tracker.terms.look import TermLook
from tracker.terms.normal_equations import MILLIMETRES
from tracker.terms.penetration import find_swallowed
from tracker.terms.point_plane import PointToPlane
from tracker.terms.residual import FrameContext
from tracker.terms.surface_rows import span

REACH = 4.0
"""A field ends this many circumradii from its triangle; two crossing triangles of about one size are within three."""

WIDEST = 3.0
"""A cone stops widening at this many circumradii."""


@dataclass(frozen=True)
class Collision:
    """Move each intruding vertex v back along its inverse normal by the repulsion ψ(v), [T16] Eq. 13.

    Every triangle f of a crossing pair carries a field for the vertices of the other, a cone about its normal n
    through its circumcentre o with circumradius r. With h = n · (v − o), all in millimetres:

        Φ(v) = |v − o − h n| / (r − r h / σ)     Eq. 10, 1 at the cone's side
        Υ(h) = −h + 1 − σ for h ≤ −σ, 0 for h ≥ σ, a parabola between     Eq. 11
        Ψ(v) = ((1 − Φ) Υ)² inside the cone     Eq. 9

    Differs from the paper:
    - A vertex moves back by min(Ψ, √Ψ): as in Eq. 13 up to 1 mm of (1 − Φ) Υ, then by the depth and not by its square.
      Ψ itself would send a vertex that is 4 mm deep 20 mm away.
    - Times the cosine between the vertex's inverse normal and n. What it takes to leave is a move along n, of which the
      vertex's row sees that share; where the cosine is negative the vertex is on the far side and would go deeper.
    - The fields at a vertex add up (Fig. 6), but the sum moves it no farther than the strongest of them. Each vertex
      counts once, however many triangles it meets, so the weight does not depend on how fine the mesh is.
    - Beyond the apex (h ≥ σ) there is no field, before Φ changes its sign there. Triangles without area have none.
    - A cone widens to WIDEST circumradii only and ends at REACH of them. In millimetres it opens by 80 degrees, so that
      vertices far to the side, behind the triangle's plane but outside the body, would be pushed hardest of all.
    - Vertices that are wholly inside, whose triangles cross nothing, are found too and have as receiver the triangle
      through which they would leave backwards (Φ = 0), if that is the shorter way out.
    - Fields and normals are held fixed when the correspondences are used.
    """

    look: ClassVar[TermLook] = TermLook("collision", "Collision", "#ff3c2d", "#961e0f")

    weight: float = 0.3
    """γ_c, of each intruding vertex. The paper's 10 (§4.1.3) belongs to sums over pairs, which grow with the mesh; here
    it would fight depth images in which flesh gives way, 5 mm where a pipe presses into the ball of a thumb."""

    sigma_mm: float = 0.5
    """σ, half the height of the transition and the cone's apex above its triangle, mm (§3.2.4)."""

    def find(self, posed: PosedScene, context: FrameContext | None = None) -> PointToPlane:
        """Intruding vertices and the planes they are pushed back to; `context` is not needed."""
        crossings = find_crossings(posed)
        inside = find_swallowed(posed, crossings)
        ids, push = compute_repulsion(
            posed.vertices,
            posed.normals,
            posed.scene.arrays.faces,
            crossings.pairs,
            self.sigma_mm,
            MILLIMETRES,
        )
        swallowed, swallowed_push = _leave_backwards(inside.distances, inside.cosines, self.sigma_mm)
        ids = np.concatenate([ids, inside.ids[swallowed]])
        push = np.concatenate([push, swallowed_push]) / MILLIMETRES
        normals = posed.normals[ids]
        targets = posed.vertices[ids] - push[:, None] * normals
        return PointToPlane(*span(ids), targets, normals, np.full(len(ids), self.weight))


def compute_repulsion(vertices, normals, faces, pairs, sigma_mm: float, to_mm: float):
    """How far the vertices of crossing triangles are pushed back.

    Args:
        vertices: (V, 3).
        normals: (V, 3) unit.
        faces: (F, 3).
        pairs: (C, 2) crossing triangles; both are intruder and receiver.
        sigma_mm: σ, mm.
        to_mm: Millimetres in one unit of `vertices`.

    Returns:
        (N,) vertices and (N,) mm above zero.
    """
    sums, strongest = np.zeros(len(vertices)), np.zeros(len(vertices))
    _add_fields(sums, strongest, vertices, normals, faces, pairs, sigma_mm, to_mm)
    ids = np.flatnonzero(sums > 0.0).astype(np.int32)
    return ids, np.minimum(sums[ids], strongest[ids])


def _leave_backwards(distances, cosines, sigma_mm: float):
    """Which swallowed vertices (N,) are pushed, and how far, mm."""
    chosen = distances[:, 0] <= distances[:, 1]
    cosine = cosines[chosen]
    depth = MILLIMETRES * distances[chosen, 0] * cosine + 1.0 - sigma_mm
    return chosen, np.minimum(depth**2, depth) * cosine


@njit(cache=True, nogil=True)
def measure_cone_depth(h, lateral, radius, sigma):
    """(1 − Φ) Υ of [T16] Eq. 10 and 11 inside the cone, otherwise 0; everything in mm.

    Args:
        h: Height above the triangle's plane, negative behind it.
        lateral: Distance from the cone's axis.
        radius: Of the circumcircle.
        sigma: σ.
    """
    if h >= sigma:
        return 0.0
    phi = lateral / (radius * min(1.0 - h / sigma, WIDEST))
    if phi >= 1.0:
        return 0.0
    if h <= -sigma:
        intensity = -h + 1.0 - sigma
    else:
        intensity = (
            -(1.0 - 2.0 * sigma) / (4.0 * sigma * sigma) * h * h - h / (2.0 * sigma) + 0.25 * (3.0 - 2.0 * sigma)
        )
    return (1.0 - phi) * intensity


@njit(cache=True, nogil=True)
def _add_fields(sums, strongest, vertices, normals, faces, pairs, sigma, to_mm):
    """Add up Ψ times the cosine at every vertex, and keep the largest √Ψ times the cosine."""
    for pair in range(len(pairs)):
        for side in range(2):
            receiver, intruder = faces[pairs[pair, side]], faces[pairs[pair, 1 - side]]
            a, b, c = vertices[receiver[0]], vertices[receiver[1]], vertices[receiver[2]]
            ux, uy, uz = b[0] - a[0], b[1] - a[1], b[2] - a[2]
            wx, wy, wz = c[0] - a[0], c[1] - a[1], c[2] - a[2]
            nx, ny, nz = uy * wz - uz * wy, uz * wx - ux * wz, ux * wy - uy * wx
            uu, ww = ux * ux + uy * uy + uz * uz, wx * wx + wy * wy + wz * wz
            nn = nx * nx + ny * ny + nz * nz
            if nn <= 1e-12 * uu * ww:
                continue
            # circumcentre relative to a: n × (|w|² u − |u|² w) / (2 |n|²)
            px, py, pz = ww * ux - uu * wx, ww * uy - uu * wy, ww * uz - uu * wz
            ox = (ny * pz - nz * py) / (2.0 * nn)
            oy = (nz * px - nx * pz) / (2.0 * nn)
            oz = (nx * py - ny * px) / (2.0 * nn)
            radius = np.sqrt(ox * ox + oy * oy + oz * oz)
            length = np.sqrt(nn)
            nx, ny, nz = nx / length, ny / length, nz / length
            for corner in range(3):
                v = intruder[corner]
                cosine = -(normals[v, 0] * nx + normals[v, 1] * ny + normals[v, 2] * nz)
                if cosine <= 0.0:
                    continue
                dx = vertices[v, 0] - a[0] - ox
                dy = vertices[v, 1] - a[1] - oy
                dz = vertices[v, 2] - a[2] - oz
                h = nx * dx + ny * dy + nz * dz
                distance = dx * dx + dy * dy + dz * dz
                if distance > REACH * REACH * radius * radius:
                    continue
                lateral = np.sqrt(max(distance - h * h, 0.0))
                depth = measure_cone_depth(to_mm * h, to_mm * lateral, to_mm * radius, sigma)
                if depth > 0.0:
                    sums[v] += depth * depth * cosine
                    strongest[v] = max(strongest[v], depth * cosine)
