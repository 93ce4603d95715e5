"""One surface of body and hands: MakeHuman's right half without its hand, the trained hand sewn on, both mirrored."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import fast_simplification
import numpy as np
import numpy.typing as npt
from body_bones import BodyRig
from hand_geometry import clip_mesh
from hand_weights import surface_laplacian
from scipy.sparse import csr_matrix
from untrained_surface import boundary_loop

from tracker.model.blend_model import BlendModel
from tracker.model.decimation import find_surface_points

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

BAND = 0.060
"""Of the forearm behind the hand that is made anew, m."""
RINGS = 10
"""Of vertices in it, as many in each as the hand has at its end."""
HALF_FACES = 4600
"""Of half a body without its hand."""
MIRROR_X = np.array([-1.0, 1.0, 1.0])
R_BODY_HAND = np.array([[-1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]])
"""From the frame of the right hand (x to the middle knuckle, y to the thumb, z out of its back) to the T-pose's."""


@dataclass(frozen=True)
class BodySurface:
    """Vertices in this order: right half without hand and wrist band, band, right hand, then the left side of all.

    Attributes:
        rows: (H, V) sparse; the half without hand and band from MakeHuman's V vertices.
        band: (N, H + hand) the band's vertices from the half's and the hand's.
        midline: (H,) whether a vertex of the half is in the plane of the mirror.
        hand: The trained right hand.
        half_faces: (F, 3) of half, band and hand, sewn together.
    """

    rows: csr_matrix
    band: Array
    midline: npt.NDArray[np.bool_]
    hand: BlendModel
    half_faces: Ints

    @property
    def num_half(self) -> int:
        return len(self.midline)

    @property
    def right_band(self) -> Ints:
        return self.num_half + np.arange(len(self.band))

    @property
    def right_hand(self) -> Ints:
        return self.num_half + len(self.band) + np.arange(len(self.hand.template))

    @property
    def lefts(self) -> Ints:
        """(right side,) place of each right vertex's mirror image; the midline's own."""
        own = np.zeros(self.right_hand[-1] + 1, dtype=bool)
        own[: self.num_half] = self.midline
        return np.where(own, np.arange(len(own)), len(own) + np.cumsum(~own) - 1)

    @property
    def left_hand(self) -> Ints:
        return self.lefts[self.right_hand]

    @property
    def faces(self) -> Ints:
        return np.concatenate([self.half_faces, self.lefts[self.half_faces][:, ::-1]])

    def right(self, straight: Array, hand: Array) -> Array:
        """(right side, 3) of a body (V, 3) in the T-pose and a hand (782, 3) in its place."""
        half = np.asarray(self.rows @ straight)
        half[self.midline, 0] = 0.0
        outer = np.concatenate([half, hand])
        return np.concatenate([half, self.band @ outer, hand])

    def mirrored(self, right: Array, factor: Array = MIRROR_X) -> Array:
        """(V, ...) values of both sides from those of the right half and hand, times the factor on the left."""
        both = np.zeros((self.lefts.max() + 1, *right.shape[1:]))
        both[self.lefts] = right * factor
        both[: len(right)] = right
        return both


def build_surface(rig: BodyRig, straight: Array, wrist: Array, hand: BlendModel, scale: float) -> BodySurface:
    """From the mean body in the T-pose, vertices (V, 3) and wrist (3,), m; and the right hand, so much larger."""
    base = rig.wheel.vertices
    polygons = rig.wheel.mesh[1]["body"]
    triangles = np.array([(p[0], p[k], p[k + 1]) for p in polygons for k in range(1, len(p) - 1)])
    own = boundary_loop(hand.faces)
    placed = scale * hand.template @ R_BODY_HAND.T + wrist
    flat = straight.copy()
    flat[np.abs(base[:, 0]) < 1e-7, 0] = 0.0
    half = triangles[np.all(base[triangles][:, :, 0] < 1e-7, axis=1)]
    cut = placed[own, 0].max() + BAND
    rows, faces = clip_mesh(flat, half, np.array([1.0, 0.0, 0.0]), cut)
    points, coarse, where = _coarsen(np.asarray(rows @ flat), faces)
    borders = _directed_borders(coarse)
    at_wrist = {vertex for vertex in borders if points[vertex, 0] < 0.5 * wrist[0]}
    midline = np.zeros(len(points), dtype=bool)
    midline[[vertex for vertex in borders if vertex not in at_wrist]] = True
    ring = _ordered(borders, at_wrist)

    size, count = len(points), len(own)
    near = _around(points[ring], placed[own])
    levels = np.linspace(0.0, 1.0, RINGS + 2)[1:-1, None, None]
    band = ((1.0 - levels) * near + levels * placed[own]).reshape(-1, 3)
    loops = size + np.arange(RINGS * count).reshape(RINGS, count)
    loops = np.concatenate([loops, own[None] + size + len(band)])
    strips = [_sew(points[ring], band[:count], ring, loops[0])]
    for first, second in pairwise(loops):
        a, b, c, d = first, np.roll(first, -1), np.roll(second, -1), second
        strips += [np.stack([c, d, a], axis=1), np.stack([c, a, b], axis=1)]
    sewn = np.concatenate([coarse, hand.faces + size + len(band), *strips])
    mesh = np.concatenate([points, band, placed])
    return BodySurface(csr_matrix(where @ rows), smooth_band(mesh, sewn, size, len(band)), midline, hand, sewn)


