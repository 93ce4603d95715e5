"""What the swarm is shown of one colour image: where skin is and how far the next edge is."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

from benchmarks.baselines.drawing import Canvas
from tracker.capture.frame import CameraFrame
from tracker.geometry import se3
from tracker.observation import Preprocessing
from tracker.observation.image_edges import find_image_edges
from tracker.observation.image_part import frame_points
from tracker.observation.skin import compute_skin_log_ratio
from tracker.tracking.view_edges import find_place

Array = npt.NDArray[np.float64]

MARGIN = 0.04
"""m around the scene that are looked at."""

SMOOTH = 9
"""px, side of the square whose mean skin colour counts as much as the pixel's own, as before a depth image."""


@dataclass(frozen=True)
class SkinView:
    """Every so many pixels of a part of an image, as an ideal pinhole camera would show it.

    Attributes:
        canvas: The thinned part.
        is_skin: (H, W) the colour is that of skin.
        edge_mm: (H, W) distance of the nearest edge of the image, mm at the scene's distance.
        step_mm: Of one pixel to the next, mm there.
    """

    canvas: Canvas
    is_skin: npt.NDArray[np.bool_]
    edge_mm: npt.NDArray[np.float32]
    step_mm: float


def see_skin(view: CameraFrame, vertices: Array, side: int) -> SkinView | None:
    """The part of a colour image around a scene; None where it is out of sight.

    Skin is what Jones and Rehg's mixtures call so, with the threshold of depth images; nothing is known of the
    background. Edges are those of the whole image, whose distances are measured before it is thinned.

    Args:
        view: Camera and image.
        vertices: (V, 3) of the scene where it is expected, world, m.
        side: Pixels along the longer side of the result, at most.
    """
    points, margin = find_place(vertices, view.camera, MARGIN)
    window = frame_points(view.camera, points, margin)
    assert view.frame.color is not None
    edges = find_image_edges(view.frame.color, view.camera, points, margin)
    if window is None or edges is None:
        return None
    stride = -(-max(window.width, window.height) // side)
    ratio = compute_skin_log_ratio(np.ascontiguousarray(window.cut(view.frame.color)))
    is_skin = 0.5 * (cv2.blur(ratio, (SMOOTH, SMOOTH)) + ratio) > Preprocessing().skin_threshold
    apart = cv2.distanceTransform((edges.directions == 0).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
    K = window.K
    pixel_mm = 1e3 * float(np.median(se3.transform(view.camera.T_camera_world, vertices)[:, 2]) / K[0, 0])
    K[:2] /= stride
    is_skin = np.ascontiguousarray(is_skin[::stride, ::stride])
    return SkinView(
        Canvas(K, view.camera.T_world_camera, is_skin.shape),
        is_skin,
        np.ascontiguousarray(pixel_mm * apart[::stride, ::stride], dtype=np.float32),
        stride * pixel_mm,
    )
