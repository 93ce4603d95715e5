"""The hand that comes with Handloom."""

from __future__ import annotations

import numpy as np
import pytest

from tests.tracker.model.mirrored_poses import mirror_pose
from tracker.geometry import se3
from tracker.geometry.triangles import is_watertight
from tracker.model import MAX_WEIGHTS, ArticulatedModel, Scene, mirror, with_shape
from tracker.model.decimation import compute_volume
from tracker.model.default_hand import DATA, default_hand
from tracker.model.joints import FINGERS

SIDES = ("right", "left")


def posed_vertices(model: ArticulatedModel, pose: np.ndarray) -> np.ndarray:
    return Scene((model,)).pose_at(pose).vertices[: len(model.vertices)]


def joints_at(model: ArticulatedModel, pose: np.ndarray) -> np.ndarray:
    return Scene((model,)).pose_at(pose).landmarks(0)


def angle_places(model: ArticulatedModel, segment: str) -> dict[str, list[int]]:
    """For each finger the places in the pose of the joints of one of its bones."""
    names = [model.skeleton.bone_names[bone] for bone in model.skeleton.dof_bones]
    return {f: [6 + k for k, name in enumerate(names) if name == f"{f}_{segment}"] for f in FINGERS}


@pytest.mark.parametrize("side", SIDES)
def test_it_has_20_bones_31_joints_and_about_1500_faces(side: str) -> None:
    model = default_hand(side)
    assert model.skeleton.num_bones == 20
    assert model.num_dofs == 37
    assert 1450 <= len(model.faces) <= 1530
    assert model.hand is not None and model.hand.side == side
    np.testing.assert_allclose(np.linalg.norm(model.skeleton.dof_axes, axis=1), 1.0, atol=1e-12)
    np.testing.assert_allclose(model.skinning_weights.sum(axis=1), 1.0, atol=1e-12)
    assert np.sum(model.skinning_weights > 0, axis=1).max() <= MAX_WEIGHTS


@pytest.mark.parametrize("side", SIDES)
def test_it_is_closed_and_its_faces_look_outwards(side: str) -> None:
    model = default_hand(side)
    assert is_watertight(model.faces)
    assert 2.5e-4 < compute_volume(model.vertices, model.faces) < 4.5e-4


def test_it_has_the_size_of_an_adult() -> None:
    model = default_hand("right")
    rest = joints_at(model, np.zeros(37))
    assert 0.18 < np.linalg.norm(rest[12] - rest[0]) < 0.19
    assert DATA.stat().st_size < 500_000


@pytest.mark.parametrize("side", SIDES)
def test_the_rest_pose_is_well_inside_the_limits(side: str) -> None:
    skeleton = default_hand(side).skeleton
    assert np.all(skeleton.lower <= np.radians(-1.9)) and np.all(skeleton.upper >= np.radians(1.9))


@pytest.mark.parametrize("side", SIDES)
def test_positive_flexion_brings_every_fingertip_towards_the_palm(side: str) -> None:
    model = default_hand(side)
    rest = joints_at(model, np.zeros(37))
    for segment in ("proximal", "middle", "distal"):
        for number, finger in enumerate(FINGERS[1:], start=1):
            pose = np.zeros(37)
            pose[angle_places(model, segment)[finger][0]] = np.radians(40.0)
            moved = joints_at(model, pose)[4 + 4 * number] - rest[4 + 4 * number]
            assert moved[2] < 0.0, f"{finger} {segment} does not bend to the palm"
            assert abs(moved[1]) < 0.5 * np.linalg.norm(moved), f"{finger} {segment} bends sideways"


@pytest.mark.parametrize("side", SIDES)
def test_positive_abduction_turns_fingers_towards_the_thumb(side: str) -> None:
    model = default_hand(side)
    rest = joints_at(model, np.zeros(37))
    to_thumb = 1.0 if side == "right" else -1.0
    for number, finger in enumerate(FINGERS[1:], start=1):
        pose = np.zeros(37)
        pose[angle_places(model, "proximal")[finger][1]] = np.radians(15.0)
        assert to_thumb * (joints_at(model, pose)[4 + 4 * number] - rest[4 + 4 * number])[1] > 0.01


