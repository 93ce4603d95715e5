"""Normal equations of fitting a blend model to points of a scan or to vertices, without a Jacobian of the residuals.

A point on a face moves with three vertices by its barycentric weights, so every row of a point-to-plane residual is
a combination of nine rows of the vertex Jacobian J. Its normal equations need only the products of those combinations:
sums over the points of one symmetric 3 x 3 block for each vertex and each edge of the mesh, A, and a gradient g for
each vertex. Then JtJ = J' A J and Jtr = J' g: after the blocks are summed, the cost no longer depends on how many
points there were. The blocks are also those of a free surface's own normal equations ([R17] Eq. 5-6).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from numba import njit

from tracker.model.blend_model import PosedBlend

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class MeshEdges:
    """The edges of a triangle mesh.

    Attributes:
        ends: (E, 2) vertices, the smaller first.
        of_faces: (F, 3) edge between corners 0-1, 1-2 and 2-0 of each face.
    """

    ends: Ints
    of_faces: Ints

    @classmethod
    def of(cls, faces: Ints) -> MeshEdges:
        """Those of faces (F, 3)."""
        pairs = np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
        ends, numbers = np.unique(pairs, axis=0, return_inverse=True)
        return cls(ends.astype(np.int64), numbers.reshape(-1, 3).astype(np.int64))


@dataclass(frozen=True, eq=False)
class SurfaceSystem:
    """Normal equations of a residual of the surface's vertices: half the cost's second and first derivatives.

    Attributes:
        edges: The mesh's edges.
        vertex_blocks: (V, 6) xx, xy, xz, yy, yz, zz of each vertex' own block of A.
        edge_blocks: (E, 6) the same between the ends of each edge.
        gradient: (V, 3) g, residuals times their derivative.
        cost: Weighted sum of squared residuals.
    """

    edges: MeshEdges
    vertex_blocks: Array
    edge_blocks: Array
    gradient: Array
    cost: float

    def by_parameters(self, jacobian: Array) -> tuple[Array, Array]:
        """JtJ (P, P) and Jtr (P,) for a vertex Jacobian (V, 3, P)."""
        product = np.empty_like(jacobian)
        multiply_into(product, jacobian, self.vertex_blocks, self.edge_blocks, self.edges.ends)
        flat = jacobian.reshape(-1, jacobian.shape[2])
        return flat.T @ product.reshape(flat.shape), flat.T @ self.gradient.reshape(-1)


def plane_system(
    vertices: Array,
    faces: Ints,
    edges: MeshEdges,
    face_ids: Ints,
    barycentric: Array,
    points: Array,
    normals: Array,
    weights: Array,
) -> SurfaceSystem:
    """Of w (n · (x - s))² over points s, x the point of the surface that belongs to each.

    Args:
        vertices: (V, 3) posed, m.
        faces: (F, 3).
        edges: Of the faces.
        face_ids: (N,) the face that x is on.
        barycentric: (N, 3) where on it.
        points: (N, 3) s, m.
        normals: (N, 3) n, unit.
        weights: (N,) w >= 0; 0 leaves a point out.
    """
    count = len(points)
    assert face_ids.shape == weights.shape == (count,)
    assert points.shape == normals.shape == barycentric.shape == (count, 3)
    vertex_blocks, gradient = np.zeros((len(vertices), 6)), np.zeros((len(vertices), 3))
    edge_blocks = np.zeros((len(edges.ends), 6))
    cost = add_planes(
        vertex_blocks,
        edge_blocks,
        gradient,
        vertices,
        faces,
        edges.of_faces,
        np.asarray(face_ids),
        np.ascontiguousarray(barycentric),
        np.ascontiguousarray(points),
        np.ascontiguousarray(normals),
        np.ascontiguousarray(weights),
    )
    return SurfaceSystem(edges, vertex_blocks, edge_blocks, gradient, cost)


def vertex_system(posed: PosedBlend, targets: Array, weights: Array, jacobian: Array) -> tuple[Array, Array, float]:
    """JtJ (P, P), Jtr (P,) and cost of w |v - target|² over the vertices.

    Args:
        posed: The model.
        targets: (V, 3) m.
        weights: (V,) >= 0.
        jacobian: (V, 3, P) of the vertices; it is multiplied by the root of the weights.
    """
    roots = np.sqrt(weights)
    residual = (roots[:, None] * (posed.vertices - targets)).reshape(-1)
    jacobian *= roots[:, None, None]
    flat = jacobian.reshape(-1, jacobian.shape[2])
    return flat.T @ flat, flat.T @ residual, float(residual @ residual)


@njit(cache=True, nogil=True)
def add_planes(
    vertex_blocks, edge_blocks, gradient, vertices, faces, face_edges, face_ids, barycentric, points, normals, weights
):
    """Add the blocks and gradients of `plane_system`; gives the cost."""
    cost = 0.0
    for i in range(len(points)):
        w = weights[i]
        if w == 0.0:
            continue
        f = face_ids[i]
        nx, ny, nz = normals[i, 0], normals[i, 1], normals[i, 2]
        r = -(nx * points[i, 0] + ny * points[i, 1] + nz * points[i, 2])
        for k in range(3):
            v = faces[f, k]
            r += barycentric[i, k] * (nx * vertices[v, 0] + ny * vertices[v, 1] + nz * vertices[v, 2])
        cost += w * r * r
        xx, xy, xz, yy, yz, zz = w * nx * nx, w * nx * ny, w * nx * nz, w * ny * ny, w * ny * nz, w * nz * nz
        for k in range(3):
            v, b = faces[f, k], barycentric[i, k]
            gradient[v, 0] += w * r * b * nx
            gradient[v, 1] += w * r * b * ny
            gradient[v, 2] += w * r * b * nz
            both = b * b
            vertex_blocks[v, 0] += both * xx
            vertex_blocks[v, 1] += both * xy
            vertex_blocks[v, 2] += both * xz
            vertex_blocks[v, 3] += both * yy
            vertex_blocks[v, 4] += both * yz
            vertex_blocks[v, 5] += both * zz
            e, both = face_edges[f, k], b * barycentric[i, (k + 1) % 3]
            edge_blocks[e, 0] += both * xx
            edge_blocks[e, 1] += both * xy
            edge_blocks[e, 2] += both * xz
            edge_blocks[e, 3] += both * yy
            edge_blocks[e, 4] += both * yz
            edge_blocks[e, 5] += both * zz
    return cost


@njit(cache=True, nogil=True)
def multiply_into(product, jacobian, vertex_blocks, edge_blocks, ends):
    """Write A J (V, 3, P) for the blocks of A and J (V, 3, P)."""
    P = jacobian.shape[2]
    for v in range(len(jacobian)):
        a, b, c = vertex_blocks[v, 0], vertex_blocks[v, 1], vertex_blocks[v, 2]
        d, e, f = vertex_blocks[v, 3], vertex_blocks[v, 4], vertex_blocks[v, 5]
        for p in range(P):
            x, y, z = jacobian[v, 0, p], jacobian[v, 1, p], jacobian[v, 2, p]
            product[v, 0, p] = a * x + b * y + c * z
            product[v, 1, p] = b * x + d * y + e * z
            product[v, 2, p] = c * x + e * y + f * z
    for n in range(len(ends)):
        a, b, c = edge_blocks[n, 0], edge_blocks[n, 1], edge_blocks[n, 2]
        d, e, f = edge_blocks[n, 3], edge_blocks[n, 4], edge_blocks[n, 5]
        if a + d + f == 0.0:
            continue
        for way in range(2):
            v, u = ends[n, way], ends[n, 1 - way]
            for p in range(P):
                x, y, z = jacobian[u, 0, p], jacobian[u, 1, p], jacobian[u, 2, p]
                product[v, 0, p] += a * x + b * y + c * z
                product[v, 1, p] += b * x + d * y + e * z
                product[v, 2, p] += c * x + e * y + f * z
