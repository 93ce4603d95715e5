"""What there is to see of a frame: detections, collisions, contacts and distances, at a known pose."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.grips import PINCH, ball, gripped
from tracker.geometry import se3
from tracker.model.blend_articulated import articulated_of
from tracker.model.default_hand import default_hand
from tracker.model.joints import FINGERS
from tracker.model.scene import Scene
from tracker.model.trained_hand import trained_hand
from tracker.physics import PhysicsWorld
from tracker.terms.penetration import measure_penetration
from tracker.tracking.frame_view import describe_frame
from tracker.tracking.shown_collisions import show_collisions
from tracker.tracking.shown_contacts import show_contacts


@pytest.fixture(scope="module")
def view(recorded, run):
    setup, _, _, chunk = run
    return describe_frame(recorded.sequence, setup, chunk.pose[3], 3)


def test_detections_are_assigned_to_the_fingertips_they_lie_at(view, recorded):
    found = view.detections
    assigned = [item for item in found if item.model >= 0]
    assert len(assigned) >= 3
    assert len({item.finger for item in assigned}) == len(assigned), "a fingertip has one detection at most"
    tips = recorded.truth.joints_3d[3][[4, 8, 12, 16, 20]]
    for item in assigned:
        nearest = np.linalg.norm(tips - item.tip, axis=1).argmin()
        assert FINGERS[nearest] == item.finger_name
        assert item.distance < 0.025  # m, the limit of an assignment
    assert [item.confidence for item in found] == sorted((item.confidence for item in found), reverse=True)


def test_the_box_of_a_detection_frames_it_in_the_image(view, recorded):
    camera = recorded.sequence.cameras[0]
    for item in view.detections:
        corners, (center,) = camera.project(item.box), camera.project(item.position[None])
        assert np.all(corners.min(axis=0) < center) and np.all(center < corners.max(axis=0))


def test_a_fitted_hand_lies_on_the_data_and_one_that_is_moved_does_not(view, recorded, run):
    setup, _, _, chunk = run
    (distances,) = view.surface_fit
    seen = np.isfinite(distances)
    assert 0.2 < seen.mean() < 0.8, "the camera sees one side"
    assert np.median(distances[seen]) < 0.0015  # m
    moved = chunk.pose[3].copy()
    moved[:6] = se3.log(se3.exp(np.r_[0.0, 0.0, 0.010, 0.0, 0.0, 0.0]) @ se3.exp(moved[:6]))  # 10 mm away
    (farther,) = describe_frame(recorded.sequence, setup, moved, 3).surface_fit
    assert 0.004 < np.nanmedian(farther) < 0.011


def test_every_layer_shows_a_trained_hand_as_its_pose_blend_shapes_make_it(recorded, run):
    setup, _, _, chunk = run
    hand = articulated_of(trained_hand("right"))
    pose = np.r_[chunk.pose[3][:6], np.zeros(hand.num_dofs - 6)]
    pose[6:] = 0.3 * hand.skeleton.upper
    shown = describe_frame(recorded.sequence, replace(setup, models=(hand,)), pose, 3)
    posed, plain = (Scene((each,)).pose_at(pose) for each in (hand, replace(hand, pose_blend=None)))
    vertices = shown.models[0].vertices
    np.testing.assert_allclose(vertices, posed.vertices[: len(vertices)], atol=1e-6)
    assert np.abs(vertices - plain.vertices[: len(vertices)]).max() > 5e-4
    assert len(shown.models[0].joints) == 21 and any(len(lines) for lines in shown.correspondences.values())
    assert np.isfinite(shown.surface_fit[0]).any()
    assert len(shown.collisions.pairs) == 0 and shown.contacts.contacts == ()


def test_an_open_hand_collides_with_nothing_and_holds_nothing(view):
    assert len(view.collisions.triangles) == len(view.collisions.vertices) == len(view.collisions.pairs) == 0
    assert view.contacts.object == -1
    assert view.contacts.contacts == ()


def ball_at_the_index_fingertip(depth: float):
    """The default hand and a ball whose surface its index fingertip is `depth` deep in, m."""
    scene = Scene((default_hand("right"), ball(0.030)))
    pose = scene.rest_pose()
    joints = scene.pose_at(pose).landmarks(0)
    outward = (joints[8] - joints[7]) / np.linalg.norm(joints[8] - joints[7])
    where = scene.pose_slices[1].start
    pose[where : where + 3] = joints[8] + (0.030 - depth) * outward
    return scene.pose_at(pose)


NAMES = tuple(f"bone {number}" for number in range(100))


def test_a_finger_in_a_ball_is_shown_where_and_how_deep_it_is():
    posed = ball_at_the_index_fingertip(0.004)
    found = show_collisions(posed, NAMES)
    assert len(found.triangles) > 0
    assert len(found.vertices) == len(found.depths) > 0
    assert found.depths.max() == pytest.approx(measure_penetration(posed), abs=1e-6)
    assert found.pairs[0].depth == pytest.approx(float(found.depths.max()))
    assert found.pairs[0].deepest_at.tolist() == found.vertices[found.depths.argmax()].tolist()
    ball = posed.vertices[posed.scene.vertex_slices[1]].mean(axis=0)
    to_ball = np.linalg.norm(found.triangles.reshape(-1, 3) - ball, axis=1)
    assert to_ball.max() < 0.030 + 0.015, "triangles are shown where the finger enters the ball"


def test_fingers_near_a_ball_that_falls_are_candidates_and_those_that_would_hold_it_are_chosen():
    posed = gripped((*PINCH, [0, -1, 0]), (0.005, 0.005, 0.008))
    with PhysicsWorld(posed.scene) as world:
        found = show_contacts(posed, world)
    assert (found.object, found.is_stable) == (1, False)
    assert found.displacement > 0.02 > 0.003 > found.held_displacement
    assert {"thumb_distal", "index_distal"} <= {part.part for part in found.contacts if part.is_chosen}
    for part in found.contacts:
        gap = 0.008 if part.part == "middle_distal" else 0.005
        assert part.distance == pytest.approx(gap, abs=2e-4)
        assert np.linalg.norm(part.segment[1] - part.segment[0]) == pytest.approx(part.distance, abs=1e-6)
        assert len(part.triangles) == 12, "all of the tip's skin"


def test_a_ball_that_is_held_stays_and_nothing_is_chosen():
    posed = gripped(PINCH, (0.0, 0.0))
    with PhysicsWorld(posed.scene) as world:
        found = show_contacts(posed, world)
    assert found.is_stable
    assert found.displacement < 0.003
    assert not any(part.is_chosen for part in found.contacts)
