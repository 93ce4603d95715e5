import numpy as np
import pytest

from tests.tracker.training.fingers import PARENTS, make_fingers, pose
from tracker.training.linearize import linearize
from tracker.training.motion import sparsen_skinning, turn


@pytest.mark.parametrize("with_bulges", [False, True])
def test_normal_equations_are_those_of_finite_differences(with_bulges):
    fingers = make_fingers(with_bulges=with_bulges)
    skinning = sparsen_skinning(fingers.weights)
    directions = fingers.directions if with_bulges else np.zeros((*fingers.templates[0].shape, 0))
    template, joints, target = fingers.templates[0], fingers.joints[0], fingers.targets[7]
    rotations, translation = fingers.rotations[3], fingers.translations[3]

    def residual(x):
        turned = rotations.copy()
        for b in range(4):
            turn(turned[b], *x[3 * b : 3 * b + 3])
        moved = pose(
            template, joints + x[15:].reshape(4, 3), PARENTS, skinning, directions, turned, translation + x[12:15]
        )[0]
        return (moved - target).ravel()

    H, g = np.empty((27, 27)), np.empty(27)
    cost = linearize(
        template, joints, PARENTS, *skinning, directions, target, rotations, translation, True, H, g
    )  # fmt: skip
    J = np.stack([(residual(1e-6 * e) - residual(-1e-6 * e)) / 2e-6 for e in np.eye(27)], axis=1)
    r = residual(np.zeros(27))
    np.testing.assert_allclose(H, J.T @ J, atol=1e-8 * np.abs(H).max())
    np.testing.assert_allclose(g, J.T @ r, atol=1e-8 * np.abs(g).max())
    assert cost == pytest.approx(r @ r, rel=1e-12)
