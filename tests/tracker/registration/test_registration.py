"""What a registration says of itself, and what names its scan and its model."""

from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.registration.conftest import scan_model
from tracker.capture.scan import Scan
from tracker.model.untrained_hand import untrained_hand
from tracker.registration.registration import digest_model, digest_scan, summarize_distances
from tracker.registration.verdict import refuse


def test_distances_are_told_in_millimetres_over_what_counts():
    distances = np.array([0.001, 0.002, np.nan, 0.003, 0.010])
    told = summarize_distances(distances)
    assert told["mean"] == pytest.approx(4.0) and told["median"] == pytest.approx(2.5)
    assert told["p95"] == pytest.approx(np.percentile([1.0, 2.0, 3.0, 10.0], 95))


def test_where_nothing_counts_no_distance_is_told():
    assert all(np.isnan(value) for value in summarize_distances(np.full(3, np.nan)).values())


def test_a_scan_is_named_by_its_points_and_not_by_its_name():
    own = scan_model(0, 500).scan
    assert digest_scan(replace(own, name="other")) == digest_scan(own)
    moved = own.points.copy()
    moved[7, 1] += 1e-9
    assert digest_scan(replace(own, points=moved)) != digest_scan(own)


@pytest.mark.parametrize("part", ["template", "shape_directions", "pose_directions", "skinning_weights"])
def test_a_model_is_named_by_all_that_its_surface_depends_on(part):
    hand = untrained_hand()
    changed = getattr(hand, part).copy()
    changed.flat[5] += 1e-6
    assert digest_model(replace(hand, **{part: changed})) != digest_model(hand)
    assert digest_model(replace(hand, name="another name")) == digest_model(hand)


def test_a_scan_that_is_refused_has_a_hand_at_rest_in_its_middle_and_says_why():
    points = np.random.default_rng(0).normal(np.array([1.0, 2.0, 3.0]), 1.0, (60, 3))
    scan = Scan(points, np.zeros_like(points), name="cloud")
    found = refuse(scan, untrained_hand(), "digest", ("no hand", "", "3 points are not finite"), 0.5)
    assert (found.verdict, found.score, found.scan) == ("bad", 1.0, "cloud")
    assert found.reasons == ("no hand", "3 points are not finite")
    assert found.vertices.mean(axis=0) == pytest.approx(np.median(points, axis=0))
    assert np.isnan(found.scan_to_mesh).all() and len(found.scan_to_mesh) == 60


@pytest.mark.parametrize("points", [np.zeros((0, 3)), np.full((5, 3), np.nan), np.full((5, 3), 1e9)])
def test_of_a_scan_that_is_nowhere_the_hand_is_at_the_origin(points):
    found = refuse(Scan(points, np.zeros_like(points)), untrained_hand(), "digest", ("no",), 0.0)
    assert found.vertices.mean(axis=0) == pytest.approx(np.zeros(3), abs=1e-9)


def test_as_a_start_it_keeps_side_pose_and_vertices():
    found = refuse(scan_model(0, 500).scan, untrained_hand(), "digest", ("no",), 0.0)
    start = replace(found, side="left").as_start()
    assert start.side == "left" and start.vertices is found.vertices
    assert (start.pose == found.pose).all() and (start.translation == found.translation).all()
