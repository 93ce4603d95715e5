"""How a simulation is run: its time-step, its materials, which way is down."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

GRAVITY = 9.81
"""m/s²."""


@dataclass(frozen=True)
class Protocol:
    """A simulation of some steps after which the object's centroid has moved, [T16] §3.2.6 and §4.2.1.

    Everything but the object stands still, so only the object's mass counts. Bullet multiplies the friction and the
    restitution of two bodies that touch.

    Attributes:
        name: For reports.
        time_step: s.
        steps: Time-steps.
        substeps: Parts that Bullet takes a time-step in.
        friction: Of hands and objects.
        static_friction: Of the static scene.
        restitution: Of the object; hands and static scene have 0.
        mass: Of the object, kg.
        solver_iterations: Of Bullet's constraint solver.
        skin: Bullet's margin around every hull, m. Hulls that just touch press into each other by two of it, as flesh
            does; rigid bodies hold by friction only what they squeeze.
        patch_radius: Radius of the patch on which a finger's flesh touches, m: it resists turning about the contact's
            normal. 0 for points, about which whatever is pinched beside its centre swings freely.
    """

    name: str
    time_step: float
    steps: int = 35
    substeps: int = 1
    friction: float = 1.2
    static_friction: float = 3.0
    restitution: float = 0.5
    mass: float = 1.0
    solver_iterations: int = 50
    skin: float = 0.001
    patch_radius: float = 0.0

    def __post_init__(self) -> None:
        assert self.time_step > 0.0 and self.steps > 0 and self.substeps > 0 and self.mass > 0.0

    @property
    def contact_friction(self) -> float:
        """Between hand and object."""
        return self.friction**2

    @property
    def spinning_friction(self) -> float:
        """Margins that Bullet is given for hands and object, m.

        A patch of radius r that is pressed with N resists a torque of 2/3 r μ N (a soft finger, pressed evenly), μ the
        friction between the two, here the square of each one's. Bullet adds each body's value times the other's
        friction, 2 times the friction times this.
        """
        return self.friction * self.patch_radius / 3.0

    @property
    def free_fall(self) -> float:
        """How far an object falls that nothing holds, m."""
        ticks = self.steps * self.substeps
        return 0.5 * GRAVITY * (self.time_step / self.substeps) ** 2 * ticks * (ticks + 1)


SD_SEED = Protocol("SD-seed", time_step=0.1)
"""[T16] §4.2.1 to the letter: 35 iterations with a time-step of 0.1 s.

A time-step so long adds 0.98 m/s of fall at once. Bullet finds one contact between two hulls in the first step and
its friction is limited by the little that they overlap, so grasps that hold under SD_OBMAN mostly fall here, by up to
the 61.8 m of a free fall, and flat things on a table tip. With `substeps` of 1/240 s and more they do not.
"""

SD_OBMAN = Protocol("SD-obman", time_step=1.0 / 240.0, friction=3.0, solver_iterations=150)
"""The constants that later work on hands and objects settled on: 35 steps of 1/240 s; a free object falls 0.107 m."""

PATCH_RADIUS = 0.005
"""m; what a finger's flesh touches with is a patch of about this radius, so it also resists turning about itself."""

SEARCH = Protocol("search", time_step=1.0 / 240.0, friction=3.0, patch_radius=PATCH_RADIUS)
"""What the search for support is run with: SD_OBMAN with contacts that are patches, as the wrench test takes them, and
with fewer solver iterations, which change little.

With points for contacts a cube that two fingers carry swings about the line through them, by 12 mm in the time that a
run takes, and true poses count as falling (docs/journal.md). As in [T16] support is looked for in the simulation that
displacement is reported in; friction 3 is the last column of its Table 11. With friction 1.2 and half the skin true
grips of a cube fall, and what is drawn into contact was held.
"""


def find_down(T_world_camera: Array) -> tuple[float, float, float]:
    """Unit direction of gravity in the world for a camera that stands upright: its own +y."""
    assert T_world_camera.shape == (4, 4)
    x, y, z = (float(value) for value in T_world_camera[:3, 1])
    return x, y, z
