"""An actor's skin and joints are where a model posed the same way has them."""

from __future__ import annotations

import numpy as np
import pytest

from tests.tracker.toys import tube
from tracker.model.ball import make_ball
from tracker.model.default_hand import default_hand
from tracker.model.joints import HAND_JOINTS
from tracker.model.scene import Scene
from tracker.synthesis.actor import Actor

SKIN = (0.8, 0.5, 0.4)


def acting(name: str, model, count: int = 4) -> tuple[Actor, list]:
    """An actor in poses by chance, and the posed scenes."""
    scene, rng = Scene((model,)), np.random.default_rng(3)
    poses = [scene.rest_pose() + 0.2 * rng.standard_normal(len(scene.rest_pose())) for _ in range(count)]
    posed = [scene.pose_at(pose) for pose in poses]
    return Actor(name, model, np.array([each.Ms for each in posed]), SKIN), posed


@pytest.mark.parametrize("side", ["right", "left"])
def test_a_hand_has_the_skin_and_the_21_joints_of_its_posed_model(side) -> None:
    actor, posed = acting(side, default_hand(side))
    assert actor.joint_names == tuple(f"{side}/{joint}" for joint in HAND_JOINTS) and actor.is_hand
    for moment, each in enumerate(posed):
        vertices = actor.vertices(moment)
        assert np.allclose(vertices, each.vertices[each.scene.vertex_slices[0]], atol=1e-9)
        assert np.allclose(actor.joints(moment, vertices), each.landmarks(0), atol=1e-9)


def test_an_articulated_thing_has_a_joint_at_each_bone_and_a_rigid_one_none() -> None:
    model = tube()
    actor, posed = acting("rope", model)
    assert actor.joint_names == ("rope:bone_0", "rope:bone_1", "rope:bone_2") and not actor.is_hand
    rest = model.skeleton.joints_rest
    for moment, each in enumerate(posed):
        expected = np.einsum("bij,bj->bi", each.Ms[:, :, :3], rest) + each.Ms[:, :, 3]
        assert np.allclose(actor.joints(moment, actor.vertices(moment)), expected)
    ball, _ = acting("ball", make_ball(0.03))
    assert ball.joint_names == () and ball.joints(0, ball.vertices(0)).shape == (0, 3)


def test_a_rigid_things_coordinates_move_as_its_vertices_do() -> None:
    ball, _ = acting("ball", make_ball(0.03))
    for moment in range(ball.num_moments):
        T = ball.T_world_model(moment)
        assert np.allclose(ball.vertices(moment), ball.model.vertices @ T[:3, :3].T + T[:3, 3], atol=1e-12)


def test_a_motion_of_another_skeleton_is_no_motion_of_this_model() -> None:
    with pytest.raises(AssertionError):
        Actor("rope", tube(), np.zeros((4, 5, 3, 4)), SKIN)
