"""The normal equations that training solves meet finite differences of where the kernels put a hand."""

import numpy as np
import pytest

from tests.tracker.training.fingers import PARENTS, make_fingers
from tracker.model.skinning import keep_heaviest
from tracker.training.linearize import linearize
from tracker.training.rig import Rig, place, turn


@pytest.mark.parametrize("with_bulges", [False, True])
@pytest.mark.parametrize("with_joints", [False, True])
def test_normal_equations_are_those_of_finite_differences(with_bulges, with_joints):
    fingers = make_fingers(with_bulges=with_bulges)
    directions = fingers.directions if with_bulges else np.zeros((*fingers.templates[0].shape, 0))
    rig = Rig(PARENTS, keep_heaviest(fingers.weights), directions)
    template, joints, target = fingers.templates[0], fingers.joints[0], fingers.targets[7]
    pose = fingers.rotations[3], fingers.translations[3]
    size = 27 if with_joints else 15

    def residual(x):
        moved = place(rig, template, joints + (x[15:].reshape(-1, 3) if with_joints else 0.0), *turn(*pose, x[:15]))
        return (moved.vertices - target).ravel()

    H, g = np.empty((size, size)), np.empty(size)
    linearize(H, g, place(rig, template, joints, *pose), rig.arrays, target)
    J = np.stack([(residual(1e-6 * e) - residual(-1e-6 * e)) / 2e-6 for e in np.eye(size)], axis=1)
    np.testing.assert_allclose(H, J.T @ J, atol=1e-8 * np.abs(H).max())
    np.testing.assert_allclose(g, J.T @ residual(np.zeros(size)), atol=1e-8 * np.abs(g).max())
