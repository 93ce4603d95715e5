"""The ball lies in the palm and goes where the hand goes."""

import numpy as np

from tracker.model.ball import make_ball
from tracker.model.default_hand import default_hand
from tracker.synthesis.ball import RADIUS, with_ball
from tracker.synthesis.motion import perform


def test_it_is_a_sphere():
    ball = make_ball(0.05)
    np.testing.assert_allclose(np.linalg.norm(ball.vertices, axis=1), 0.05, atol=1e-12)


def test_it_touches_no_bone_of_the_palm_and_keeps_its_place_in_the_hand():
    performance = with_ball(perform({"right": default_hand("right")}, "wave", 40))
    hand, ball = performance.hands[0], performance.objects[0]
    seen = []
    for moment in (0, 17, 39):
        root, center = hand.T_world_model(moment), ball.T_world_model(moment)[:3, 3]
        assert np.linalg.norm(hand.joints(moment, hand.vertices(moment)) - center, axis=1).min() > RADIUS
        seen.append(root[:3, :3].T @ (center - root[:3, 3]))
    np.testing.assert_allclose(seen[1:], [seen[0]] * 2, atol=1e-12)
