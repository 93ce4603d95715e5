"""What there is to see of a frame: detections, collisions, contacts and distances, at a known pose."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest

from tests.tracker.grips import PINCH, ball, gripped
from tracker.capture.camera import Camera
from tracker.capture.frame import Frame
from tracker.capture.import_options import ImportOptions
from tracker.capture.import_run import run_import
from tracker.capture.sequence import load_sequence
from tracker.fitting.options import TrackOptions
from tracker.geometry import se3
from tracker.inspection.frame_view import UNKNOWN_COLOR, describe_frame, render_unknown
from tracker.inspection.shown_collisions import show_collisions
from tracker.inspection.shown_contacts import show_contacts
from tracker.inspection.shown_unknown import show_unknown
from tracker.model.blend_articulated import articulated_of
from tracker.model.default_hand import default_hand
from tracker.model.joints import FINGERS
from tracker.model.scene import Scene
from tracker.model.trained_hand import trained_hand
from tracker.observation import HAND, OTHER, Observation, Preprocessing, Region, observe
from tracker.physics import PhysicsWorld
from tracker.rendering import View, render_view
from tracker.terms.penetration import measure_penetration
from tracker.tracking.follow import track_frames
from tracker.tracking.start import start_tracking


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


@pytest.mark.slow
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


def make_seen(labels: np.ndarray, depth: np.ndarray) -> tuple[Observation, View]:
    """A region of an image, and a hand drawn in it: a wall at 0.5 m that fills the columns 2 to 5 of 8."""
    scene = Scene((default_hand("right"),))
    empty = observe(
        Frame(0, "cam0", None, np.zeros((10, 12), dtype=np.float32)),
        Camera("cam0", 12, 10, np.array([[10.0, 0, 6], [0, 10.0, 5], [0, 0, 1]])),
        Region(1, 2, 8, 8, 0.1, 2.0),
        Preprocessing(),
    )
    seen = replace(empty, labels=labels.astype(np.uint8), depth=depth.astype(np.float32))
    view = render_view(scene.pose_at(scene.rest_pose()), seen.K, np.eye(4), 8, 8)
    face, inverse_depth = np.full((8, 8), -1, dtype=np.int32), np.zeros((8, 8))
    face[:, 2:6], inverse_depth[:, 2:6] = 0, 2.0
    return seen, replace(view, face=face, inverse_depth=inverse_depth)


def test_what_colour_tells_from_hand_is_unknown_before_and_beside_the_hand():
    labels, depth = np.zeros((8, 8)), np.zeros((8, 8))
    labels[:, 2:6], depth[:, 2:6] = HAND, 0.5
    labels[:2], depth[:2] = OTHER, 0.45  # across the hand, and on both sides of it
    labels[2, 2:6], depth[2, 2:6] = HAND, 0.40  # a finger nearer than the model has it is still hand
    labels[3, 2:6], depth[3, 2:6] = OTHER, 0.60  # seen behind the drawn hand: left out, and hides nothing
    seen, view = make_seen(labels, depth)
    found = show_unknown(view, seen, 10, 12)
    expected = np.zeros((10, 12), dtype=bool)
    expected[1:3, 2:10] = True
    expected[4, 4:8] = True
    np.testing.assert_array_equal(found.mask, expected)
    assert (found.before, len(found.points), found.by_color) == (8, 20, True)


def test_without_colour_what_stands_before_the_hand_is_unknown_and_the_rest_is_not():
    labels, depth = np.full((8, 8), HAND | OTHER), np.full((8, 8), 0.5)
    depth[0:2] = 0.45
    seen, view = make_seen(labels, depth)
    found = show_unknown(view, seen, 10, 12)
    expected = np.zeros((10, 12), dtype=bool)
    expected[1:3, 4:8] = True
    np.testing.assert_array_equal(found.mask, expected)
    assert (found.before, found.by_color) == (8, False)


def test_a_hand_alone_has_nothing_unknown_and_one_out_of_sight_neither(view, recorded, run):
    hand = np.count_nonzero(view._seen.labels & HAND)
    assert len(view.unknown.points) < 0.03 * hand, "its own rims, where the sensor's noise smears colour and depth"
    setup, _, _, chunk = run
    away = chunk.pose[3].copy()
    away[:3] += 5.0  # m
    nothing = describe_frame(recorded.sequence, setup, away, 3).unknown
    assert not nothing.mask.any() and nothing.mask.shape == (480, 640) and len(nothing.points) == 0


@pytest.mark.shared_data
def test_a_held_box_without_a_model_is_marked_in_the_image_and_the_hand_is_not(shared_data, tmp_path):
    """The box of `uvr_cube_white` is white, the hand is not."""
    how = ImportOptions(fps=30.0, fx=238.95, fy=238.95, cx=160.0, cy=120.0, depth_scale=0.001, hands=("right",))
    run_import(shared_data / "uvr_cube_white", tmp_path / "box", "rgbd_folder", how)
    sequence = load_sequence(tmp_path / "box")
    setup, state = start_tracking(sequence, TrackOptions(calibrate=False, last_frame=0))
    _, chunk = track_frames(sequence, setup, state, range(1))
    camera = sequence.cameras[0].id
    image = render_unknown(sequence, setup, chunk.pose[0], 0, camera)
    is_marked, color = image[..., 3] > 0, sequence.frame(0, camera).color
    assert np.array_equal(is_marked, describe_frame(sequence, setup, chunk.pose[0], 0).unknown.mask)
    assert set(map(tuple, image[is_marked][:, :3].tolist())) == {UNKNOWN_COLOR}
    lab = cv2.cvtColor(color, cv2.COLOR_RGB2LAB).astype(int)
    is_white = (lab[..., 0] > 170) & (np.abs(lab[..., 1:] - 128).max(axis=-1) < 8)
    is_skin = (lab[..., 1] > 138) & (lab[..., 0] > 90)
    assert np.count_nonzero(is_white) > 1000 and np.count_nonzero(is_skin) > 500
    assert is_marked[is_white].mean() > 0.9
    assert is_marked[is_skin].mean() < 0.1
