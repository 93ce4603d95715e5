"""The finger parts that might hold an object, as people look at them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.model.scene import PosedScene
from tracker.physics import Contact, PhysicsWorld, find_support
from tracker.physics.closest_points import find_closest_point

Points = npt.NDArray[np.float32]


@dataclass(frozen=True)
class ShownContact:
    """A finger part near the object.

    Attributes:
        hand: Index of its hand among the scene's models.
        part: Such as "index_distal".
        is_chosen: Whether physics would draw it into contact.
        distance: Between the part's skin and the object's surface, m, below 0 inside.
        segment: (2, 3) from the nearest point of the part to that of the object, world, m.
        triangles: (F, 3, 3) corners of the part's skin, world, m.
    """

    hand: int
    part: str
    is_chosen: bool
    distance: float
    segment: Points
    triangles: Points


@dataclass(frozen=True)
class ShownContacts:
    """Whether the object stays where it is, and what could hold it, [T16] §3.2.6.

    Attributes:
        object: Index of the object that is simulated; -1 where there is no object or no hand, and nothing else counts.
        is_stable: Whether it stays.
        displacement: Of its centroid in the simulation, m.
        held_displacement: With the chosen parts in contact, m; `displacement` where there are none.
        simulated: Combinations of parts that were simulated.
        contacts: Parts within 10 mm, nearest first.
    """

    object: int = -1
    is_stable: bool = True
    displacement: float = 0.0
    held_displacement: float = 0.0
    simulated: int = 0
    contacts: tuple[ShownContact, ...] = ()


def show_contacts(posed: PosedScene, world: PhysicsWorld | None) -> ShownContacts:
    """Simulate a posed scene as the physics term does."""
    if world is None:
        return ShownContacts()
    support = find_support(world, posed)
    return ShownContacts(
        world.moving,
        support.is_stable,
        support.displacement,
        support.held_displacement,
        support.simulated,
        tuple(_show(posed, contact, contact in support.contacts) for contact in support.candidates),
    )


def _show(posed: PosedScene, contact: Contact, is_chosen: bool) -> ShownContact:
    model, where = posed.scene.models[contact.hand], posed.scene.vertex_slices[contact.hand]
    assert model.hand is not None
    nearest = find_closest_point(posed, contact.hand, contact.part, contact.object)
    of_part = np.isin(model.faces, model.hand.finger_parts[contact.part]).all(axis=1)
    return ShownContact(
        contact.hand,
        contact.part,
        is_chosen,
        nearest.distance,
        np.stack([nearest.part_point, nearest.point]).astype(np.float32),
        posed.vertices[model.faces[of_part] + where.start].astype(np.float32),
    )
