"""The document of a comparison holds the numbers that plain NumPy finds."""

from __future__ import annotations

import json

import numpy as np
import pytest

from tests.tracker.evaluation.judged import judge, make_evaluation
from tracker.evaluation.comparison import compare_tracks


@pytest.fixture
def errors() -> np.ndarray:
    found = np.random.default_rng(1).gamma(2.0, 3.0, (30, 21))
    found[4, 7] = np.nan
    return found


def test_every_statistic_is_that_of_its_plain_twin(errors) -> None:
    visibility = np.random.default_rng(2).integers(1, 3, (30, 21))
    hands = tuple("left" if item % 3 == 0 else "right" for item in range(30))
    cameras = tuple("cam1" if item % 2 else "cam0" for item in range(30))
    frames = [item // 2 for item in range(30)]
    made = make_evaluation(errors, frames, visibility=visibility, hand=hands, camera=cameras)
    document = compare_tracks([judge("a", made)], within_px=6.0)
    (track,) = document["tracks"]
    known = errors[np.isfinite(errors)]
    twin = {
        "count": known.size, "mean": known.mean(), "std": known.std(), "median": np.median(known),
        "p75": np.percentile(known, 75), "p95": np.percentile(known, 95), "p99": np.percentile(known, 99),
        "max": known.max(),
    }  # fmt: skip
    assert track["error"] == pytest.approx(twin)
    assert track["within"] == pytest.approx((known <= 6.0).mean())
    for share, threshold in zip(track["shares"], document["thresholds_px"], strict=True):
        assert share == pytest.approx((known <= threshold).mean())
    assert track["visible"]["mean"] == pytest.approx(np.nanmean(errors[visibility == 2]))
    assert track["occluded"]["std"] == pytest.approx(np.nanstd(errors[visibility == 1]))
    assert track["hands"]["left"]["max"] == pytest.approx(np.nanmax(errors[::3]))
    assert track["cameras"]["cam1"]["mean"] == pytest.approx(np.nanmean(errors[1::2]))
    assert [row["mean"] for row in track["by_joint"]] == pytest.approx(np.nanmean(errors, axis=0).tolist())
    assert track["curve"]["frame"] == list(range(15))
    assert track["curve"]["mean"] == pytest.approx([np.nanmean(errors[2 * at : 2 * at + 2]) for at in range(15)])
    assert track["annotated_frames"] == 15
    worst = np.argsort(-np.nanmean(errors, axis=1))[:12]
    assert [item["frame"] for item in track["worst"]] == [frames[item] for item in worst]
    assert track["worst"][0]["max_px"] == pytest.approx(np.nanmax(errors[worst[0]]))
    json.dumps(document, allow_nan=False)


def test_a_part_is_judged_alone(errors) -> None:
    visibility = np.random.default_rng(2).integers(1, 3, (30, 21))
    hands = tuple("left" if item % 3 == 0 else "right" for item in range(30))
    made = make_evaluation(errors, visibility=visibility, hand=hands)
    part = made.select(hand="left", visibility=1, without_start=True)
    wanted = np.where(visibility == 1, errors, np.nan)[3::3]
    np.testing.assert_array_equal(part.error, wanted)
    assert part.frame.tolist() == list(range(3, 30, 3))


def test_tracks_are_set_against_the_reference_over_what_all_have(errors) -> None:
    better, worse = errors - 0.5 * errors.clip(max=1.0), errors + 1.0
    judged = [
        judge("a", make_evaluation(errors), terms="LO", iterations=10),
        judge("b", make_evaluation(better), terms="LO+SC", iterations=10),
        judge("c", make_evaluation(worse[:20]), terms="LO", iterations=5),
    ]
    document = compare_tracks(judged, reference="a")
    a, b, c = document["tracks"]
    assert document["reference"] == "a" and a["paired"] is None
    assert b["paired"]["high"] < 0 and b["paired"]["better"] == 1.0
    assert c["paired"]["difference"] == pytest.approx(1.0)
    assert c["paired"]["frames"] == 20
    assert a["common"]["count"] == b["common"]["count"] == c["common"]["count"] == 20 * 21 - 1
    assert a["common"]["mean"] == pytest.approx(np.nanmean(errors[:20]))
    assert document["parameters"] == {
        "different": [
            {"name": "terms", "values": {"a": "LO", "b": "LO+SC", "c": "LO"}},
            {"name": "iterations", "values": {"a": 10, "b": 10, "c": 5}},
        ],
        "same": {},
    }


def test_a_method_is_pooled_over_its_recordings_and_set_against_the_references_method(errors) -> None:
    judged = [
        judge("a1", make_evaluation(errors), "one", terms="LO", last_frame=9),
        judge("b1", make_evaluation(errors + 2.0), "one", terms="LO+C", last_frame=9),
        judge("a2", make_evaluation(errors[:10]), "two", terms="LO", last_frame=19),
        judge("b2", make_evaluation(errors[:10] + 1.0), "two", terms="LO+C", last_frame=19),
        judge("a3", make_evaluation(errors[:5]), "three", terms="LO", last_frame=4),
    ]
    document = compare_tracks(judged, reference="a1")
    plain, collision = document["methods"]
    assert (plain["name"], plain["recordings"], plain["is_reference"]) == ("terms LO", 3, True)
    assert (collision["name"], collision["tracks"]) == ("terms LO+C", ["b1", "b2"])
    assert collision["paired"]["frames"] == 40
    counts = np.array([30 * 21 - 1, 10 * 21 - 1])
    assert collision["paired"]["difference"] == pytest.approx((2.0 * counts[0] + counts[1]) / counts.sum())
    assert document["tracks"][3]["paired"] is None, "the reference is of another recording"


def test_tracks_without_annotations_have_no_numbers_and_say_so_in_valid_json() -> None:
    document = compare_tracks([judge("a", make_evaluation(np.zeros((0, 21))))], reference="a")
    (track,) = document["tracks"]
    assert track["error"]["mean"] is None and track["within"] is None and track["worst"] == []
    json.dumps(document, allow_nan=False)
    assert compare_tracks([])["tracks"] == []
