"""Points picked on the surface of a posed scene, for tests of residual kinds."""

from __future__ import annotations

import numpy as np

from tests.tracker.grips import ball
from tests.tracker.toys import tube
from tracker.model.scene import PosedScene, Scene


def tube_and_ball(rng: np.random.Generator) -> PosedScene:
    """A bent tube and, 0.3 m beside it, a ball; both somewhere in the world."""
    scene = Scene((tube(), ball()))
    pose = rng.normal(scale=0.4, size=scene.num_dofs)
    pose[scene.pose_slices[1].start] += 0.3
    return scene.pose_at(pose)


def pick_points(posed: PosedScene, count: int, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Ids (N, 3) of the corners of random faces and shares (N, 3) of points inside them."""
    faces = posed.scene.arrays.faces
    return faces[rng.choice(len(faces), count)].astype(np.int32), rng.dirichlet(np.ones(3), count)


def pick_directions(count: int, rng: np.random.Generator) -> np.ndarray:
    """(N, 3) unit."""
    directions = rng.normal(size=(count, 3))
    return directions / np.linalg.norm(directions, axis=1, keepdims=True)


def measure_slopes(cost, posed: PosedScene, step: float = 1e-6) -> np.ndarray:
    """(D,) central differences of a cost of posed scenes by each degree of freedom."""
    scene, steps = posed.scene, step * np.eye(posed.scene.num_dofs)
    ahead, behind = (
        np.array([cost(scene.pose_at(scene.retract(posed.pose, sign * each))) for each in steps]) for sign in (1, -1)
    )
    return (ahead - behind) / (2.0 * step)
