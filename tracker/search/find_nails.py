"""Look for finger nails in the colour views of a moment, around where the hands are expected."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tracker.capture.frame import CameraFrame
from tracker.detection import Forest
from tracker.detection.detect import DetectOptions, find_in_image
from tracker.fitting.map_views import map_views
from tracker.model.scene import PosedScene
from tracker.observation import undistort
from tracker.rendering.seen_nails import NailPlaces
from tracker.search.nail_views import draw_nail_view
from tracker.terms.nails import Nails, SeenNails


def find_nails_in_views(
    forest: Forest,
    posed: PosedScene,
    views: Sequence[CameraFrame],
    threads: int = 1,
    options: DetectOptions | None = None,
) -> Nails:
    """The nails of all views as a term; its views without colour, or without a hand, have none.

    Args:
        forest: Finds nails in colour.
        posed: Where the hands are expected.
        views: Of one moment.
        threads: Views that are looked at together.
        options: How to look.
    """
    assert forest.what == "nails" and forest.kind == "color"
    places = NailPlaces.of(posed.scene)

    def look(view: CameraFrame) -> SeenNails | None:
        if view.frame.color is None:
            return None
        frame, camera = undistort(view.frame, view.camera)
        assert frame.color is not None
        drawn = draw_nail_view(posed, places, camera, frame.color)
        if drawn is None:
            return None
        peaks = find_in_image(forest, drawn.image, options or DetectOptions())
        pixels = peaks.centers + np.array([drawn.region.column, drawn.region.row])
        return SeenNails(camera, pixels, drawn.is_visible)

    return Nails(places, [seen for seen in map_views(look, views, threads) if seen is not None])
