"""Which finger parts would hold the object if they touched it, [T16] §3.2.6."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
import numpy.typing as npt

from tracker.model.articulated import ArticulatedModel
from tracker.model.scene import PosedScene
from tracker.physics.protocol import SEARCH, Protocol
from tracker.physics.world import Gap, PhysicsWorld
from tracker.physics.wrench import build_wrenches, find_imbalance

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Contact:
    """A finger part that should touch an object.

    Attributes:
        hand: Index of the hand among the scene's models.
        part: Name of the part, such as "index_distal".
        object: Index of the object among the scene's models.
    """

    hand: int
    part: str
    object: int


@dataclass(frozen=True)
class SupportOptions:
    """How support is looked for.

    Attributes:
        stable_below: An object whose centroid moves less is held, m (3 mm).
        near: Finger parts not farther than this are candidates, m (10 mm).
        most_candidates: The nearest so many are looked at.
        most_parts: Parts in one combination; at least two.
        most_simulations: Combinations that are simulated, the most promising of those that the wrench test lets pass.
        carried: A combination passes that leaves at most this share of the weight uncarried.
        reach: Still hulls farther from the object than this play no part, m; no less than `near`.
        protocol: Of the simulations.
    """

    stable_below: float = 0.003
    near: float = 0.010
    most_candidates: int = 6
    most_parts: int = 4
    most_simulations: int = 4
    carried: float = 0.05
    reach: float = 0.010
    protocol: Protocol = SEARCH


@dataclass(frozen=True)
class Support:
    """What was found.

    Attributes:
        displacement: Of the object's centroid as things are, m; at most a little over what counts as fallen.
        is_stable: Whether that is little.
        candidates: Parts near enough to be moved, nearest first.
        contacts: The parts that hold the object best; none when it is held as it is, or nothing can hold it.
        touching: The other candidates that touch it as things are, and help.
        held_displacement: With these parts in contact, m; `displacement` when there are none.
        simulated: Combinations simulated.
        passed: Combinations that the wrench test let pass.
    """

    displacement: float
    is_stable: bool
    candidates: tuple[Contact, ...]
    contacts: tuple[Contact, ...]
    held_displacement: float
    simulated: int
    passed: int
    touching: tuple[Contact, ...] = ()


FALLEN = 0.030
"""m; an object that has moved so far is not coming back, and the simulation of a combination ends."""


def find_support(world: PhysicsWorld, posed: PosedScene, options: SupportOptions | None = None) -> Support:
    """Simulate the pose; if the object falls, try the finger parts near it and keep what holds it best.

    Overlaps of hulls are resolved before anything is simulated (a hull is set back until it just touches), because
    they would throw the object. A candidate is set forward until it touches, and so is a plane as near as that.

    Differs from the paper: combinations must pass a wrench test, and at most `most_simulations` of those that do are
    simulated; the search ends early at one that moves the object less than two thirds of `stable_below`. An object that
    nothing is near is not simulated: it falls.

    Args:
        world: Hulls of the scene.
        posed: The scene.
        options: How to look.
    """
    options = options or SupportOptions()
    gaps, settled, displacement = _settle(world, posed, options)
    movable = _find_movable(world, gaps, options)
    candidates = tuple(contact for _, contact in movable)
    if displacement < options.stable_below or len(movable) < 2:
        is_stable = displacement < options.stable_below
        return Support(displacement, is_stable, candidates, (), displacement, 0, 0)
    ranked, passed = rank_combinations(world, gaps, [gap for gap, _ in movable], options)
    best: tuple[int, ...] = ()
    best_displacement, simulated = displacement, 0
    for combination in ranked[: min(passed, options.most_simulations)]:
        moved = settled | {movable[i][0].hull: -movable[i][0].distance * movable[i][0].normal for i in combination}
        simulated += 1
        enough = 2.0 * options.stable_below / 3.0
        trial = world.run(moved, give_up=min(FALLEN, best_displacement), calm_below=enough)
        if trial < best_displacement:
            best, best_displacement = combination, trial
        if best_displacement < enough:
            break
    if best_displacement >= FALLEN:
        best, best_displacement = (), displacement
    contacts = tuple(movable[i][1] for i in best)
    touched = [contact for gap, contact in movable if gap.distance <= 2.0 * options.protocol.skin]
    touching = tuple(contact for contact in touched if contact not in contacts)
    return Support(displacement, False, candidates, contacts, best_displacement, simulated, passed, touching)


def find_settled_displacement(world: PhysicsWorld, posed: PosedScene, options: SupportOptions | None = None) -> float:
    """Distance that the object's centroid moves, m, once overlaps are resolved: what `find_support` starts with."""
    return _settle(world, posed, options or SupportOptions())[2]


