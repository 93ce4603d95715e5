"""Skin at rest has no folds, bends make the ones they should, and skin that has passed through other skin comes out."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tracker.synthesis.scans.deform import closed_volume
from tracker.synthesis.scans.subject import BONES, load_subject, load_surface
from tracker.synthesis.scans.tissue import FULL_BEND, bending, load_tissue, vertex_normals

SUBJECT, SURFACE = load_subject(6), load_surface()
REST = np.zeros(len(SUBJECT.dofs))


def flexion(bone: str) -> int:
    own = [
        number
        for number, dof in enumerate(SUBJECT.dofs)
        if SUBJECT.dof_bones[number] == BONES.index(bone) and dof.motion == "flexion"
    ]
    return own[0]


@pytest.mark.parametrize("bone", ["index_proximal", "middle_middle", "little_distal"])
def test_a_bent_joint_moves_the_skin_about_it_and_none_of_the_other_fingers(bone) -> None:
    angles = REST.copy()
    angles[flexion(bone)] = FULL_BEND
    own, pads = load_tissue(SUBJECT.number).displace(angles, 1.0)
    moved = np.linalg.norm(own + pads, axis=1)
    joint = SUBJECT.joints[BONES.index(bone)]
    reached = np.linalg.norm(SUBJECT.vertices - joint, axis=1)[moved > 1e-4]
    assert 5e-4 < moved.max() < 6e-3 and reached.max() < 0.06, "m"
    finger = SURFACE.all_weights[:, [BONES.index(name) for name in BONES if name.startswith(bone.split("_")[0])]]
    assert finger.sum(axis=1)[moved > 1e-4].min() > 0.02


@settings(max_examples=30, deadline=None)
@given(st.lists(st.floats(-1.5, 2.0), min_size=4, max_size=4))
def test_bending_grows_with_the_angle_is_one_when_full_and_none_when_stretched(angles) -> None:
    values = np.array(sorted(angles))
    drivers = np.column_stack([np.arange(4), np.full(4, -1)])
    shares = bending(values, drivers)
    assert (np.diff(shares) >= -1e-12).all() and (shares[values <= 0.0] == 0.0).all()
    assert shares.max(initial=0.0) < 1.0 / np.tanh(1.4)
    assert bending(np.array([FULL_BEND]), np.array([[0, -1]]))[0] == pytest.approx(1.0)
    pair = bending(values, np.array([[0, 3]]))[0]
    assert pair == pytest.approx(0.5 * (shares[0] + shares[3])), "a field of two joints needs both"


def test_normals_are_unit_look_outwards_and_turn_with_the_hand() -> None:
    normals = vertex_normals(SUBJECT.vertices, SURFACE.faces)
    assert np.allclose(np.linalg.norm(normals, axis=1), 1.0)
    R = np.linalg.qr(np.random.default_rng(0).standard_normal((3, 3)))[0]
    R *= np.sign(np.linalg.det(R))
    assert np.allclose(vertex_normals(SUBJECT.vertices @ R.T, SURFACE.faces), normals @ R.T, atol=1e-9)
    thicker = closed_volume(SUBJECT.vertices + 1e-3 * normals, SURFACE.faces, SURFACE.border)
    assert thicker > closed_volume(SUBJECT.vertices, SURFACE.faces, SURFACE.border) > 2e-4, "m^3"
