"""Errors against annotations follow the protocol of [T16] section 4.1."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from tracker.capture.annotations import Annotation, Annotations
from tracker.capture.joint_source import JointSource
from tracker.evaluation import evaluate_track


def annotated(known, change) -> Annotations:
    """The true annotations, each changed in place by `change(frame, points)`."""
    items = []
    for item in known.annotations.items:
        points = item.points.copy()
        change(item.frame, points)
        items.append(Annotation(item.frame, item.camera, item.hand, points))
    return Annotations(tuple(items))


def test_the_true_poses_lie_on_the_true_annotations(known):
    evaluation = evaluate_track(known.track(), known.annotations)
    assert evaluation.statistics.count == 5 * 21
    assert evaluation.error.max() < 1e-6


def test_marks_3_and_4_px_beside_in_both_directions_make_5_px(known):
    def shift(frame: int, points: np.ndarray) -> None:
        points[:, :2] += [3.0, 4.0]

    evaluation = evaluate_track(known.track(), annotated(known, shift))
    np.testing.assert_allclose(evaluation.error, 5.0, atol=1e-6)


def test_occluded_joints_count_and_absent_ones_do_not(known):
    def mark(frame: int, points: np.ndarray) -> None:
        points[:, 2] = 2
        points[4] = [*points[4, :2] + [10.0, 0.0], 1]
        points[8] = 0.0

    evaluation = evaluate_track(known.track(), annotated(known, mark))
    document = evaluation.to_json()
    assert document["joint_error_px"]["count"] == 5 * 20
    assert document["joint_error_px"]["mean"] == pytest.approx(10 / 20)
    assert document["joint_error_px"]["max"] == pytest.approx(10.0)
    assert document["occluded_error_px"]["mean"] == pytest.approx(10.0)
    assert document["visible_error_px"]["mean"] == pytest.approx(0.0, abs=1e-6)
    assert document["joints"][4]["mean"] == pytest.approx(10.0)
    assert document["joints"][8] == {
        "joint": "index_tip", "count": 0, "mean": None, "std": None, "median": None, "p75": None, "p95": None,
        "p99": None, "max": None
    }  # fmt: skip


def test_lost_frames_count_like_any_other_and_the_worst_come_first(known):
    def shift(frame: int, points: np.ndarray) -> None:
        points[:, 0] += frame

    evaluation = evaluate_track(known.track(statuses=("ok", "ok", "ok", "ok", "lost")), annotated(known, shift))
    document = evaluation.to_json()
    assert [item["frame"] for item in document["worst"]] == [4, 3, 2, 1, 0]
    assert document["worst"][0]["status"] == "lost"
    assert document["joint_error_px"]["mean"] == pytest.approx(2.0)


def test_what_the_track_does_not_hold_is_listed_not_counted(known):
    points = known.annotations.items[0].points
    more = Annotations(
        (
            *known.annotations.items,
            Annotation(99, "cam0", "right", points),
            Annotation(0, "cam7", "right", points),
            Annotation(0, "cam0", "left", points),
        )
    )
    document = evaluate_track(known.track(), more).to_json()
    assert (document["annotated"], document["evaluated"]) == (8, 5)
    assert {(item["frame"], item["camera"], item["hand"]) for item in document["untracked"]} == {
        (99, "cam0", "right"),
        (0, "cam7", "right"),
        (0, "cam0", "left"),
    }


def test_a_track_without_annotations_has_no_numbers_and_says_so_in_valid_json(known):
    document = evaluate_track(known.track(), Annotations()).to_json()
    assert document["evaluated"] == 0
    assert document["joint_error_px"]["mean"] is None
    json.dumps(document, allow_nan=False)


def test_what_came_from_a_track_does_not_judge_one_unless_asked(known):
    accepted = JointSource("track", "Track 2")
    sources = (None, accepted, JointSource("copy", "frame 1"), JointSource("copy", "frame 2", is_independent=True))
    items = [
        replace(
            item,
            sources=(
                *sources,
                JointSource("fit"),
                JointSource("import", "coco_keypoints"),
                JointSource("detector", "Hand detector"),
                *(None,) * 14,
            ),
        )
        for item in known.annotations.items
    ]
    items[0] = replace(items[0], sources=(accepted,) * 21)
    found = evaluate_track(known.track(), Annotations(tuple(items)))
    assert np.isfinite(found.error[0]).sum() == 0
    assert np.flatnonzero(np.isnan(found.error[1])).tolist() == [1, 2, 4, 6]
    assert found.left_out.sum() == 21 + 4 * 4
    document = found.to_json()
    assert (document["evaluated"], document["left_out_joints"]) == (4, 37)
    assert {one["words"]: one["joints"] for one in document["sources"] if not one["is_counted"]} == {
        "accepted from Track 2": 25,
        "copied from another frame and not known to be free of a track": 4,
        "accepted from a model fit": 4,
        "accepted from the hand detector": 4,
    }
    assert evaluate_track(known.track(), Annotations(tuple(items)), ("all",)).statistics.count == 5 * 21
    assert evaluate_track(known.track(), Annotations(tuple(items)), ("import", "fit")).statistics.count == 8
    assert evaluate_track(known.track(), Annotations(tuple(items)), ("detector",)).statistics.count == 4
