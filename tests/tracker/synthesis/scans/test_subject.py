"""Subjects share one mesh, are as large as people, and the untrained hand lies on each of them."""

from __future__ import annotations

import numpy as np
import pytest

from tracker.errors import TrackerError
from tracker.model.joints import FINGERS
from tracker.model.untrained_hand import untrained_hand
from tracker.synthesis.scans.subject import (
    BONES,
    MEAN_SUBJECT,
    PARENTS,
    TEST_SUBJECTS,
    TRAIN_SUBJECTS,
    finger_rows,
    load_subject,
    load_surface,
)
from tracker.synthesis.scans.ties import OVERHANG, load_ties
from tracker.synthesis.scans.tissue import vertex_normals

SURFACE = load_surface()
SOME = (MEAN_SUBJECT, 1, 17, 37)


def test_skin_of_the_mesh_belongs_to_few_bones_wholly_and_the_rim_is_at_the_forearm() -> None:
    assert np.allclose(SURFACE.weights.sum(axis=1), 1.0) and np.allclose(SURFACE.all_weights.sum(axis=1), 1.0)
    assert (np.diff(SURFACE.weights, axis=1) <= 1e-12).all(), "the heaviest first"
    rows = np.arange(len(SURFACE.weights))[:, None]
    assert np.allclose(SURFACE.all_weights[rows, SURFACE.bone_ids], SURFACE.weights)
    rim = load_subject(MEAN_SUBJECT).vertices[SURFACE.border]
    assert rim[:, 0].max() < -0.02, "m; x goes from the wrist to the middle knuckle"
    assert (SURFACE.fine @ np.ones(len(rows))).round(9).tolist() == [1.0] * SURFACE.fine.shape[0]


@pytest.mark.parametrize("number", SOME)
def test_bones_of_a_hand_hang_together_and_lie_in_it(number) -> None:
    subject = load_subject(number)
    assert np.allclose(subject.joints[0], 0.0, atol=1e-9), "the origin is the wrist"
    assert len(BONES) == len(PARENTS) == len(subject.joints) == 20 and len(subject.dofs) == 31
    for finger in FINGERS:
        own = [number for number, name in enumerate(BONES) if name.startswith(finger)]
        assert np.allclose(subject.joints[own[1:]], subject.ends[own[:-1]]), "each begins where the one before ends"
        assert [PARENTS[bone] for bone in own] == [0, *own[:-1]]
    middle = 0.5 * (subject.joints + subject.ends)
    normals = vertex_normals(subject.vertices, SURFACE.faces)
    nearest = np.linalg.norm(subject.vertices[:, None] - middle, axis=2).argmin(axis=0)
    inside = np.einsum("bx,bx->b", middle - subject.vertices[nearest], normals[nearest])
    assert inside.max() < -2e-3, "m below the skin"


@pytest.mark.parametrize("number", SOME)
def test_a_right_hand_is_as_large_as_an_adults_with_its_thumb_on_the_side_of_the_index_finger(number) -> None:
    subject = load_subject(number)
    length = np.linalg.norm(subject.chains.fingers["middle"][-1] - subject.joints[0])
    assert 0.15 < length < 0.22, "m"
    ends = {finger: subject.chains.fingers[finger][-1] for finger in FINGERS}
    knuckles = {finger: subject.chains.fingers[finger][1] for finger in FINGERS[1:]}
    across = knuckles["index"] - knuckles["little"]
    assert (ends["thumb"] - knuckles["middle"]) @ across > 0.0
    assert np.cross(knuckles["middle"], across)[2] > 0.0, "z is out of the back of a right hand"


def test_the_untrained_hand_is_tied_to_the_surface_of_the_mean_subject_closely() -> None:
    ties, model = load_ties(), untrained_hand("right")
    assert np.allclose(np.asarray(ties.matrix.sum(axis=1)), 1.0)
    assert np.median(ties.distances) < 2e-4 and ties.distances.max() < 3e-3, "m"
    placed = ties.matrix @ load_subject(MEAN_SUBJECT).vertices
    assert np.allclose(np.linalg.norm(placed - model.template, axis=1), ties.distances, atol=1e-9)
    assert np.array_equal(ties.faces, model.faces)
    assert (ties.along_arm > -OVERHANG).mean() > 0.6


def test_rows_of_the_fingers_are_all_joints_behind_the_wrist_once() -> None:
    rows = [row for finger in FINGERS for row in range(25)[finger_rows(finger)]]
    assert rows == list(range(1, 25))


@pytest.mark.parametrize("number", [-1, 38])
def test_a_subject_that_there_is_not_is_refused_with_how_many_there_are(number) -> None:
    with pytest.raises(TrackerError, match=f"There is no subject {number}; there are 1 to 37"):
        load_subject(number)
    assert sorted((*TRAIN_SUBJECTS, *TEST_SUBJECTS)) == list(range(1, 38))
