"""How far the object moves when the simulation is let go at a pose: what studies report."""

from __future__ import annotations

from dataclasses import dataclass

from tracker.model.scene import PosedScene
from tracker.physics.protocol import SD_OBMAN, SD_SEED, Protocol
from tracker.physics.world import PhysicsWorld


@dataclass(frozen=True)
class Displacement:
    """Distance of the object's centroid from where it was, m, under both protocols."""

    seed: float
    obman: float


def simulate(world: PhysicsWorld, posed: PosedScene, protocol: Protocol) -> float:
    """Distance that the object's centroid moves, m, from the pose exactly as it is, [T16] §4.2.1."""
    world.place(posed, protocol)
    return world.run()


def measure_displacement(world: PhysicsWorld, posed: PosedScene) -> Displacement:
    """Under `SD_SEED` and `SD_OBMAN`; report both, since each is what somebody compares with."""
    return Displacement(simulate(world, posed, SD_SEED), simulate(world, posed, SD_OBMAN))
