"""A real scan brought into another pose: real skin, holes and forearm, with every vertex known, where scans are rare.

Each point is bound to the registered surface beneath it and carried along by weights that the registering model does
not have (by distance). A thumb that would pass through a finger goes back, like the finger, until they touch.
Points that still end up inside another finger are left out, as a scanner does not see them.
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

GIVE, STEP = 0.8e-3, 0.04
"""So far fingers press into each other, as in `synthesis.scans.settle`, m; the share of its way that one goes back."""

ALONG, RING = np.linspace(0.1, 0.9, 9), 2e-3
"""Where the balls that fill a phalanx lie along it, each in the middle of the skin this near to its height, m."""


def find_pose(registrar: Registrar, subject: int, pose: str) -> Array:
    """(16, 3) axis-angle of the untrained right hand in a pose of a generated person, rad."""
    fit = registrar.fit
    return fit_to_vertices(fit, fit.neutral(), generate_truth(subject, pose).vertices).pose


def repose(scan: Scan, registration: Registration, pose: Array) -> tuple[Scan, Array]:
    """The scan with its fingers in another pose (16, 3), and the registration's vertices (V, 3) with them, m."""
    model = untrained_hand()
    flip = np.array([1.0 if registration.side == "right" else -1.0, 1.0, 1.0])
    weights = with_distance_weights(model).skinning_weights
    vertices, points = registration.vertices * flip, np.ascontiguousarray(scan.points * flip)
    before = HandState(registration.pose, registration.shape, registration.translation)
    after = settle(model, before, pose, vertices)
    moves = _place_bones(model, after) @ np.linalg.inv(_place_bones(model, before))
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


def settle(model: BlendModel, before: HandState, pose: Array, vertices: Array) -> HandState:
    """A hand (V, 3) brought into a pose, or as near to it as its thumb passes through no finger.

    Of balls that fill the fingers, those of the thumb overlap others no more than before and than skin gives way. The
    two fingers that overlap most go back some of their way, as often as it takes. Side by side, fingers only press.
    """
    start, joints = np.linalg.inv(_place_bones(model, before)), before.posed(model).joints
    tips = vertices[model.tips[[1, 2, 4, 3, 0]]]
    ends = np.concatenate([np.stack([*joints[3 * n + 2 : 3 * n + 4], tip]) for n, tip in enumerate(tips)])
    bones, owners = np.repeat(np.arange(1, 16), len(ALONG)), model.skinning_weights.argmax(axis=1)
    lines = (ends - joints[1:])[bones - 1]
    middles = joints[bones] + np.tile(ALONG, 15)[:, None] * lines
    heights = np.einsum("nvd,nd->nv", vertices - middles[:, None], lines / np.linalg.norm(lines, axis=1)[:, None])
    rings = np.exp(-((heights / RING) ** 2)) * (owners == bones[:, None])
    centers = rings @ vertices / rings.sum(axis=1, keepdims=True)
    radii, is_thumb = KDTree(vertices).query(centers)[0], bones > 12
    apart = np.where(is_thumb[:, None] & ~is_thumb, -radii[:, None] - radii, np.inf)
    before_gaps = np.minimum(_find_gaps(centers) + apart, 0.0)
    shares = np.ones(5)
    while True:
        share = np.concatenate([[0.0], np.repeat(shares, 3)])[:, None]
        after = HandState(before.pose + share * (pose - before.pose), before.shape, before.translation)
        moves = _place_bones(model, after) @ start
        placed = np.einsum("nij,nj->ni", moves[bones, :3, :3], centers) + moves[bones, :3, 3]
        gaps = _find_gaps(placed) + apart - before_gaps
        if gaps.min() > -GIVE:
            return after
        worst = (bones[list(np.unravel_index(np.argmin(gaps), gaps.shape))] - 1) // 3
        shares[worst] = np.maximum(shares[worst] - STEP, 0.0)


def _find_gaps(points: Array) -> Array:
    return np.linalg.norm(points[:, None] - points, axis=2)


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
