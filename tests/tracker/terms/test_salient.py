"""Fingertips go to the detections that are theirs, [T16] Eq. 14 and 15."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pytest

from tracker.capture.camera import Camera
from tracker.capture.frame import Frame
from tracker.detection import find_fingertips
from tracker.detection.default_detector import default_detector
from tracker.detection.detection import Detection
from tracker.fitting.frame_fit import label_scene
from tracker.fitting.region import region_around
from tracker.geometry import se3
from tracker.model.default_hand import default_hand
from tracker.model.joints import FINGERS, HAND_JOINTS
from tracker.model.scene import PosedScene, Scene
from tracker.observation import Observation, Preprocessing, observe
from tracker.rendering import render_depth, render_view
from tracker.solver.damped_step import compute_damped_step
from tracker.terms.normal_equations import NormalEquations
from tracker.terms.residual import FrameContext
from tracker.terms.salient import Salient

K = np.array([[525.0, 0.0, 319.5], [0.0, 525.0, 239.5], [0.0, 0.0, 1.0]])
INDEX = FINGERS.index("index")


@dataclass(frozen=True)
class SeenHand:
    """The default hand, palm to the camera, and what was seen of it."""

    scene: Scene
    pose: np.ndarray
    observation: Observation

    def context(self, posed: PosedScene) -> FrameContext:
        height, width = self.observation.labels.shape
        view = render_view(posed, self.observation.K, self.observation.T_world_camera, height, width)
        return FrameContext(view, self.observation, *label_scene(self.scene))

    def bent(self, angle: float) -> np.ndarray:
        """The pose with the index finger turned sideways and bent at its first joint, rad."""
        skeleton = self.scene.models[0].skeleton
        pose = self.pose.copy()
        own = np.flatnonzero(skeleton.dof_bones == skeleton.bone_names.index("index_proximal"))
        pose[6 + own[:2]] += angle
        return pose

    def index_tip(self, pose: np.ndarray) -> np.ndarray:
        return self.scene.pose_at(pose).landmarks(0)[HAND_JOINTS.index("index_tip")]


@pytest.fixture(scope="module")
def hand() -> SeenHand:
    scene = Scene((default_hand("right"),))
    pose = scene.rest_pose()
    T = np.eye(4)
    T[:3, :3] = np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    T[:3, 3] = [0.0, 0.09, 0.5]
    T_world_camera = se3.exp(np.array([0.3, -0.1, 0.2, 0.4, -0.2, 0.3]))
    pose[:6] = se3.log(T_world_camera @ T)
    vertices = scene.pose_at(pose).vertices
    camera = Camera("cam0", 640, 480, K, T_world_camera=T_world_camera)
    drawn = render_depth(se3.transform(camera.T_camera_world, vertices), scene.arrays.faces, K, 640, 480)
    region = region_around(vertices, camera)
    assert region is not None
    seen = observe(Frame(0, "cam0", None, drawn.depth.astype(np.float32)), camera, region, Preprocessing())
    return SeenHand(scene, pose, seen)


@pytest.fixture(scope="module")
def detections(hand) -> tuple[Detection, ...]:
    return find_fingertips(default_detector(), hand.observation)


def detection_at(hand: SeenHand, center: np.ndarray, spread: float = 0.004, confidence: float = 5.0) -> Detection:
    """A made-up detection: points (27, 3) around a place, and the box they fill."""
    grid = np.array([[x, y, z] for x in (-1, 0, 1) for y in (-1, 0, 1) for z in (-1, 0, 1)], dtype=float)
    points = center + spread * grid
    in_camera = se3.transform(se3.inverse(hand.observation.T_world_camera), points)
    rays = in_camera[:, :2] / in_camera[:, 2:]
    box_rays = np.concatenate([rays.min(axis=0) - 0.01, rays.max(axis=0) + 0.01])
    box = box_rays * 525.0 + np.array([319.5, 239.5, 319.5, 239.5])
    return Detection(
        0.5 * (box[:2] + box[2:]), box, box_rays, confidence, float(in_camera[:, 2].mean()), points, center
    )


def cost(term, residual, scene, pose) -> float:
    return residual.linearize(scene.pose_at(pose)).cost


def test_the_detector_sees_all_five_fingertips_of_the_drawn_hand(hand, detections):
    posed = hand.scene.pose_at(hand.pose)
    tips = posed.landmarks(0)[[j for j, name in enumerate(HAND_JOINTS) if name.endswith("_tip")]]
    good = [item for item in detections if item.confidence >= 3.0]
    distances = np.linalg.norm(np.stack([item.centroid for item in good])[:, None] - tips[None], axis=2)
    assert distances.min(axis=0).max() < 0.015


def test_jacobian_agrees_with_finite_differences(hand, detections):
    pose = hand.bent(0.25)
    posed = hand.scene.pose_at(pose)
    residual = Salient(detections).find(posed, hand.context(posed))
    assert residual.count > 5
    block = residual.linearize(posed)
    step = 1e-6
    for dof in range(hand.scene.num_dofs):
        delta = np.zeros(hand.scene.num_dofs)
        delta[dof] = step
        ahead = residual.linearize(hand.scene.pose_at(hand.scene.retract(pose, delta))).residual
        behind = residual.linearize(hand.scene.pose_at(hand.scene.retract(pose, -delta))).residual
        np.testing.assert_allclose(block.jacobian[:, dof], (ahead - behind) / (2 * step), atol=1e-3)


def test_fast_sum_equals_plain_jacobian(hand, detections):
    posed = hand.scene.pose_at(hand.bent(0.25))
    residual = Salient(detections, weight=0.7).find(posed, hand.context(posed))
    block = residual.linearize(posed)
    equations = NormalEquations.at(posed)
    residual.add_to(equations)
    JtJ, Jtr = equations.assemble()
    weighted = block.jacobian * block.weights[:, None]
    np.testing.assert_allclose(JtJ, weighted.T @ block.jacobian, rtol=1e-9, atol=1e-6)
    np.testing.assert_allclose(Jtr, weighted.T @ block.residual, rtol=1e-9, atol=1e-6)
    assert equations.cost == pytest.approx(block.cost, rel=1e-9)
    assert equations.count == residual.count


def test_at_the_true_pose_every_fingertip_is_near_enough_and_nothing_pulls(hand, detections):
    posed = hand.scene.pose_at(hand.pose)
    at_tips = tuple(
        detection_at(hand, posed.vertices[np.asarray(tip)].mean(axis=0))
        for tip in default_hand("right").hand.fingertips
    )
    assert Salient(at_tips).find(posed, hand.context(posed)).count == 0


def test_a_fingertip_displaced_by_40_mm_is_pulled_back(hand, detections):
    """Gauss-Newton with this term alone, correspondences found anew each time."""
    term, angle = Salient(detections), 0.0
    truth = hand.index_tip(hand.pose)
    while np.linalg.norm(hand.index_tip(hand.bent(angle)) - truth) < 0.040:
        angle += 0.01
    pose = hand.bent(angle)
    before = np.linalg.norm(hand.index_tip(pose) - truth)
    assert 0.040 <= before < 0.045
    for _ in range(15):
        posed = hand.scene.pose_at(pose)
        residual = term.find(posed, hand.context(posed))
        if residual.count == 0:
            break
        equations = NormalEquations.at(posed)
        residual.add_to(equations)
        # The rest of the hand stands still, as the data terms would hold it.
        JtJ, Jtr = equations.assemble()
        held = np.full(hand.scene.num_dofs, 1e9)
        bones = hand.scene.models[0].skeleton
        held[6 + np.flatnonzero([bones.bone_names[b].startswith("index") for b in bones.dof_bones])] = 1.0
        step = compute_damped_step(JtJ + np.diag(held), Jtr, 0.0, np.full(hand.scene.num_dofs, 0.5))
        pose = hand.scene.retract(pose, step)
    assert np.linalg.norm(hand.index_tip(pose) - truth) < 0.012


def test_one_step_lowers_its_own_cost(hand, detections):
    pose = hand.bent(0.3)
    posed = hand.scene.pose_at(pose)
    residual = Salient(detections).find(posed, hand.context(posed))
    equations = NormalEquations.at(posed)
    residual.add_to(equations)
    step = compute_damped_step(*equations.assemble(), 0.1, np.full(hand.scene.num_dofs, 0.2))
    after = hand.scene.retract(pose, step)
    assert cost(Salient(), residual, hand.scene, after) < cost(Salient(), residual, hand.scene, pose)


def test_a_fingertip_in_the_box_goes_to_the_closest_points_and_one_outside_to_the_centroid(hand):
    posed = hand.scene.pose_at(hand.pose)
    context = hand.context(posed)
    tip = np.asarray(default_hand("right").hand.fingertips[INDEX])
    seen = Salient().find_fingertips(posed, context.view)
    at = seen.centroids[next(i for i, v in enumerate(seen.vertices) if np.isin(v, tip).all())]
    along_ray = at - hand.observation.T_world_camera[:3, 3]
    along_ray /= np.linalg.norm(along_ray)

    behind = detection_at(hand, at + 0.015 * along_ray, spread=0.012)
    residual = Salient((behind,)).find(posed, context)
    assert residual.count == len(seen.vertices[INDEX])
    for vertex, target in zip(residual.ids[:, 0], residual.targets, strict=True):
        distances = np.linalg.norm(behind.points - posed.vertices[vertex], axis=1)
        assert np.linalg.norm(target - posed.vertices[vertex]) == pytest.approx(distances.min())
    assert len(np.unique(residual.targets, axis=0)) > 1

    across = hand.observation.T_world_camera[:3, 0]
    aside = detection_at(hand, at + 0.03 * across, spread=0.002)
    residual = Salient((aside,)).find(posed, context)
    assert residual.count > 0
    np.testing.assert_allclose(residual.targets, np.repeat(aside.centroid[None], residual.count, axis=0))


def test_only_visible_vertices_take_part_unless_hidden_fingertips_are_asked_for(hand):
    posed = hand.scene.pose_at(hand.pose)
    view = hand.context(posed).view
    every = default_hand("right").hand.fingertips
    for seen, whole in zip(Salient().find_fingertips(posed, view).vertices, every, strict=True):
        assert 0 < len(seen) < len(whole)
    nothing_seen = replace(view, inverse_depth=np.full_like(view.inverse_depth, 10.0))
    assert Salient().find_fingertips(posed, nothing_seen).vertices == ()
    hidden = Salient(hidden_fingertips=True).find_fingertips(posed, nothing_seen)
    assert [len(seen) for seen in hidden.vertices] == [len(whole) for whole in every]


def test_confident_detections_reach_farther_where_confidence_counts(hand):
    posed = hand.scene.pose_at(hand.pose)
    context = hand.context(posed)
    at = Salient().find_fingertips(posed, context.view).centroids[INDEX]
    beyond = hand.observation.T_world_camera[:3, 2] * 0.06  # 60 mm behind: farther than 2 λ
    for confidence, expected in ((3.0, 0), (12.0, 1)):
        detection = detection_at(hand, at + beyond, confidence=confidence)
        assert len(Salient((detection,), use_confidence=True).assign(posed, context.view)) == expected
        assert Salient((detection,)).assign(posed, context.view) == []
    assert Salient((detection_at(hand, at + 0.02, confidence=2.9),)).assign(posed, context.view) == []
    assert Salient((detection_at(hand, at + 0.005, confidence=9.0),), rejection=0.0).find(posed, context).count == 0


def test_without_detections_or_hands_there_is_nothing(hand, rng):
    from tests.tracker.scenes import drawn_tube

    posed = hand.scene.pose_at(hand.pose)
    empty = Salient().find(posed, hand.context(posed))
    assert empty.count == 0
    assert empty.linearize(posed).jacobian.shape == (0, hand.scene.num_dofs)
    equations = NormalEquations.at(posed)
    empty.add_to(equations)
    assert equations.cost == 0.0

    drawn = drawn_tube()
    posed = drawn.scene.pose_at(drawn.pose)
    detection = detection_at(hand, posed.vertices.mean(axis=0))
    assert Salient((detection,)).find(posed, drawn.context(posed)).count == 0


def test_the_order_of_detections_does_not_matter(hand, detections):
    posed = hand.scene.pose_at(hand.bent(0.3))
    context = hand.context(posed)
    one = Salient(detections).find(posed, context).linearize(posed).cost
    other = Salient(detections[::-1]).find(posed, context).linearize(posed).cost
    assert one == pytest.approx(other, rel=1e-12)
