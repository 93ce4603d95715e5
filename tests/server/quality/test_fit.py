"""Doubts about a track: lost hands, hands nobody else sees, fits far from the depth or from what the detector saw."""

from __future__ import annotations

import numpy as np

from server.quality.evidence import APART_PX, DETECTOR_SHARE
from server.quality.fit import LOST, check_fit, check_labels_seen, check_track
from server.quality.views import measure_size
from server.quality.witnesses import Detections, TrackedHands
from tests.server.quality.drawn_hands import draw_hand, label

HAND = draw_hand()
FRAMES = 12


def marks(frames: range = range(FRAMES), moved: dict[int, np.ndarray] | None = None) -> dict:
    """A still hand in `cam0`, elsewhere in the frames of `moved`."""
    return {("cam0", frame, "right"): HAND + (moved or {}).get(frame, 0.0) for frame in frames}


def test_a_lost_hand_that_the_detector_sees_comes_before_one_that_may_be_out_of_sight() -> None:
    tracked = TrackedHands({}, frozenset({(3, "right"), (4, "right")}))
    seen, unseen = check_track(tracked, Detections(marks(range(3, 4)), range(9)))
    assert (seen.frame, seen.kind, seen.score) == (3, "lost", LOST) and "the detector sees it" in seen.reason
    assert (unseen.frame, unseen.kind, unseen.score) == (4, "lost", 1.0) and "out of sight" in unseen.reason


def test_a_hand_that_only_the_track_has_is_doubted_where_the_detector_looked() -> None:
    doubts = list(check_track(TrackedHands(marks(range(6))), Detections(marks(range(3)), range(5))))
    assert [(doubt.frame, doubt.kind) for doubt in doubts] == [(3, "unseen"), (4, "unseen")]


def test_a_fit_is_far_from_the_depth_where_it_is_farther_than_usual() -> None:
    depth = dict.fromkeys(range(FRAMES), 3.0) | {7: 40.0}
    doubts = list(check_track(TrackedHands(marks(), depth_mm=depth), Detections(marks(), range(FRAMES))))
    assert {doubt.kind for doubt in doubts} == {"depth"}
    assert [doubt.frame for doubt in doubts if doubt.score > 1.0] == [7]
    assert "40.0 mm from the depth; usually it is 3.0 mm" in max(doubts, key=lambda doubt: doubt.score).reason


def test_a_track_where_the_detector_sees_the_hand_is_not_doubted() -> None:
    assert all(doubt.score < 1.0 for doubt in check_fit(marks(), marks()))
    assert list(check_fit(marks(), {})) == []


def test_a_whole_hand_elsewhere_is_doubted_as_a_whole() -> None:
    away = 2.0 * DETECTOR_SHARE * measure_size(HAND)
    doubts = {doubt.frame: doubt for doubt in check_fit(marks(moved={5: np.array([away, 0.0])}), marks())}
    assert doubts[5].score >= 2.0 and doubts[5].joints == () and doubts[5].camera == "cam0"
    assert all(doubt.score < 1.0 for frame, doubt in doubts.items() if frame != 5)


def test_one_joint_elsewhere_is_named() -> None:
    moved = np.zeros((21, 2))
    moved[8] = [8.0 * APART_PX, 0.0]
    doubts = {doubt.frame: doubt for doubt in check_fit(marks(moved={5: moved}), marks())}
    assert doubts[5].joints == (8,) and doubts[5].score > 1.0
    assert (
        "The index tip of the fit is 64 px from what the detector saw in cam0; usually it is 0 px." in doubts[5].reason
    )


def test_a_score_ends_at_ten_and_hands_of_few_joints_are_not_judged() -> None:
    assert max(doubt.score for doubt in check_fit(marks(moved={5: np.array([9000.0, 0.0])}), marks())) == 10.0
    few = {place: np.where(np.arange(21)[:, None] < 3, pixels, np.nan) for place, pixels in marks().items()}
    assert list(check_fit(few, marks())) == []


def test_labels_are_compared_with_detector_and_track_and_carry_the_label() -> None:
    labels = [label(HAND + np.array([60.0, 0.0]) if frame == 4 else HAND, frame) for frame in range(FRAMES)]
    doubts = [doubt for doubt in check_labels_seen(labels, marks(), marks()) if doubt.score > 1.0]
    assert [doubt.frame for doubt in doubts] == [4, 4] and all(doubt.label is labels[4] for doubt in doubts)
    assert "what the detector saw" in doubts[0].reason and "the track" in doubts[1].reason
