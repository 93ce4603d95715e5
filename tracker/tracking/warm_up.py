"""Compile, or load from the cache, every kernel of the tracker before somebody waits for it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from tracker.capture.camera import Camera
from tracker.capture.frame import Frame
from tracker.detection import find_fingertips
from tracker.detection.default_detector import default_detector
from tracker.fitting.calibration import CalibrationFrame, CalibrationOptions, calibrate_shapes
from tracker.fitting.frame_fit import FitOptions, draw, fit_frame
from tracker.fitting.object_quality import measure_object_quality
from tracker.fitting.objective import Objective
from tracker.fitting.region import region_around
from tracker.geometry import se3
from tracker.kernel_cache import remove_old_caches
from tracker.model.ball import make_ball
from tracker.model.default_hand import default_hand
from tracker.model.scene import Scene
from tracker.observation import Preprocessing, observe
from tracker.physics import PhysicsWorld, find_down, find_physics_fault, find_support
from tracker.rendering import render_depth
from tracker.search.find_object import ObjectSearch, find_object
from tracker.search.start_automatic import Search, find_hand
from tracker.terms.collision import Collision
from tracker.terms.marked_joints import mark_joints
from tracker.terms.physics import Physics
from tracker.terms.salient import Salient


def warm_up(progress: Callable[[str, float], None] | None = None) -> None:
    """Run the tracker once on a small drawn hand."""
    tell = progress or (lambda stage, share: None)
    tell("compiling the kernels", 0.0)
    model = default_hand("right")
    K = np.array([[150.0, 0.0, 79.5], [0.0, 150.0, 59.5], [0.0, 0.0, 1.0]])
    camera = Camera("warm-up", 160, 120, K)
    scene = Scene((model,))
    vertices = scene.pose_at(scene.rest_pose()).vertices
    T = np.eye(4)
    T[:3, 3] = np.array([0.0, 0.0, 0.45]) - vertices.mean(axis=0)
    drawn = render_depth(se3.transform(T, vertices), scene.arrays.faces, K, 160, 120)
    color = np.full((120, 160, 3), 120, dtype=np.uint8)
    color[drawn.face >= 0] = (200, 140, 115)
    frame = Frame(0, camera.id, color, drawn.depth.astype(np.float32))
    region = region_around(se3.transform(T, vertices), camera)
    assert region is not None, "the drawn hand is in sight"
    seen = observe(frame, camera, region, Preprocessing(objects=True))
    terms = {
        **Objective().terms,
        "collision": Collision(),
        "salient": Salient(find_fingertips(default_detector(), seen)),
    }
    start = scene.rest_pose()
    start[:6] = se3.log(T)
    fit_frame(scene, seen, start, start, Objective(terms=terms), FitOptions(iterations=2))
    tell("compiling the searches", 0.4)
    find_hand(frame, camera, model, Preprocessing(), 0.1, 1.0, Search(candidates=1, turns=4, rough=1, bent=1, fine=1))
    ball = make_ball()
    few = ObjectSearch(places=2, rotations=2, hypotheses=2, rough=1, fine=1)
    find_object(ball, frame, camera, Preprocessing(), [], search=few)
    tell("compiling the calibration", 0.6)
    joints = camera.project(scene.pose_at(start).landmarks(0))
    marks = mark_joints(scene, 0, np.column_stack([joints, np.full(len(joints), 2.0)]), camera)
    once = CalibrationOptions(rounds=1, coarse_rounds=0, iterations=1)
    calibrate_shapes(scene, [CalibrationFrame(seen, start, {0: marks})], once)
    tell("compiling the physics", 0.8)
    held = Scene((model, ball))
    beside = np.r_[start, T[:3, 3] - np.array([0.0, 0.0, 0.06]), np.zeros(3)]
    if not find_physics_fault():
        with PhysicsWorld(held, down=find_down(np.eye(4))) as world:
            support = find_support(world, held.pose_at(beside))
        Physics(support.candidates).find(held.pose_at(beside))
    measure_object_quality(draw(held.pose_at(beside), seen), seen, 1)
    remove_old_caches()
    tell("kernels are compiled", 1.0)