def test_a_fist_brings_the_fingertips_to_the_palm_and_collapses_nowhere() -> None:
    model = default_hand("right")
    pose = np.zeros(37)
    for segment in ("proximal", "middle", "distal"):
        for finger, places in angle_places(model, segment).items():
            if places and finger != "thumb":
                pose[places[0]] = 0.8 * model.skeleton.upper[places[0] - 6]
    joints = joints_at(model, pose)
    for tip in (8, 12, 16, 20):
        assert np.linalg.norm(joints[tip] - joints[0]) < 0.085
        assert joints[tip][2] < -0.01
    kept = compute_volume(posed_vertices(model, pose), model.faces) / compute_volume(model.vertices, model.faces)
    assert 0.85 < kept < 1.1


def test_the_left_hand_is_the_mirror_image_at_every_mirrored_pose(rng: np.random.Generator) -> None:
    right, left = default_hand("right"), default_hand("left")
    for _ in range(5):
        angles = rng.uniform(right.skeleton.lower, right.skeleton.upper)
        pose = np.concatenate([rng.normal(0.0, 0.5, 6), angles])
        expected = posed_vertices(right, pose) * [1.0, -1.0, 1.0]
        np.testing.assert_allclose(posed_vertices(left, mirror_pose(pose)), expected, atol=1e-12)
        np.testing.assert_allclose(
            joints_at(left, mirror_pose(pose)), joints_at(right, pose) * [1.0, -1.0, 1.0], atol=1e-12
        )


def test_mirroring_twice_gives_the_same_hand() -> None:
    model = default_hand("right")
    twice = mirror(mirror(model))
    np.testing.assert_array_equal(twice.vertices, model.vertices)
    np.testing.assert_array_equal(twice.faces, model.faces)
    np.testing.assert_array_equal(twice.skeleton.dof_axes, model.skeleton.dof_axes)
    np.testing.assert_array_equal(twice.skeleton.Ts_model_bone, model.skeleton.Ts_model_bone)
    assert twice.hand is not None and twice.hand.side == "right" and twice.name == model.name


def test_size_scales_every_length_by_the_same_share() -> None:
    model = default_hand("right")
    assert model.shape is not None and model.shape.names[0] == "size"
    betas = np.zeros(len(model.shape.names))
    betas[0] = 2.0
    grown = with_shape(model, betas)
    np.testing.assert_allclose(grown.vertices, 1.11 * model.vertices, atol=5e-5)
    np.testing.assert_allclose(grown.skeleton.joints_rest, 1.11 * model.skeleton.joints_rest, atol=1e-12)


def test_longer_fingers_leave_the_palm_and_the_thumb_as_they_are() -> None:
    model = default_hand("right")
    assert model.shape is not None
    betas = np.zeros(len(model.shape.names))
    betas[model.shape.names.index("finger_length")] = 1.0
    before, after = joints_at(model, np.zeros(37)), joints_at(with_shape(model, betas), np.zeros(37))
    np.testing.assert_allclose(after[:6], before[:6], atol=1e-9)
    for base in (5, 9, 13, 17):
        chain = slice(base, base + 3)
        lengths = [np.linalg.norm(np.diff(points[chain], axis=0), axis=1) for points in (before, after)]
        np.testing.assert_allclose(lengths[1] / lengths[0], 1.045, rtol=1e-3)


def test_every_shape_within_bounds_stays_closed_and_upright(rng: np.random.Generator) -> None:
    model = default_hand("right")
    assert model.shape is not None
    for _ in range(10):
        shaped = with_shape(model, rng.uniform(model.shape.lower, model.shape.upper))
        assert 1.2e-4 < compute_volume(shaped.vertices, shaped.faces) < 9e-4
        lengths = np.linalg.norm(np.diff(shaped.skeleton.joints_rest[[0, 1, 2, 3]], axis=0), axis=1)
        assert lengths.min() > 0.01


def test_a_shape_is_counted_on_from_the_shape_before() -> None:
    model = default_hand("right")
    assert model.shape is not None
    betas = np.linspace(-1.0, 1.0, len(model.shape.names))
    back = with_shape(with_shape(model, betas), -betas)
    np.testing.assert_allclose(back.vertices, model.vertices, atol=1e-15)
    np.testing.assert_allclose(back.skeleton.joints_rest, model.skeleton.joints_rest, atol=1e-15)


def test_a_turned_root_turns_the_whole_hand() -> None:
    model = default_hand("right")
    pose = np.zeros(37)
    pose[:6] = [0.1, -0.2, 0.5, 0.3, 1.0, -0.7]
    np.testing.assert_allclose(
        posed_vertices(model, pose), se3.transform(se3.exp(pose[:6]), model.vertices), atol=1e-12
    )
