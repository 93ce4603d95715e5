"""The fingers that would hold an object are found, and pruning never loses the best of them."""

from itertools import combinations

import numpy as np
import pytest

from tests.tracker.grips import PINCH, cube, gripped
from tracker.model.default_hand import default_hand
from tracker.physics import SEARCH, Contact, PhysicsWorld, StaticPlane, SupportOptions, find_part_bones, find_support
from tracker.physics.support import rank_combinations

AROUND = ([1, 0, 0], [-1, 0.1, 0], [0.5, 0.1, 0.85], [0.5, 0, -0.85])


def test_what_is_held_needs_no_support():
    posed = gripped(PINCH, (0.0, 0.0))
    with PhysicsWorld(posed.scene) as world:
        support = find_support(world, posed)
    assert support.is_stable and support.contacts == () and support.simulated == 0


def test_parts_moved_5_mm_away_are_the_support_that_is_found():
    posed = gripped((*PINCH, [0, -1, 0]), (0.005, 0.005, 0.008))
    with PhysicsWorld(posed.scene) as world:
        support = find_support(world, posed)
    assert not support.is_stable and support.displacement > 0.02
    assert {"thumb_distal", "index_distal"} <= {contact.part for contact in support.contacts}
    assert all(contact.hand == 0 and contact.object == 1 for contact in support.contacts)
    assert support.held_displacement < 0.003


def test_parts_that_are_too_far_are_no_candidates():
    posed = gripped(PINCH, (0.005, 0.012))
    with PhysicsWorld(posed.scene) as world:
        support = find_support(world, posed)
    assert support.candidates == (Contact(0, "thumb_distal", 1),) and support.contacts == ()
    assert support.held_displacement == support.displacement


def test_a_finger_that_overlaps_the_object_does_not_throw_it():
    posed = gripped(PINCH, (-0.004, -0.0005))
    with PhysicsWorld(posed.scene) as world:
        assert find_support(world, posed).is_stable


@pytest.mark.parametrize("seed", range(6))
def test_pruning_never_removes_the_best_combination(seed):
    rng = np.random.default_rng(seed)
    gaps = rng.uniform(0.002, 0.009, size=4)
    posed = gripped(AROUND, gaps.tolist(), cube(0.034) if seed % 2 else None)
    options = SupportOptions(most_simulations=99)
    with PhysicsWorld(posed.scene) as world:
        world.place(posed, options.protocol, options.reach)
        near = world.find_gaps(options.near)
        ranked, passed = rank_combinations(world, near, near, options)
        every = [c for size in (2, 3, 4) for c in combinations(range(len(near)), size)]
        assert sorted(ranked) == sorted(every)
        moved = {c: world.run({near[i].hull: -near[i].distance * near[i].normal for i in c}) for c in every}
        best = min(moved, key=lambda c: moved[c])
        if moved[best] < options.stable_below:
            assert best in ranked[:passed]
            kept = find_support(world, posed)
            assert kept.held_displacement < options.stable_below


def test_the_same_input_finds_the_same_support_to_the_bit():
    posed = gripped(AROUND, (0.004, 0.005, 0.006, 0.003))
    with PhysicsWorld(posed.scene) as one, PhysicsWorld(posed.scene) as other:
        first = find_support(one, posed)
        find_support(other, gripped_elsewhere(posed))
        assert find_support(other, posed) == first == find_support(one, posed)


def gripped_elsewhere(posed):
    pose = posed.pose.copy()
    pose[6:10] += 0.02
    return posed.scene.pose_at(pose)


def test_parts_that_touch_already_are_told_apart_from_those_that_are_chosen():
    posed = gripped((*PINCH, [0, 0, 1]), (0.005, 0.004, 0.0))
    with PhysicsWorld(posed.scene) as world:
        support = find_support(world, posed)
    assert Contact(0, "middle_distal", 1) in {*support.touching, *support.contacts}
    assert not {*support.touching} & {*support.contacts} and {*support.touching} <= {*support.candidates}
    assert Contact(0, "thumb_distal", 1) not in support.touching


def test_what_nothing_is_near_falls_freely_and_is_not_simulated():
    posed = gripped(PINCH, (0.1, 0.1))
    with PhysicsWorld(posed.scene) as world:
        support = find_support(world, posed)
        world.place(posed, SEARCH)
        assert support.displacement == pytest.approx(world.run(), rel=1e-3)
    assert not support.is_stable and support.contacts == () and support.candidates == ()


def test_a_hand_supports_with_its_fingers_only():
    names = set(find_part_bones(default_hand("right")).values())
    assert len(names) == 14 and not any("metacarpal" in name or name == "wrist" for name in names)


@pytest.mark.parametrize("height", [-0.008, 0.0, 0.008])
def test_a_ball_on_a_table_needs_no_fingers_though_the_table_is_known_to_a_centimetre_only(height):
    posed = gripped(PINCH, (0.005, 0.005))
    lowest = float(posed.vertices[posed.scene.vertex_slices[1]][:, 1].max())
    table = StaticPlane((0.0, lowest + height, 0.0), (0.0, -1.0, 0.0))
    with PhysicsWorld(posed.scene, planes=[table]) as world:
        assert find_support(world, posed).is_stable
    far = StaticPlane((0.0, lowest + 0.05, 0.0), (0.0, -1.0, 0.0))
    with PhysicsWorld(posed.scene, planes=[far]) as world:
        assert not find_support(world, posed).is_stable, "it would fall on it"
