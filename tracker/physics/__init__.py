"""Rigid-body simulation of hands and the object they hold; [T16] §3.2.6."""

from tracker.capture.static_plane import StaticPlane
from tracker.physics.bullet import find_physics_fault
from tracker.physics.displacement import Displacement, measure_displacement, simulate
from tracker.physics.plane_search import find_plane
from tracker.physics.protocol import SD_OBMAN, SD_SEED, SEARCH, Protocol, find_down
from tracker.physics.static_scene import StaticScene, choose_down
from tracker.physics.support import (
    Contact,
    Support,
    SupportOptions,
    find_part_bones,
    find_settled_displacement,
    find_support,
)
from tracker.physics.world import PhysicsWorld

__all__ = [
    "SD_OBMAN",
    "SD_SEED",
    "SEARCH",
    "Contact",
    "Displacement",
    "PhysicsWorld",
    "Protocol",
    "StaticPlane",
    "StaticScene",
    "Support",
    "SupportOptions",
    "choose_down",
    "find_down",
    "find_part_bones",
    "find_physics_fault",
    "find_plane",
    "find_settled_displacement",
    "find_support",
    "measure_displacement",
    "simulate",
]
