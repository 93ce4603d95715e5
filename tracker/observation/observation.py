"""What the tracker keeps of one depth image: the D of [T16] Eq. 5, §3.2.1."""

from __future__ import annotations

from dataclasses import dataclass, replace

import cv2
import numpy as np
import numpy.typing as npt
from numba import njit

from tracker.capture.camera import Camera
from tracker.capture.frame import Frame
from tracker.errors import FrameError
from tracker.observation.depth_edges import find_depth_edges_into
from tracker.observation.normals import compute_points_and_normals_into
from tracker.observation.skin import compute_skin_log_ratio

HAND, OTHER = 1, 2
"""Bits of a pixel's label: may be hand, may be something else. Without colour a pixel is both."""

SHADOW = 15
"""Width in px of the strip beside a nearer surface in which a pattern camera sees no depth. 75 mm between projector and
camera, 525 px of focal length and a step of 10 cm at half a metre give 13."""


@dataclass(frozen=True)
class Region:
    """Part of the image and of the depth range in which something is expected.

    Attributes:
        row, column: First pixel.
        height, width: px.
        near, far: Depth range, m.
    """

    row: int
    column: int
    height: int
    width: int
    near: float
    far: float


@dataclass(frozen=True)
class Preprocessing:
    """How a depth image is prepared, [T16] §3.2.1.

    Attributes:
        use_skin: Separate hand from other surfaces by colour, where there is colour.
        skin_threshold: Least smoothed log likelihood ratio skin : non-skin of a hand pixel.
        bilateral_diameter: px; 0 leaves the depth as it is.
        bilateral_depth: Depth difference at which smoothing fades, m.
        edge_jump: Depth step that makes a discontinuity, m.
        objects: Prepare nearest pixels of other things too; without objects in the scene nobody asks for them.
    """

    use_skin: bool = True
    skin_threshold: float = -2.0
    bilateral_diameter: int = 5
    bilateral_depth: float = 0.010
    edge_jump: float = 0.015
    objects: bool = False


@dataclass(frozen=True)
class Observation:
    """A region of one depth image, prepared.

    Attributes:
        region: Where it lies in the image.
        K: (3, 3) intrinsics of the region as it is sampled: pixel (0, 0) is the region's first, px.
        T_world_camera: (4, 4).
        points: (H, W, 3) float32 world, m.
        normals: (H, W, 3) float32 world, unit, towards the camera; 0 where there is none.
        depth: (H, W) float32 smoothed depth, m; 0 where there is no value in the region's depth range.
        labels: (H, W) uint8 bits HAND and OTHER; 0 where there is no depth.
        nearest_pixel: (2, H, W, 2) int16 row and column of the nearest pixel that may be hand, and may be other; pixels
            in the depth shadow of a hand that have the colour of skin may be hand.
        edges: (2, H, W) uint8 1 at depth discontinuities of hand, and of other.
        color: (H, W, 3) uint8 RGB, sampled as the rest is; None where the frame has none.
    """

    region: Region
    K: npt.NDArray[np.float64]
    T_world_camera: npt.NDArray[np.float64]
    points: npt.NDArray[np.float32]
    normals: npt.NDArray[np.float32]
    depth: npt.NDArray[np.float32]
    labels: npt.NDArray[np.uint8]
    nearest_pixel: npt.NDArray[np.int16]
    edges: npt.NDArray[np.uint8]
    color: npt.NDArray[np.uint8] | None = None

    def thin(self, stride: int) -> Observation:
        """Every `stride`-th pixel, for scoring poses; nearest pixels are left out."""
        every = (slice(None, None, stride), slice(None, None, stride))
        K = self.K.copy()
        K[:2] /= stride
        labels = np.ascontiguousarray(self.labels[every])
        nowhere = np.full((2, *labels.shape, 2), -1, dtype=np.int16)
        return replace(
            self,
            K=K,
            points=np.ascontiguousarray(self.points[every]),
            normals=np.ascontiguousarray(self.normals[every]),
            depth=np.ascontiguousarray(self.depth[every]),
            labels=labels,
            nearest_pixel=nowhere,
            edges=np.zeros((2, *labels.shape), dtype=np.uint8),
            color=None if self.color is None else self.color[every],
        )

    def thin_to(self, count: int) -> Observation:
        """The same with about `count` hand pixels, or all where there are fewer."""
        return self.thin(max(1, round((self.hand_count / count) ** 0.5)))

    @property
    def hand_count(self) -> int:
        """Pixels that may be hand."""
        return int(np.count_nonzero(self.labels & HAND))


