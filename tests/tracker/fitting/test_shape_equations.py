"""The derivative of a posed hand by its shape is exact."""

import numpy as np

from tests.tracker.scenes import drawn_hand
from tracker.fitting.objective import Objective
from tracker.fitting.shape_equations import SceneDirections, reduce_equations, shape_derivative
from tracker.model.ball import make_ball
from tracker.model.default_hand import default_hand
from tracker.model.hand_directions import HandDirections
from tracker.model.local_directions import local_directions, mark_directions
from tracker.model.scene import Scene


def test_the_shape_derivative_agrees_with_finite_differences(rng):
    hands = default_hand("right"), default_hand("left")
    own = tuple(
        HandDirections.join(
            [
                HandDirections.of_shape(hand),
                local_directions(hand),
                mark_directions(hand, np.full(21, 0.004), np.full(21, 0.002)),
            ]
        )
        for hand in hands
    )
    scene = Scene(hands)
    directions = SceneDirections.stack(scene, own)
    pose = rng.uniform(-0.5, 0.5, scene.num_dofs)
    moves = shape_derivative(scene.pose_at(pose), directions)
    values = 1e-3 * rng.normal(size=moves.shape[2])

    def moved(sign: float) -> np.ndarray:
        parts = zip(hands, own, directions.slices, strict=True)
        return Scene(tuple(h.apply(m, sign * values[w]) for m, h, w in parts)).pose_at(pose).vertices

    # vertices and joints at rest are linear in the values, and so, by Eq. 1, is the posed hand
    np.testing.assert_allclose(moves @ values, 0.5 * (moved(1.0) - moved(-1.0)), atol=1e-12)
    assert np.abs(moves @ values).max() > 1e-6


def test_an_object_that_nothing_observes_stays_where_it_is():
    drawn = drawn_hand()
    scene = Scene((*drawn.scene.models, make_ball()))
    directions = SceneDirections.stack(scene, (HandDirections.of_shape(scene.models[0]),))
    pose = np.r_[drawn.pose, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0]
    found = reduce_equations(scene, directions, drawn.observation, pose, Objective())
    np.testing.assert_allclose(found.settle[scene.pose_slices[1]], 0.0, atol=1e-9)
    np.testing.assert_allclose(found.follow[scene.pose_slices[1]], 0.0, atol=1e-9)
