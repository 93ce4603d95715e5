"""A picture of the queue shows the hand where the worst doubt is, by the best that is known of it."""

from __future__ import annotations

import numpy as np

from server.quality.doubt import Doubt
from server.quality.find import Setting
from server.quality.queue import Queued
from server.quality.sight import find_sight
from server.quality.witnesses import Detections, TrackedHands
from tests.server.quality.drawn_hands import cameras, draw_hand, label

PLACE = ("cam0", 0, "right")


def queued(*cameras_of_doubts: str) -> Queued:
    doubts = tuple(Doubt(0, "right", "fit", 2.0, camera, (), "") for camera in cameras_of_doubts)
    return Queued(0, "right", 2.0, doubts)


def know(tracked: dict | None = None, detected: dict | None = None) -> Setting:
    return Setting(
        ("right",), cameras(3), tracked=TrackedHands(tracked or {}), detected=Detections(detected or {}, range(1))
    )


def test_a_label_is_shown_before_a_track_and_a_track_before_the_detector() -> None:
    tracked, detected = {PLACE: draw_hand() + 1.0}, {PLACE: draw_hand() + 2.0}
    both = know(tracked, detected)
    assert find_sight(queued("cam0"), [label()], both).shows == "label"
    sight = find_sight(queued("cam0"), [], both)
    assert sight.shows == "track"
    np.testing.assert_array_equal(sight.pixels, draw_hand() + 1.0)
    assert find_sight(queued("cam0"), [], know(detected=detected)).shows == "detector"


def test_the_camera_of_the_worst_doubt_that_names_one_comes_first() -> None:
    setting = know({(camera, 0, "right"): draw_hand() for camera in ("cam0", "cam1", "cam2")})
    assert find_sight(queued("", "cam2", "cam1"), [], setting).camera == "cam2"
    assert find_sight(queued(""), [], setting).camera == "cam0"


def test_where_the_doubts_camera_knows_nothing_the_first_that_does_is_shown() -> None:
    unknown = {("cam2", 0, "right"): np.full((21, 2), np.nan), ("cam1", 0, "right"): draw_hand()}
    sight = find_sight(queued("cam2"), [], know(unknown))
    assert (sight.camera, sight.shows) == ("cam1", "track")


def test_labels_of_another_frame_or_hand_are_not_shown() -> None:
    others = [label(frame=1), label(hand="left")]
    sight = find_sight(queued("cam1"), others, know())
    assert (sight.camera, sight.shows) == ("cam1", "nothing") and np.isnan(sight.pixels).all()