def observe(frame: Frame, camera: Camera, region: Region, how: Preprocessing, stride: int = 1) -> Observation:
    """Prepare a region of a frame, every `stride`-th pixel of it.

    Raises:
        FrameError: The frame has no depth, or its size is not the camera's.
    """
    if frame.depth is None:
        raise FrameError(f"Frame {frame.index} of camera {frame.camera} has no depth; this tracker needs depth images.")
    if frame.depth.shape != (camera.height, camera.width):
        raise FrameError(
            f"Frame {frame.index} of camera {frame.camera}: depth is {frame.depth.shape[1]}x{frame.depth.shape[0]}, "
            f"the camera {camera.width}x{camera.height}."
        )
    rows = slice(region.row, region.row + region.height, stride)
    columns = slice(region.column, region.column + region.width, stride)
    raw = frame.depth[rows, columns]
    inside = (raw >= region.near) & (raw <= region.far)
    depth = np.where(inside, raw, np.float32(0.0))
    if how.bilateral_diameter > 0:
        smooth = cv2.bilateralFilter(depth, how.bilateral_diameter, how.bilateral_depth, how.bilateral_diameter / 2)
        depth = np.where(inside, smooth, np.float32(0.0))
    K = camera.K.copy()
    K[0, 2] -= region.column
    K[1, 2] -= region.row
    K[:2] /= stride
    color = None if frame.color is None else frame.color[rows, columns]
    labels, is_skin = _label(inside, color if how.use_skin else None, how.skin_threshold)
    if frame.is_hand is not None and how.use_skin:
        labels = np.where(inside, np.where(frame.is_hand[rows, columns], np.uint8(HAND), np.uint8(OTHER)), np.uint8(0))
    points = np.zeros((*depth.shape, 3), dtype=np.float32)
    normals = np.zeros_like(points)
    compute_points_and_normals_into(points, normals, depth, K, camera.T_world_camera)
    nearest = [_nearest_of(labels, HAND, depth, how.edge_jump, (raw == 0) & is_skin)]
    nearest.append(
        _nearest_of(labels, OTHER, depth, how.edge_jump, np.zeros_like(is_skin)) if how.objects else _nowhere(labels)
    )
    return Observation(
        region,
        K,
        camera.T_world_camera,
        points,
        normals,
        depth,
        labels,
        np.stack([pixels for pixels, _ in nearest]),
        np.stack([edges for _, edges in nearest]),
        color,
    )


def undistort(frame: Frame, camera: Camera) -> tuple[Frame, Camera]:
    """The frame as an ideal pinhole camera of the same K would see it, nearest pixels, and that camera."""
    if not camera.distortion.size or not np.any(camera.distortion):
        return frame, camera
    size = (camera.width, camera.height)
    maps = cv2.initUndistortRectifyMap(camera.K, camera.distortion, np.eye(3), camera.K, size, cv2.CV_32FC1)
    depth = None if frame.depth is None else cv2.remap(frame.depth, *maps, cv2.INTER_NEAREST).astype(np.float32)
    color = None if frame.color is None else cv2.remap(frame.color, *maps, cv2.INTER_LINEAR).astype(np.uint8)
    ideal = Camera(camera.id, camera.width, camera.height, camera.K, np.zeros(0), camera.T_world_camera)
    return Frame(frame.index, frame.camera, color, depth), ideal


def _label(
    inside: npt.NDArray[np.bool_], color: npt.NDArray[np.uint8] | None, threshold: float
) -> tuple[npt.NDArray[np.uint8], npt.NDArray[np.bool_]]:
    """Labels by colour, and which pixels look like skin, depth or not.

    For labels the log ratio is averaged with its neighbours', for palms are pale in spots.
    """
    if color is None:
        return np.where(inside, np.uint8(HAND | OTHER), np.uint8(0)), np.zeros_like(inside)
    weight = inside.astype(np.float32)
    anywhere = compute_skin_log_ratio(color)
    log_ratio = anywhere * weight
    mean = cv2.blur(log_ratio, (9, 9)) / np.maximum(cv2.blur(weight, (9, 9)), 1e-3)
    is_hand = 0.5 * (mean + log_ratio) > threshold
    labels = np.where(inside, np.where(is_hand, np.uint8(HAND), np.uint8(OTHER)), np.uint8(0))
    return labels, anywhere > threshold


def _nearest_of(
    labels: npt.NDArray[np.uint8],
    bit: int,
    depth: npt.NDArray[np.float32],
    jump: float,
    is_alike: npt.NDArray[np.bool_],
) -> tuple[npt.NDArray[np.int16], npt.NDArray[np.uint8]]:
    """Nearest pixel and discontinuities of one label.

    Small holes between its pixels count as its own, and so do alike pixels without depth beside them: free space is
    only what was seen to be free.
    """
    mask = ((labels & bit) > 0).astype(np.uint8)
    edges = np.zeros_like(mask)
    find_depth_edges_into(edges, depth, mask, jump)
    if is_alike.any():
        beside = cv2.dilate(mask, np.ones((2 * SHADOW + 1, 2 * SHADOW + 1), np.uint8)) > 0
        mask[beside & is_alike] = 1
    closed = cv2.morphologyEx(mask, cv2.MORPH_CLOSE, np.ones((5, 5), np.uint8))
    return _nearest(closed.astype(np.uint8, copy=False)), edges


def _nowhere(labels: npt.NDArray[np.uint8]) -> tuple[npt.NDArray[np.int16], npt.NDArray[np.uint8]]:
    return np.full((*labels.shape, 2), -1, dtype=np.int16), np.zeros_like(labels)


def _nearest(mask: npt.NDArray[np.uint8]) -> npt.NDArray[np.int16]:
    """(H, W, 2) row and column of the nearest pixel set in the mask; -1 everywhere if none is."""
    nearest = np.full((*mask.shape, 2), -1, dtype=np.int16)
    if mask.any():
        _, index = cv2.distanceTransformWithLabels(1 - mask, cv2.DIST_L2, 5, labelType=cv2.DIST_LABEL_PIXEL)
        _places_into(nearest, mask, index)
    return nearest


@njit(cache=True, nogil=True)
def _places_into(nearest, mask, index):
    """Turn the index of the nearest set pixel (H, W) into its row and column."""
    height, width = mask.shape
    rows = np.zeros(height * width + 1, dtype=np.int16)
    columns = np.zeros(height * width + 1, dtype=np.int16)
    for row in range(height):
        for column in range(width):
            if mask[row, column]:
                rows[index[row, column]], columns[index[row, column]] = row, column
    for row in range(height):
        for column in range(width):
            nearest[row, column, 0], nearest[row, column, 1] = rows[index[row, column]], columns[index[row, column]]
