"""On real motions with exactly known poses: a hand that holds a ball holds it here too."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tracker.model.scene import PosedScene, Scene
from tracker.physics import PhysicsWorld, find_support, measure_displacement
from tracker.synthesis.performance import Performance
from tracker.synthesis.twin import load_twin


@pytest.fixture(scope="module")
def ball_twin(shared_data: Path) -> Performance:
    return load_twin(shared_data / "ijcv16", "15", 1500)


def pose_truth(performance: Performance, scene: Scene, moment: int, shift: np.ndarray) -> PosedScene:
    """The true bones at a moment, those of the hand moved by `shift` (3,), m."""
    moved = [
        actor.Ms[moment] + (actor.is_hand * np.pad(shift[:, None], ((0, 0), (3, 0)))) for actor in performance.actors
    ]
    rest = scene.pose_at(scene.rest_pose())
    return PosedScene(
        scene, rest.pose, np.concatenate(moved), rest.twists, rest.vertices, rest.bone_vertices, rest.normals
    )


@pytest.mark.shared_data
def test_the_held_ball_of_a_twin_stays_and_the_one_before_the_grasp_falls(ball_twin: Performance) -> None:
    scene, still = Scene(tuple(actor.model for actor in ball_twin.actors)), np.zeros(3)
    with PhysicsWorld(scene) as world:
        held = [measure_displacement(world, pose_truth(ball_twin, scene, f, still)).obman for f in range(60, 150, 15)]
        free = [measure_displacement(world, pose_truth(ball_twin, scene, f, still)).obman for f in (0, 200)]
    assert np.median(held) < 0.002 and max(held) < 0.005
    assert min(free) > 0.1


@pytest.mark.shared_data
def test_a_hand_4_mm_beside_the_truth_is_told_which_fingers_hold(ball_twin: Performance) -> None:
    scene = Scene(tuple(actor.model for actor in ball_twin.actors))
    hand = next(index for index, actor in enumerate(ball_twin.actors) if actor.is_hand)
    with PhysicsWorld(scene) as world:
        for moment in range(60, 150, 30):
            support = find_support(world, pose_truth(ball_twin, scene, moment, np.array([0.004, -0.002, 0.0])))
            if not support.is_stable:
                fingers = {contact.part.split("_")[0] for contact in support.contacts}
                assert fingers == {"thumb", "index"} and support.held_displacement < 0.003
                assert all(contact.hand == hand for contact in support.contacts)
