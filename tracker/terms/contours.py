"""Keep the contours of the drawn model on the edges of a colour image, [T16] §3.3, Eq. 19."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import ClassVar

import numpy as np
import numpy.typing as npt
from numba import njit

from tracker.model.scene import PosedScene
from tracker.observation.image_edges import DIRECTIONS, SLACK, ImageEdges, find_nearest_edge, sort_offsets
from tracker.rendering import render_view
from tracker.terms.drawn_frame import Matches
from tracker.terms.look import TermLook
from tracker.terms.point_line import PointToLine
from tracker.terms.residual import FrameContext
from tracker.terms.surface_point import barycentric_into

Array = npt.NDArray[np.float64]


DRAWN = 0.001
"""m; finer pixels than these are drawn together, so that the cost follows the hands and not the megapixels. The edges
keep the resolution of the image."""

SAMPLED = 16
"""One vertex in this many is used to measure how far the scene is."""


@dataclass(frozen=True)
class Contours:
    """Pull drawn contours to image edges of their direction: E = Σ |v_i(θ) × d_i − m_i|², as Eq. 8 in each view.

    A drawn pixel beside nothing or beside something deeper lies on a contour. It goes to the nearest edge across which
    the brightness changes in about the direction in which the surface ends. Of the matches of one bone those that are
    farther than twice their root mean square are left out (§3.3: twice the standard deviation).

    Differs from the paper: distances are of the surface point from the edge's viewing ray, mm, not px in the image, so
    that views of any size weigh alike and the solver is the one of depth.
    """

    look: ClassVar[TermLook] = TermLook("contours", "Contours", "#ffd2ff", "#965a78", (4, 2))

    edges: ImageEdges
    weight: float = 0.1
    max_distance: float = 0.006
    """m at the hand's distance; a farther edge is of something else. Of 6 and 12 mm with weights of 0.03, 0.1 and 0.3
    this pair brought the joints of five marked real views nearest to their marks (docs/cameras.md)."""

    stride: int = 2
    """One contour pixel in this many is matched."""

    jump: float = 0.008
    """Depth step of a contour within the model, m."""

    models: tuple[int, ...] = ()
    """Indices of the models whose contours are matched; all where none are given. The others hide what is behind."""

    drawn: float = DRAWN
    """m; finer pixels than these are drawn together."""

    def find(self, posed: PosedScene, context: FrameContext | None = None) -> PointToLine:
        """Match the contours of the model as it is drawn now."""
        ids, barycentric, pixels, distances = self._match(posed)
        scene, arrays = posed.scene, posed.scene.arrays
        wanted = np.ones(len(scene.models), dtype=np.bool_)
        if self.models:
            wanted[:] = False
            wanted[list(self.models)] = True
        directions, moments = np.empty((len(ids), 3)), np.empty((len(ids), 3))
        count = _aim_into(
            directions,
            moments,
            (ids, barycentric, pixels, distances),
            (scene.vertex_models, wanted, arrays.weight_bones),
            (self.edges.K, self.edges.T_world_camera),
        )
        weights = np.full(count, self.weight)
        return PointToLine(ids[:count], barycentric[:count], directions[:count], moments[:count], weights)

    def measure(self, posed: PosedScene, model: int) -> Array:
        """(N,) distances from each contour pixel of one model to the edge it would go to, m.

        Infinite where there is none, or none within `max_distance`.
        """
        ids, _, _, distances = self._match(posed)
        return distances[posed.scene.vertex_models[ids[:, 0]] == model]

    def _match(self, posed: PosedScene) -> tuple[npt.NDArray[np.int32], Array, Array, Array]:
        """Ids (N, 3), shares (N, 3), edge (N, 2) px and distance (N,) m of every contour pixel."""
        edges = self.edges
        height, width = edges.directions.shape
        shrink = _choose_shrink(posed, edges, self.drawn)
        view = render_view(posed, _shrink(edges.K, shrink), edges.T_world_camera, height // shrink, width // shrink)
        reach = self.max_distance * edges.K[0, 0] * float(view.inverse_depth.max()) + SLACK
        offsets = _offsets(1 << int(np.ceil(np.log2(min(reach, height + width) + 1))))
        room = Matches.room(max(1, int(np.count_nonzero(view.face >= 0))))
        pixels, spans = np.zeros((len(room.ids), 2)), np.zeros(len(room.ids))
        count = _find_into(
            room.ids,
            room.barycentric,
            pixels,
            spans,
            (view.face, view.inverse_depth, view.projected, posed.scene.arrays.faces),
            (edges.directions, edges.places, offsets),
            (edges.K[0, 0], shrink, max(1, self.stride // shrink), self.jump, self.max_distance),
        )
        return room.ids[:count], room.barycentric[:count], pixels[:count], spans[:count]


def _choose_shrink(posed: PosedScene, edges: ImageEdges, width: float) -> int:
    """How many px of the edges a drawn one is wide, so that it is at most `width` m wide where the scene is."""
    T = edges.T_world_camera
    depth = float((posed.vertices[::SAMPLED].mean(axis=0) - T[:3, 3]) @ T[:3, 2])
    return max(1, int(width * edges.K[0, 0] / max(depth, 0.01)))


def _shrink(K: Array, shrink: int) -> Array:
    """(3, 3) of pixels that are so many times as wide; the first one's corner stays where it is."""
    smaller = K / shrink
    smaller[:2, 2] = (K[:2, 2] + 0.5) / shrink - 0.5
    smaller[2, 2] = 1.0
    return smaller


