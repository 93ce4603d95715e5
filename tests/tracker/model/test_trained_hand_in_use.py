"""A hand with pose blend shapes, where the default hand is usually meant: collision, physics, views and files."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.tracker.export.conftest import make_moved
from tests.tracker.export.test_mano_parameters import run_mano_kinematics
from tests.tracker.grips import ball
from tests.tracker.terms.test_colliding_parts import bent
from tests.tracker.terms.test_collision import push_apart
from tracker.export.csv_files import write_csv
from tracker.export.export import export_track
from tracker.export.mano_parameters import MANO_JOINTS, find_mano_parameters
from tracker.model.blend_articulated import articulated_of
from tracker.model.joints import HAND_JOINTS
from tracker.model.scene import Scene
from tracker.model.trained_hand import trained_hand
from tracker.physics import PhysicsWorld, find_support
from tracker.physics.closest_points import find_closest_point
from tracker.terms.colliding_parts import find_crossings
from tracker.terms.penetration import measure_penetration
from tracker.tracking.track import load_track


@pytest.fixture(scope="module")
def hand():
    return articulated_of(trained_hand("right"))


@pytest.fixture(scope="module")
def trained_track(hand):
    return make_moved({"right": hand, "left": articulated_of(trained_hand("left"))})


def test_it_collides_with_itself_only_where_fingers_meet_and_is_driven_apart(hand):
    scene = Scene((hand,))
    assert len(find_crossings(scene.pose_at(scene.rest_pose())).pairs) == 0
    for finger in ("index", "middle", "ring", "little"):
        one = bent(scene, (f"{finger}_middle", 0, 1.4), (f"{finger}_distal", 0, 0.7))
        assert len(find_crossings(scene.pose_at(one)).pairs) == 0, finger
    pose = bent(scene, ("index_proximal", 1, -0.25), ("middle_proximal", 1, 0.2))
    deep = measure_penetration(scene.pose_at(pose))
    assert deep > 0.002
    apart, steps = push_apart(scene, pose, 12)
    assert steps < 12 and measure_penetration(scene.pose_at(apart)) == 0.0


def test_contact_with_an_object_is_that_of_the_surface_as_the_pose_changes_it(hand):
    scene = Scene((hand, ball(0.02)))
    pose = bent(scene, ("index_middle", 0, 1.0), ("index_distal", 0, 0.5))
    tip = scene.pose_at(pose).landmarks(0)[HAND_JOINTS.index("index_tip")]
    pose[scene.pose_slices[1]][:3] = tip + np.array([0.0, 0.0, -0.026])
    posed = scene.pose_at(pose)
    found = find_closest_point(posed, 0, "index_distal", 1)
    assert hand.hand is not None
    center = posed.vertices[scene.vertex_slices[1]].mean(axis=0)
    to_center = np.linalg.norm(posed.vertices[hand.hand.finger_parts["index_distal"]] - center, axis=1)
    assert found.distance == pytest.approx(to_center.min() - 0.02, abs=4e-4)
    with PhysicsWorld(scene) as world:
        support = find_support(world, posed)
    assert not support.is_stable and support.displacement > 0.02, "a ball beside one finger falls"


def test_what_skinning_alone_makes_of_it_is_millimetres_away_from_its_surface(hand):
    scene, plain = Scene((hand,)), Scene((replace(hand, pose_blend=None),))
    pose = bent(scene, *((f"{finger}_middle", 0, 1.5) for finger in ("index", "middle", "ring", "little")))
    away = np.linalg.norm(scene.pose_at(pose).vertices - plain.pose_at(pose).vertices, axis=1)
    assert 1e-3 < away.max() < 5e-3


@pytest.mark.parametrize("side", ["right", "left"])
def test_mano_style_parameters_give_its_joints_again(trained_track, side: str):
    arrays, setup = find_mano_parameters(trained_track.track), trained_track.track.setup
    index = setup.names.index(side)
    model = setup.models[index]
    assert model.hand is not None
    ours = [model.hand.joint_bones[HAND_JOINTS.index(name)] for name in ("wrist", *MANO_JOINTS)]
    at_rest = np.c_[model.skeleton.joints_rest[ours], np.ones(len(ours))]
    for row, pose in enumerate(trained_track.track.pose):
        Ms = setup.scene.pose_at(pose).Ms[setup.scene.bone_slices[index]][ours]
        joints, _ = run_mano_kinematics(arrays, side, row)
        np.testing.assert_allclose(joints, np.einsum("bij,bj->bi", Ms, at_rest), atol=1e-9)


def test_its_track_goes_through_files_unchanged(trained_track, tmp_path: Path):
    track = trained_track.track
    for kind in ("npz", "csv", "glb", "mano"):
        export_track(track, trained_track.sequence, kind, tmp_path / kind)
        assert (tmp_path / kind).stat().st_size > 0
    track.save(tmp_path / "track.npz")
    again = load_track(tmp_path / "track.npz")
    for pose in track.pose:
        ours, theirs = track.setup.scene.pose_at(pose), again.setup.scene.pose_at(pose)
        np.testing.assert_array_equal(ours.vertices, theirs.vertices)
    assert write_csv(again) == write_csv(track)
