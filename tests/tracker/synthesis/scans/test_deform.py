"""A hand at rest is the subject's own, its volume is a volume, and phalanges roll over one another."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tracker.synthesis.scans.deform import closed_volume, deform, place_bones, rolling
from tracker.synthesis.scans.subject import BONES, load_subject, load_surface
from tracker.synthesis.scans.tissue import load_tissue

SUBJECT, SURFACE = load_subject(6), load_surface()
REST = np.zeros(len(SUBJECT.dofs))


def flexion(bone: str) -> int:
    own = [
        number
        for number, dof in enumerate(SUBJECT.dofs)
        if SUBJECT.dof_bones[number] == BONES.index(bone) and dof.motion == "flexion"
    ]
    return own[0]


def test_at_rest_nothing_is_displaced_and_the_hand_is_the_subjects_own() -> None:
    own, pads = load_tissue(SUBJECT.number).displace(REST, 1.0)
    assert not own.any() and not pads.any()
    posed = deform(SUBJECT, REST)
    assert np.allclose(posed.vertices, SUBJECT.vertices, atol=1e-12)
    assert np.allclose(posed.Ts, np.tile(np.eye(3, 4), (len(BONES), 1, 1)), atol=1e-12)


@settings(max_examples=15, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_volume_does_not_depend_on_where_the_hand_is_and_grows_with_the_cube_of_its_size(seed) -> None:
    rng = np.random.default_rng(seed)
    R = np.linalg.qr(rng.standard_normal((3, 3)))[0]
    R *= np.sign(np.linalg.det(R))
    volume = closed_volume(SUBJECT.vertices, SURFACE.faces, SURFACE.border)
    moved = SUBJECT.vertices @ R.T + rng.standard_normal(3)
    assert closed_volume(moved, SURFACE.faces, SURFACE.border) == pytest.approx(volume, rel=1e-9)
    assert closed_volume(1.1 * SUBJECT.vertices, SURFACE.faces, SURFACE.border) == pytest.approx(1.1**3 * volume)


def test_a_phalanx_rolls_over_the_head_before_it_towards_the_palm() -> None:
    """Its centre of rotation is elsewhere when it is bent, which no model of fixed joints has."""
    rolls = rolling(SUBJECT.number)
    names = [name for name, roll in zip(BONES, rolls, strict=True) if roll.any()]
    assert len(names) == 12 and not any(name.startswith(("thumb", "wrist")) for name in names)
    angles = REST.copy()
    angles[flexion("index_middle")] = np.pi / 2
    bone = BONES.index("index_middle")
    T = place_bones(SUBJECT, angles)[bone]
    center = T[:, :3] @ SUBJECT.joints[bone] + T[:, 3]
    assert np.allclose(center - SUBJECT.joints[bone], rolls[bone], atol=1e-9)
    assert (center - SUBJECT.joints[bone])[2] < -3e-4, "m; z is out of the back of the hand"
