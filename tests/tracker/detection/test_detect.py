"""Detections of the detector that comes along, on a drawn hand."""

from __future__ import annotations

import time

import numpy as np
import pytest

from tracker.capture.camera import Camera
from tracker.capture.frame import Frame
from tracker.detection import find_fingertips
from tracker.detection.default_detector import default_detector
from tracker.detection.detect import DetectOptions
from tracker.geometry import se3
from tracker.model.default_hand import default_hand
from tracker.model.joints import HAND_JOINTS
from tracker.model.scene import Scene
from tracker.observation import Preprocessing, Region, observe
from tracker.rendering import render_depth

K = np.array([[525.0, 0.0, 319.5], [0.0, 525.0, 239.5], [0.0, 0.0, 1.0]])
TIPS = [j for j, name in enumerate(HAND_JOINTS) if name.endswith("_tip")]


@pytest.fixture(scope="module")
def drawn():
    """A frame with the default hand at 0.45 m, its camera, and the tips (5, 3) world, m."""
    scene = Scene((default_hand("right"),))
    pose = scene.rest_pose()
    T = np.eye(4)
    T[:3, :3] = np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    T[:3, 3] = [0.0, 0.09, 0.45]
    T_world_camera = se3.exp(np.array([0.2, 0.1, -0.3, 0.5, 0.1, -0.4]))
    pose[:6] = se3.log(T_world_camera @ T)
    posed = scene.pose_at(pose)
    camera = Camera("cam0", 640, 480, K, T_world_camera=T_world_camera)
    vertices = se3.transform(camera.T_camera_world, posed.vertices)
    depth = render_depth(vertices, scene.arrays.faces, K, 640, 480).depth.astype(np.float32)
    return Frame(0, "cam0", None, depth), camera, posed.landmarks(0)[TIPS]


def look(drawn, region, stride=1, **options):
    frame, camera, _ = drawn
    return find_fingertips(
        default_detector(), observe(frame, camera, region, Preprocessing(), stride), DetectOptions(**options)
    )


def region_of(drawn, margin: int) -> Region:
    rows, columns = np.nonzero(drawn[0].depth)
    top, left = rows.min() - margin, columns.min() - margin
    return Region(int(top), int(left), int(np.ptp(rows)) + 2 * margin, int(np.ptp(columns)) + 2 * margin, 0.2, 0.8)


def test_detections_lie_in_the_whole_image_whatever_region_and_stride(drawn):
    _, camera, tips = drawn
    pixels = camera.project(tips)
    for stride, within in ((1, 6.0), (2, 8.0)):
        found = look(drawn, region_of(drawn, 30), stride)
        centers = np.stack([item.center_px for item in found])
        distances = np.linalg.norm(centers[:, None] - pixels[None], axis=2)
        assert distances.min(axis=0).max() < within
    whole = look(drawn, Region(0, 0, 480, 640, 0.2, 0.8))
    near = look(drawn, region_of(drawn, 30))
    for one in near[:5]:
        assert min(np.linalg.norm(one.center_px - other.center_px) for other in whole) < 5.0


def test_points_are_of_the_hand_in_the_box_near_the_fingertip(drawn):
    _, camera, tips = drawn
    for item in look(drawn, region_of(drawn, 30))[:5]:
        assert 10 <= len(item.points) <= DetectOptions().max_points
        pixels = camera.project(item.points)
        assert (pixels >= item.box[:2] - 0.51).all()
        assert (pixels <= item.box[2:] + 0.51).all()
        np.testing.assert_allclose(item.points.mean(axis=0), item.centroid)
        assert np.linalg.norm(tips - item.centroid, axis=1).min() < 0.02
        in_camera = se3.transform(camera.T_camera_world, item.points)
        rays = in_camera[:, :2] / in_camera[:, 2:]
        assert (rays >= item.box_rays[:2] - 1e-3).all()
        assert (rays <= item.box_rays[2:] + 1e-3).all()


def test_detections_come_most_confident_first_and_do_not_overlap(drawn):
    found = look(drawn, region_of(drawn, 30), min_confidence=0.2)
    confidences = [item.confidence for item in found]
    assert confidences == sorted(confidences, reverse=True)
    assert min(confidences) >= 0.2
    assert len(look(drawn, region_of(drawn, 30), min_confidence=max(confidences) + 1)) == 0


def test_the_same_image_gives_the_same_detections(drawn):
    one, other = (look(drawn, region_of(drawn, 30)) for _ in range(2))
    for a, b in zip(one, other, strict=True):
        assert a.confidence == b.confidence
        assert a.points.tobytes() == b.points.tobytes()


def test_sizes_of_hands_around_the_trained_one_can_be_looked_for(drawn):
    single = look(drawn, region_of(drawn, 30))
    several = look(drawn, region_of(drawn, 30), scales=(0.85, 1.0, 1.18))
    assert len(several) >= len(single)
    assert several[0].confidence >= single[0].confidence


def test_an_empty_image_has_none(drawn):
    frame, camera, _ = drawn
    empty = Frame(0, "cam0", None, np.zeros_like(frame.depth))
    seen = observe(empty, camera, Region(100, 100, 60, 60, 0.2, 0.8), Preprocessing())
    assert find_fingertips(default_detector(), seen) == ()


def test_one_hand_at_stride_two_takes_no_longer_than_a_few_milliseconds(drawn):
    """The budget is 7 ms of a quiet core; one that is shared gets more."""
    frame, camera, _ = drawn
    seen = observe(frame, camera, region_of(drawn, 30), Preprocessing())
    forest, times = default_detector(), []
    for _ in range(15):
        began = time.process_time()
        find_fingertips(forest, seen, DetectOptions(stride=2))
        times.append(time.process_time() - began)
    assert min(times) < 0.020
