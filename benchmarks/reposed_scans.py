"""A real scan brought into another pose: real skin, holes and forearm, with every vertex known, where scans are rare.

Each point is bound to the registered surface beneath it and carried along by weights that the registering model does
not have (by distance). Points that end up inside another finger are left out, as a scanner does not see them.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.spatial import KDTree
from scipy.spatial.transform import Rotation

from benchmarks.distance_weights import with_distance_weights
from tracker.capture.scan import Scan
from tracker.geometry.vertex_normals import find_unit_normals
from tracker.model.blend_model import BlendModel
from tracker.model.untrained_hand import untrained_hand
from tracker.registration.hand_state import HandState
from tracker.registration.register import Registrar
from tracker.registration.registration import Registration
from tracker.registration.surface_search import SurfaceSearch
from tracker.registration.vertex_fit import fit_to_vertices
from tracker.synthesis.scans.generate import generate_truth

Array = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int64]

SUNK = 5e-4
"""A point this near to another finger's surface, or below it, is not seen, m."""

THICK = 12e-3
"""A finger's thickness: points farther than this from another finger are not inside it, m."""


def find_pose(registrar: Registrar, subject: int, pose: str) -> Array:
    """(16, 3) axis-angle of the untrained right hand in a pose of a generated person, rad."""
    fit = registrar.fit
    return fit_to_vertices(fit, fit.neutral(), generate_truth(subject, pose).vertices).pose


def repose(scan: Scan, registration: Registration, pose: Array) -> tuple[Scan, Array]:
    """The scan with its fingers in another pose (16, 3), and the registration's vertices (V, 3) with them, m."""
    model = untrained_hand()
    flip = np.array([1.0 if registration.side == "right" else -1.0, 1.0, 1.0])
    weights = with_distance_weights(model).skinning_weights
    before = HandState(registration.pose, registration.shape, registration.translation)
    after = HandState(np.concatenate([before.pose[:1], pose[1:]]), before.shape, before.translation)
    moves = _place_bones(model, after) @ np.linalg.inv(_place_bones(model, before))
    vertices, points = registration.vertices * flip, np.ascontiguousarray(scan.points * flip)
    search = SurfaceSearch(model.template, model.faces)
    found = search.match(vertices, points, np.zeros_like(points), reach=10.0)
    corners = search.faces[found.faces]
    moved = _skin(moves, np.einsum("nk,nkb->nb", found.weights, weights[corners]), points)
    normals = _skin(moves * [[1.0, 1.0, 1.0, 0.0]], np.einsum("nk,nkb->nb", found.weights, weights[corners]),
                    scan.normals * flip)  # fmt: skip
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-9)
    truth = _skin(moves, weights, vertices)
    finger = (weights.argmax(axis=1) + 2) // 3  # 0 is the palm
    hidden = _find_hidden(moved, finger[corners[:, 0]], truth, finger, find_unit_normals(truth, search.faces))
    return Scan(moved * flip, normals * flip, scan.faces).select(~hidden), truth * flip


def _place_bones(model: BlendModel, state: HandState) -> Array:
    """(B, 4, 4) from the shaped template to the posed hand, pose blend shapes left out."""
    joints = model.joints_of(model.shaped(state.shape))
    places: list[Array] = []
    for bone, parent in enumerate(np.asarray(model.parents)):
        T = np.eye(4)
        T[:3, :3] = Rotation.from_rotvec(state.pose[bone]).as_matrix()
        T[:3, 3] = joints[bone] - joints[parent] if parent >= 0 else joints[bone] + state.translation
        places.append(places[parent] @ T if parent >= 0 else T)
    Ts = np.stack(places)
    Ts[:, :3, 3] -= np.einsum("bij,bj->bi", Ts[:, :3, :3], joints)
    return Ts


def _skin(moves: Array, weights: Array, points: Array) -> Array:
    blended = np.einsum("nb,bij->nij", weights, moves)
    return np.einsum("nij,nj->ni", blended[:, :3, :3], points) + blended[:, :3, 3]


def _find_hidden(
    points: Array, owners: Integers, vertices: Array, finger: Integers, normals: Array
) -> npt.NDArray[np.bool_]:
    """(N,) points of a finger that lie inside another one."""
    hidden = np.zeros(len(points), dtype=bool)
    for number in range(1, 6):
        ids = np.flatnonzero(finger == number)
        distances, nearest = KDTree(vertices[ids]).query(points, distance_upper_bound=THICK)
        is_near = np.isfinite(distances) & (owners != number) & (owners != 0)
        beside = ids[np.where(is_near, nearest, 0)]
        hidden |= is_near & (np.einsum("nd,nd->n", points - vertices[beside], normals[beside]) < SUNK)
    return hidden
