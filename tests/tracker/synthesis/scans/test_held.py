"""A held thing has the shape it should have, lies in the grasp and not in the skin, and is green where no hand is."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import KDTree

from tracker.synthesis.scans.angles import clip_to_limits, pose_angles
from tracker.synthesis.scans.deform import deform
from tracker.synthesis.scans.held import NOTHING, PRESS, ROD_HALF_LENGTH, _across, _ball, _rod, place_object
from tracker.synthesis.scans.pose_list import POSES, HeldObject
from tracker.synthesis.scans.subject import load_subject

SUBJECT = load_subject(2)
GRASPS = [pose for pose in POSES if pose.held is not None]
vectors = st.lists(st.floats(-1.0, 1.0), min_size=3, max_size=3).map(np.array)


def radii(mesh, points: np.ndarray, kind: str) -> np.ndarray:
    """(N,) distances of points from the middle of a ball or from the axis of a rod, m."""
    middle = mesh.vertices.mean(axis=0)
    offsets = points - middle
    if kind == "rod":
        axis = np.linalg.svd(mesh.vertices - middle, full_matrices=False)[2][0]
        offsets = offsets - np.outer(offsets @ axis, axis)
    return np.linalg.norm(offsets, axis=1)


def test_a_ball_and_a_rod_are_closed_look_outwards_and_have_their_volume() -> None:
    axis = np.array([0.6, 0.0, 0.8])
    for mesh, volume in (
        (_ball(np.array([0.1, 0.2, 0.3]), 0.02), 4 / 3 * np.pi * 0.02**3),
        (_rod(np.zeros(3), 0.01, axis), np.pi * 0.01**2 * 2 * ROD_HALF_LENGTH),
    ):
        solid = trimesh.Trimesh(mesh.vertices, mesh.faces)
        solid.update_faces(solid.nondegenerate_faces())
        assert solid.is_watertight and solid.volume == pytest.approx(volume, rel=0.01)


@given(vectors)
def test_two_directions_across_another_make_a_frame_with_it(axis) -> None:
    if np.linalg.norm(axis[:2]) < 1e-3:
        return
    axis = axis / np.linalg.norm(axis)
    frame = np.vstack([_across(axis), axis])
    assert np.allclose(frame @ frame.T, np.eye(3), atol=1e-9) and np.linalg.det(frame) == pytest.approx(1.0)


@pytest.mark.parametrize("pose", GRASPS[::3], ids=lambda pose: pose.name)
def test_a_thing_in_a_grasp_touches_the_skin_and_is_not_thicker_than_asked(pose) -> None:
    posed = deform(SUBJECT, clip_to_limits(SUBJECT, pose_angles(SUBJECT, pose)))
    mesh = place_object(SUBJECT, posed, pose.held)
    if mesh is NOTHING:
        return
    radius = radii(mesh, mesh.vertices, pose.held.kind).max()
    skin = posed.vertices
    if pose.held.kind == "rod":
        along = np.linalg.norm(skin - mesh.vertices.mean(axis=0), axis=1) < ROD_HALF_LENGTH
        skin = skin[along]
    assert radius < pose.held.radius + 1e-6
    assert radii(mesh, skin, pose.held.kind).min() > radius - 1.5 * PRESS, "m; no skin is deeper in it than pressed"
    assert KDTree(posed.vertices).query(mesh.vertices)[0].min() < 4e-3


def test_where_there_is_no_room_nothing_is_held() -> None:
    fist = next(pose for pose in POSES if pose.name == "fist")
    posed = deform(SUBJECT, clip_to_limits(SUBJECT, pose_angles(SUBJECT, fist)))
    mesh = place_object(SUBJECT, posed, HeldObject("ball", 1e-3))
    assert mesh is NOTHING and len(mesh.faces) == 0