def smooth_band(mesh: Array, faces: Ints, first: int, count: int) -> Array:
    """(count, others) the band's vertices from all others, where the surface bends least: no step, no crease.

    The squared Laplacian of the positions is least over the band and the vertices beside it. Its weights are those of
    this mesh (V, 3), so that the band is linear in what it joins.
    """
    whole, areas = surface_laplacian(mesh, faces)
    laplacian = whole.tocsr()
    free = np.arange(first, first + count)
    reached = np.flatnonzero(np.asarray(abs(laplacian[:, free]).sum(axis=1)).ravel())
    matrix = (laplacian[reached].multiply(1.0 / np.sqrt(areas[reached])[:, None])).toarray()
    others = np.delete(np.arange(len(mesh)), free)
    return -np.linalg.lstsq(matrix[:, free], matrix[:, others], rcond=None)[0]


def _coarsen(fine: Array, faces: Ints) -> tuple[Array, Ints, csr_matrix]:
    """Vertices, faces, and the vertices (n, V) as means of the fine ones."""
    points, coarse = fast_simplification.simplify(fine, faces.astype(np.int32), target_count=HALF_FACES, agg=5.0)[:2]
    used, flat = np.unique(np.asarray(coarse, dtype=np.int64), return_inverse=True)
    points = np.asarray(points, dtype=np.float64)[used]
    where = find_surface_points(points, fine, faces)
    places = np.repeat(np.arange(len(points)), 3), where.corners.ravel()
    picked = csr_matrix((where.shares.ravel(), places), shape=(len(points), len(fine)))
    return np.asarray(picked @ fine), flat.reshape(-1, 3), picked


def _around(ring: Array, like: Array) -> Array:
    """(n, 3) points of a closed line (m, 3) about the x axis at the angles that those of another (n, 3) have."""
    centre, other = ring.mean(axis=0), like.mean(axis=0)
    angles = np.arctan2(*(ring - centre)[:, [2, 1]].T)
    order = np.argsort(angles)
    wanted = np.arctan2(*(like - other)[:, [2, 1]].T)
    columns = [np.interp(wanted, angles[order], ring[order, k], period=2.0 * np.pi) for k in range(3)]
    return np.stack(columns, axis=1)


def _directed_borders(faces: Ints) -> dict[int, int]:
    """The next vertex along the border, in the order of the faces' edges."""
    directed = {(int(a), int(b)) for a, b in faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)}
    return {a: b for a, b in directed if (b, a) not in directed}


def _ordered(borders: dict[int, int], members: set[int]) -> Ints:
    loop = [min(members)]
    while borders[loop[-1]] != loop[0]:
        loop.append(borders[loop[-1]])
    assert set(loop) == members, "the cut through the forearm is not one loop"
    return np.array(loop)


def _sew(arm: Array, hand: Array, arm_ids: Ints, hand_ids: Ints) -> Ints:
    """Triangles between two loops, (n, 3) and (m, 3), each in the order of its own faces' edges."""
    arm, hand = (loop[:, 1:] - loop[:, 1:].mean(axis=0) for loop in (arm, hand))
    hand, hand_ids = hand[::-1], hand_ids[::-1]  # the hand's loop runs the other way round
    start = int(np.argmin(np.linalg.norm(hand - arm[0], axis=1)))
    hand, hand_ids = np.roll(hand, -start, axis=0), np.roll(hand_ids, -start)
    i = j = 0
    faces = []
    while i < len(arm) or j < len(hand):
        a, b = i % len(arm), j % len(hand)
        next_arm, next_hand = (i + 1) % len(arm), (j + 1) % len(hand)
        across = np.linalg.norm(arm[next_arm] - hand[b]) - np.linalg.norm(hand[next_hand] - arm[a])
        if j == len(hand) or (i < len(arm) and across < 0.0):
            faces.append((arm_ids[next_arm], arm_ids[a], hand_ids[b]))
            i += 1
        else:
            faces.append((hand_ids[b], hand_ids[next_hand], arm_ids[a]))
            j += 1
    return np.array(faces, dtype=np.int64)