def _settle(
    world: PhysicsWorld, posed: PosedScene, options: SupportOptions
) -> tuple[tuple[Gap, ...], dict[int, Array], float]:
    """What is near, how far hulls are set back to where they just touch, and how far the object then moves, m."""
    world.place(posed, options.protocol, options.reach, rests_within=options.near)
    gaps = world.find_gaps(max(options.near, 2.0 * options.protocol.skin))
    if not gaps and not world.planes:
        return gaps, {}, options.protocol.free_fall
    settled = {gap.hull: -gap.distance * gap.normal for gap in gaps if gap.distance < 0.0}
    return gaps, settled, world.run(settled, give_up=FALLEN, calm_below=options.stable_below)


def rank_combinations(
    world: PhysicsWorld, gaps: Sequence[Gap], movable: Sequence[Gap], options: SupportOptions
) -> tuple[list[tuple[int, ...]], int]:
    """Combinations of two to `most_parts` of the movable gaps, the most promising first, and how many may hold.

    Those that can carry the weight come first: the pair that moves the fingers least, then the three, then the four,
    then the second pair, and so on, since three often hold what turns between two. The rest follow by how much they
    carry. What touches already helps in every combination.
    """
    touching = [gap for gap in gaps if gap.distance <= 2.0 * options.protocol.skin]
    always = {gap.hull for gap in touching}
    by_hull = _build_by_hull(world, [*touching, *movable], options.protocol.contact_friction)
    plane_friction = options.protocol.static_friction * options.protocol.friction
    still = build_wrenches(*world.find_plane_contacts(), plane_friction, world.centroid, world.radius)
    passing: list[tuple[int, int, tuple[int, ...]]] = []
    failing: list[tuple[float, tuple[int, ...]]] = []
    for size in range(2, options.most_parts + 1):
        held: list[tuple[float, tuple[int, ...]]] = []
        for combination in combinations(range(len(movable)), size):
            hulls = always | {movable[i].hull for i in combination}
            wrenches = np.concatenate([still, *(by_hull[hull] for hull in sorted(hulls))], axis=1)
            imbalance = find_imbalance(wrenches, world.down)
            if imbalance <= options.carried:
                held.append((sum(max(movable[i].distance, 0.0) for i in combination), combination))
            else:
                failing.append((imbalance, combination))
        passing += [(place, size, combination) for place, (_, combination) in enumerate(sorted(held))]
    ranked = [combination for *_, combination in sorted(passing)] + [combination for _, combination in sorted(failing)]
    return ranked, len(passing)


def _build_by_hull(world: PhysicsWorld, gaps: Sequence[Gap], friction: float) -> dict[int, Array]:
    """Wrenches (6, n) of the contact that closes each hull's gap, the last one given of each hull."""
    usable = list({gap.hull: gap for gap in gaps}.values())
    points = np.array([gap.point for gap in usable]).reshape(-1, 3)
    inward = -np.array([gap.normal for gap in usable]).reshape(-1, 3)
    wrenches = build_wrenches(points, inward, friction, world.centroid, world.radius)
    each = np.split(wrenches, max(len(usable), 1), axis=1)
    return {gap.hull: columns for gap, columns in zip(usable, each, strict=False)}


def find_part_bones(model: ArticulatedModel) -> dict[int, str]:
    """Bone to name of the finger parts that may support an object: no wrist, no metacarpal, [T16] Fig. 10."""
    assert model.hand is not None
    heaviest = np.argmax(model.skinning_weights, axis=1)
    parts = {}
    for name, ids in model.hand.finger_parts.items():
        if len(ids) and name != "wrist" and not name.endswith("_metacarpal"):
            parts[int(np.bincount(heaviest[ids]).argmax())] = name
    return parts


def _find_movable(world: PhysicsWorld, gaps: Sequence[Gap], options: SupportOptions) -> list[tuple[Gap, Contact]]:
    found = []
    parts = {index: find_part_bones(model) for index, model in enumerate(world.scene.models) if model.hand}
    for gap in gaps:
        model, hull = world.hulls[gap.hull]
        if model not in parts or gap.distance > options.near:
            continue
        part = parts[model].get(hull.bone)
        if part is not None:
            found.append((gap, Contact(model, part, world.moving)))
    return found[: options.most_candidates]