@cache
def _offsets(radius: int) -> npt.NDArray[np.int16]:
    """Those of `sort_offsets`, of a few radii."""
    return sort_offsets(radius)


@njit(cache=True, nogil=True)
def _find_into(ids, barycentric, pixels, distances, drawn, seen, how):
    """Write the matches and return their number.

    Args:
        ids: (N, 3) out.
        barycentric: (N, 3) out.
        pixels: (N, 2) out, column and row of where the drawn pixel's middle goes.
        distances: (N,) out, m; infinite, with an edge of no meaning, where there is none of the direction within reach.
        drawn: face (H, W), inverse depth (H, W), projected (V, 3), faces (F, 3).
        seen: directions (H, W) and places (H, W, 2) as in `ImageEdges`, offsets (N, 2) of `sort_offsets`.
        how: Focal length, px of the edges; how many of these px a drawn one is wide; of its contours' px one in so many
            is matched; `jump` and `max_distance` as in `Contours`.
    """
    face, inverse_depth, projected, faces = drawn
    focal, shrink, stride, jump, max_distance = how
    shift = 0.5 * (shrink - 1)
    height, width = face.shape
    count = 0
    for row in range(1, height - 1):
        for column in range(1, width - 1):
            f = face[row, column]
            if f < 0 or (row + column) % stride != 0:
                continue
            z = 1.0 / inverse_depth[row, column]
            farthest = 1.0 / (z + jump)
            dx, dy = 0.0, 0.0
            if inverse_depth[row, column + 1] < farthest:
                dx += 1.0
            if inverse_depth[row, column - 1] < farthest:
                dx -= 1.0
            if inverse_depth[row + 1, column] < farthest:
                dy += 1.0
            if inverse_depth[row - 1, column] < farthest:
                dy -= 1.0
            if dx == 0.0 and dy == 0.0:
                continue
            # The direction is that of the contour around, not of one step of its staircase.
            for r in range(max(0, row - 2), min(height, row + 3)):
                for c in range(max(0, column - 2), min(width, column + 3)):
                    if inverse_depth[r, c] < farthest:
                        dx += 0.5 * (c - column)
                        dy += 0.5 * (r - row)
            angle = np.arctan2(dy, dx) % np.pi
            direction = int(angle * (DIRECTIONS / np.pi)) % DIRECTIONS
            length = np.hypot(dx, dy)
            if length == 0.0:
                continue
            # The surface ends half a pixel beyond the middle of its last one.
            half = 0.5 * shrink / length
            y, x = shrink * row + shift + half * dy, shrink * column + shift + half * dx
            to_row, to_column, apart = find_nearest_edge(seen, y, x, direction, max_distance * focal / z)
            corners = faces[f]
            barycentric_into(barycentric[count], corners, projected, column, row)
            for i in range(3):
                ids[count, i] = corners[i]
            pixels[count, 0], pixels[count, 1] = to_column - half * dx, to_row - half * dy
            distances[count] = apart * z / focal
            count += 1
    return count


@njit(cache=True, nogil=True)
def _aim_into(directions, moments, found, scene, camera):
    """Keep the matches that count, move them to the front, write their viewing rays and return their number.

    Those of a bone count that are within twice the root mean square of its distances. The bone is the one that moves
    the first vertex of the point's face most.

    Args:
        directions: (N, 3) out, unit, world.
        moments: (N, 3) out, world, m.
        found: ids (N, 3), barycentric (N, 3), pixels (N, 2) and distances (N,) as `_find_into` writes them; what counts
            is moved to the front.
        scene: Model of each vertex (V,), which models count (M,), bones of each vertex (V, 4), heaviest first.
        camera: K (3, 3) px and its place in the world (4, 4).
    """
    ids, barycentric, pixels, distances = found
    models, wanted, bones = scene
    K, T = camera
    sums = np.zeros(int(bones.max()) + 1)
    counts = np.zeros(len(sums))
    for n in range(len(ids)):
        if np.isfinite(distances[n]) and wanted[models[ids[n, 0]]]:
            bone = bones[ids[n, 0], 0]
            sums[bone] += distances[n] * distances[n]
            counts[bone] += 1.0
    kept = 0
    for n in range(len(ids)):
        vertex = ids[n, 0]
        if not (np.isfinite(distances[n]) and wanted[models[vertex]]):
            continue
        bone = bones[vertex, 0]
        if distances[n] * distances[n] * counts[bone] > 4.0 * sums[bone]:
            continue
        for i in range(3):
            ids[kept, i], barycentric[kept, i] = ids[n, i], barycentric[n, i]
        x, y = (pixels[n, 0] - K[0, 2]) / K[0, 0], (pixels[n, 1] - K[1, 2]) / K[1, 1]
        length = np.sqrt(x * x + y * y + 1.0)
        for i in range(3):
            directions[kept, i] = (T[i, 0] * x + T[i, 1] * y + T[i, 2]) / length
        for i in range(3):
            j, k = (i + 1) % 3, (i + 2) % 3
            moments[kept, i] = T[j, 3] * directions[kept, k] - T[k, 3] * directions[kept, j]
        kept += 1
    return kept
