"""The ball of `uvr_sphere_green` as an object: its size, the run with it, and whether it is where the green is.

The tracker is told a sphere's mesh and nothing of its place, size or colour: it tells skin from other things only.
The green pixels are the measure; they are taken by a colour rule here, as much of the ball as is seen.
"""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import trimesh

from benchmarks.object_scale import ScaleView, find_scale
from tracker.capture.recorded_object import RecordedObject
from tracker.capture.sequence import Sequence, load_sequence, save_sequence_json
from tracker.fitting.frame_fit import draw
from tracker.fitting.object_quality import measure_object_quality
from tracker.fitting.region import region_around
from tracker.model.files import load_model
from tracker.observation import observe
from tracker.rendering import render_view
from tracker.tracking.track import Track
from tracker.tracking.watch_objects import OBJECT_STATUSES

NOMINAL = 0.025
"""Radius of the sphere that is scaled, m."""

RIGHT, WRONG = 0.6, 0.5
"""Overlap (intersection over union) with the green pixels from which the ball counts as right; below, as wrong."""

HUE, SATURATION, VALUE = (40, 85), 50, 40
"""Of the ball in OpenCV's units; skin has a hue below 30, the cuff above 90."""


def measure_radius(sequence: Sequence, hand: Track, every: int = 20) -> float:
    """The ball's radius, m, from a sphere of nominal size and a track of the hand alone."""
    path = sequence.folder / "nominal.ply"
    trimesh.creation.icosphere(subdivisions=3, radius=NOMINAL).export(str(path))
    model, views = load_model(path), []
    for place in range(every // 2, len(hand.frame), every):
        frame, camera = hand.setup.read(sequence, int(hand.frame[place]))
        views.append(ScaleView(frame, camera, [(hand.setup.models[0], hand.pose[place])]))
    return NOMINAL * find_scale(model, views, hand.setup.preprocessing)


def add_ball(sequence: Sequence, radius: float) -> Sequence:
    """The recording with a ball that nobody placed."""
    trimesh.creation.icosphere(subdivisions=3, radius=radius).export(str(sequence.folder / "ball.ply"))
    save_sequence_json(replace(sequence, objects=(RecordedObject("ball", "ball.ply"),)))
    return load_sequence(sequence.folder)


def find_green(color: np.ndarray) -> np.ndarray:
    """(H, W) the ball's pixels, the sensor's gaps in it closed."""
    hue, saturation, value = np.moveaxis(cv2.cvtColor(color, cv2.COLOR_RGB2HSV), 2, 0)
    green = ((hue > HUE[0]) & (hue < HUE[1]) & (saturation > SATURATION) & (value > VALUE)).astype(np.uint8)
    green = cv2.morphologyEx(green, cv2.MORPH_CLOSE, np.ones((5, 5), np.uint8))
    green = cv2.morphologyEx(green, cv2.MORPH_OPEN, np.ones((3, 3), np.uint8))
    count, regions, sizes, _ = cv2.connectedComponentsWithStats(green)
    return regions == 1 + np.argmax(sizes[1:, cv2.CC_STAT_AREA]) if count > 1 else np.zeros(green.shape, dtype=bool)


def measure_overlap(sequence: Sequence, found: Track, place: int) -> float:
    """Intersection over union of the drawn ball and the green pixels; what something nearer hides does not count."""
    index, setup = int(found.frame[place]), found.setup
    frame, camera = setup.read(sequence, index)
    assert frame.color is not None and frame.depth is not None
    view = render_view(
        setup.scene.pose_at(found.pose[place]), camera.K, camera.T_world_camera, camera.height, camera.width
    )
    green = find_green(frame.color)
    drawn = (view.face >= 0) & (setup.scene.face_models == setup.names.index("ball"))[view.face]
    drawn &= green | ~((frame.depth > 0) & (frame.depth < view.depth - 0.010))
    return float(np.count_nonzero(drawn & green)) / max(1, np.count_nonzero(drawn | green))


def describe_ball(sequence: Sequence, found: Track) -> str:
    """What became of the ball, in words and figures."""
    overlaps = np.array([measure_overlap(sequence, found, place) for place in range(len(found.frame))])
    statuses = np.array(OBJECT_STATUSES)[found.chunk.object_status[:, 0]]
    counts = ", ".join(f"{np.count_nonzero(statuses == status)} {status}" for status in OBJECT_STATUSES)
    residuals = [_residual(sequence, found, int(place)) for place in np.flatnonzero(statuses == "ok")]
    is_silent = (overlaps < WRONG) & (statuses == "ok")
    return (
        f"ball: {counts}; {np.median(residuals):.1f} mm from the depth at the median; overlap with the green pixels "
        f"{np.median(overlaps):.2f} at the median, at least {RIGHT} in {100.0 * np.mean(overlaps >= RIGHT):.1f} % of "
        f"the frames, below {WRONG} in frames {np.flatnonzero(overlaps < WRONG).tolist()}, of which called ok: "
        f"{np.flatnonzero(is_silent).tolist()}"
    )


def _residual(sequence: Sequence, found: Track, place: int) -> float:
    """Median distance of the ball from the depth where both are, mm."""
    setup = found.setup
    frame, camera = setup.read(sequence, int(found.frame[place]))
    posed = setup.scene.pose_at(found.pose[place])
    region = region_around(posed.vertices, camera)
    assert region is not None
    seen = observe(frame, camera, region, setup.preprocessing)
    return 1e3 * measure_object_quality(draw(posed, seen), seen, setup.names.index("ball")).depth_residual
