"""Where a colour image should show the nails of posed hands, and what is looked at to find them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.capture.camera import Camera
from tracker.detection.patch_image import PatchImage
from tracker.fitting.region import region_around
from tracker.model.scene import PosedScene
from tracker.observation import Region
from tracker.rendering import render_view
from tracker.rendering.seen_nails import NailPlaces

Array = npt.NDArray[np.float64]

MARGIN = 0.030
"""m; nails are looked for so far beside the hands as they are drawn."""


@dataclass(frozen=True)
class NailView:
    """The part of an image around posed hands.

    Attributes:
        region: Where it lies in the image.
        image: What a forest looks at in it.
        is_visible: (N,) which nails it should show.
    """

    region: Region
    image: PatchImage
    is_visible: npt.NDArray[np.bool_]


def draw_nail_view(
    posed: PosedScene, places: NailPlaces, camera: Camera, color: npt.NDArray[np.uint8]
) -> NailView | None:
    """What an image should show; None where it shows nothing of the scene.

    Args:
        posed: Hands, and objects that may hide them.
        places: Of the scene's nails.
        camera: Without distortion.
        color: (H, W, 3) RGB, as the camera sees it.
    """
    region = region_around(posed.vertices, camera)
    if region is None:
        return None
    first = np.array([region.column, region.row], dtype=np.float64)
    K = camera.K.copy()
    K[:2, 2] -= first
    drawn = render_view(posed, K, camera.T_world_camera, region.height, region.width)
    depth = drawn.depth
    models = np.array([model.hand is not None for model in posed.scene.models])
    is_hand = (drawn.face >= 0) & models[posed.scene.face_models[np.maximum(drawn.face, 0)]]
    if not is_hand.any():
        return None
    inside = (slice(region.row, region.row + region.height), slice(region.column, region.column + region.width))
    own = np.where(is_hand, depth, 0.0).astype(np.float32)
    image = PatchImage.around(own, np.ascontiguousarray(color[inside]), float(camera.K[0, 0]), MARGIN)
    return NailView(region, image, places.find_visible(posed.vertices, camera, depth, first))
