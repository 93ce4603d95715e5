"""What is held stays, what is not falls, and the same goes in twice to the same bits."""

from dataclasses import replace

import numpy as np
import pytest
import trimesh

from tests.tracker.grips import BALL_RADIUS, PINCH, cube, gripped, rigid
from tests.tracker.toys import tube
from tracker.geometry import se3
from tracker.model.scene import Scene
from tracker.physics import (
    SD_OBMAN,
    SD_SEED,
    SEARCH,
    PhysicsWorld,
    Protocol,
    StaticPlane,
    find_down,
    measure_displacement,
    simulate,
)

GENTLE = Protocol("gentle", time_step=1.0 / 240.0, skin=0.0005)
FREE_FALL = 0.5 * 9.81 * (35 / 240) ** 2


def test_a_ball_between_two_opposing_tips_is_held():
    posed = gripped(PINCH, (0.0, 0.0))
    with PhysicsWorld(posed.scene) as world:
        for protocol in (SEARCH, SD_OBMAN, GENTLE):
            assert simulate(world, posed, protocol) < 2.0 * protocol.skin  # as far as it is squeezed


def test_a_ball_that_nothing_holds_falls_as_galileo_says():
    posed = gripped(PINCH, (0.1, 0.1))
    with PhysicsWorld(posed.scene) as world:
        assert simulate(world, posed, SEARCH) == pytest.approx(FREE_FALL, rel=0.05)
        assert measure_displacement(world, posed).seed == pytest.approx(9.81 * 0.1**2 * 35 * 36 / 2, rel=1e-3)
        world.place(posed, SEARCH)
        assert 0.03 < world.run(give_up=0.03) < 0.06


def test_down_is_an_option():
    posed = gripped(([0, 0, 1],), (0.0,))
    with PhysicsWorld(posed.scene, down=(0.0, 0.0, 1.0)) as world:
        assert simulate(world, posed, SEARCH) < 0.002
    with PhysicsWorld(posed.scene, down=(0.0, 0.0, -1.0)) as world:
        assert simulate(world, posed, SEARCH) > 0.05
    T = se3.exp(np.array([0.1, 0.2, 0.3, 0.4, 0.5, 0.6]))
    np.testing.assert_allclose(find_down(T), T[:3, :3] @ [0.0, 1.0, 0.0])


PARTS = Protocol("SD-seed in parts", time_step=0.1, steps=5, substeps=24)


@pytest.mark.parametrize("protocol", [SD_OBMAN, SEARCH, PARTS], ids=lambda p: p.name)
def test_a_cube_on_a_table_stays(protocol):
    posed = gripped(PINCH, (0.1, 0.1), cube(0.04))
    table = StaticPlane((0.0, -0.02 + 0.02, 0.0), (0.0, -1.0, 0.0))  # the cube's lower side touches it
    with PhysicsWorld(posed.scene, planes=[table]) as world:
        assert simulate(world, posed, protocol) < 0.003


def test_time_steps_may_be_taken_in_parts():
    posed = gripped(PINCH, (0.1, 0.1))
    parts = Protocol("parts", time_step=10.0 / 240.0, steps=3, substeps=10)
    with PhysicsWorld(posed.scene) as world:
        assert simulate(world, posed, parts) == pytest.approx(0.5 * 9.81 * (30 / 240) ** 2, rel=0.05)


def test_gaps_are_measured_between_the_surfaces():
    posed = gripped(PINCH, (0.005, -0.002))
    with PhysicsWorld(posed.scene) as world:
        world.place(posed, SEARCH)
        near, far = world.find_gaps(0.010)
        assert near.distance == pytest.approx(-0.002, abs=4e-4) and far.distance == pytest.approx(0.005, abs=4e-4)
        np.testing.assert_allclose(far.normal, [1.0, 0.0, 0.0], atol=0.1)
        np.testing.assert_allclose(np.linalg.norm(far.point - world.centroid), BALL_RADIUS, atol=4e-4)
        assert len(world.find_gaps(0.003)) == 1


def test_the_same_simulation_gives_the_same_bits_whatever_was_simulated_before():
    held, loose = gripped(PINCH, (0.001, -0.001)), None
    with PhysicsWorld(held.scene) as fresh:
        expected = simulate(fresh, held, SEARCH)
        assert simulate(fresh, held, SEARCH) == expected
    with PhysicsWorld(held.scene) as used:
        for step in range(12):
            pose = held.pose.copy()
            pose[7] += 0.01 * step
            pose[-3] += 0.001 * step
            loose = held.scene.pose_at(pose)
            simulate(used, loose, (SD_SEED, SD_OBMAN, SEARCH)[step % 3])
            used.find_gaps(0.01)
            used.run({0: np.array([0.001, 0.0, 0.0])})
        assert simulate(used, held, SEARCH) == expected


def test_an_articulated_object_falls_and_rests_as_one_body():
    scene = Scene((gripped(PINCH, (0.1, 0.1)).scene.models[0], tube(bones=4, rings=17)))
    pose = scene.rest_pose()
    pose[scene.pose_slices[1]][6:] = 0.0
    pose[scene.pose_slices[1].start + 6] = 0.6
    pose[scene.pose_slices[0].start + 2] = 1.0
    posed = scene.pose_at(pose)
    with PhysicsWorld(scene) as world:
        assert simulate(world, posed, SEARCH) == pytest.approx(FREE_FALL, rel=0.05)
        lowest = posed.vertices[scene.vertex_slices[1]][:, 2].min()
    table = StaticPlane((0.0, 0.0, float(lowest)), (0.0, 0.0, 1.0))
    with PhysicsWorld(scene, down=(0.0, 0.0, -1.0), planes=[table]) as world:
        assert simulate(world, posed, SEARCH) < 0.003


def test_a_rope_that_hangs_on_a_fingertip_moves_the_same_whether_its_far_bones_have_shapes_or_not():
    scene = Scene((gripped(PINCH, (0.1, 0.1)).scene.models[0], tube(bones=6, rings=25)))
    pose = scene.rest_pose()
    pose[scene.pose_slices[1].start + 6 :] = 0.2
    start, short = scene.pose_at(pose), Protocol("short", time_step=1.0 / 240.0, steps=12)
    hand = scene.models[0].hand
    assert hand is not None
    tip = start.vertices[hand.finger_parts["thumb_distal"]].mean(axis=0)
    for bone in (0, 5):  # an end of the rope lies on a fingertip; the rest swings down
        of_bone = np.argmax(scene.models[1].skinning_weights, axis=1) == bone
        end = start.vertices[scene.vertex_slices[1]][of_bone].mean(axis=0)
        moved = pose.copy()
        moved[scene.pose_slices[0].start : scene.pose_slices[0].start + 3] += end - tip + [0.0, 0.016, 0.0]
        posed = scene.pose_at(moved)
        with PhysicsWorld(scene) as world:
            world.place(posed, short)
            every = world.run()
            world.place(posed, short, reach=0.03)
            near = world.run()
            assert near == pytest.approx(every, rel=0.01) and near < 0.9 * short.free_fall


@pytest.mark.parametrize("protocol", [SD_OBMAN, GENTLE], ids=lambda p: p.name)
def test_every_bone_of_an_object_has_the_materials_of_the_protocol(protocol):
    scene = Scene((gripped(PINCH, (0.1, 0.1)).scene.models[0], tube(bones=4, rings=17)))
    posed = scene.pose_at(scene.rest_pose())
    with PhysicsWorld(scene) as world:
        world.place(posed, protocol)
        bullet, client, body = world._bullet, world._client, world._object
        links = range(-1, bullet.getNumJoints(body, physicsClientId=client))
        found = [bullet.getDynamicsInfo(body, link, physicsClientId=client) for link in links]
        weights = np.array([hull.volume for hull in world.object_hulls])
        assert len(found) == 4
        for info, hull, mass in zip(found, world.object_hulls, weights / weights.sum(), strict=True):
            assert info[0] == pytest.approx(mass) and info[1] == protocol.friction and info[5] == protocol.restitution
            np.testing.assert_allclose(info[2], mass * hull.inertia_per_mass, rtol=1e-9)
            assert info[11] == protocol.skin


def test_an_early_end_says_what_all_steps_say():
    for gaps in ((0.0, 0.0), (0.0008, -0.0005), (0.001, 0.1), (0.1, 0.1)):
        posed = gripped(PINCH, gaps)
        with PhysicsWorld(posed.scene) as world:
            world.place(posed, SEARCH)
            all_steps, early = world.run(), world.run(give_up=0.03, calm_below=0.003)
            assert (early < 0.003) == (all_steps < 0.003)
            if all_steps < 0.003:
                assert early == pytest.approx(all_steps, abs=0.0005)


def test_closed_worlds_give_their_clients_back():
    posed = gripped(PINCH, (0.0, 0.0))
    clients = set()
    for _ in range(5):
        world = PhysicsWorld(posed.scene)
        clients.add(world._client)
        world.close()
        world.close()
    assert len(clients) == 1


@pytest.mark.parametrize("aside", [0.008, 0.016, 0.020])
def test_a_bar_that_is_pinched_beside_its_middle_does_not_swing_between_patches(aside):
    mesh = trimesh.creation.box(extents=[0.04, 0.03, 0.08])
    grip = gripped(PINCH, (0.0, 0.0), rigid("bar", np.array(mesh.vertices), np.array(mesh.faces)))
    pose = grip.pose.copy()
    pose[grip.scene.pose_slices[1].start + 2] += aside
    posed, long = grip.scene.pose_at(pose), replace(SEARCH, steps=100)
    with PhysicsWorld(grip.scene) as world:
        assert simulate(world, posed, long) < 0.003
        if aside > 0.01:
            assert simulate(world, posed, replace(long, patch_radius=0.0)) > 0.01, "between points it does"


def test_spinning_friction_is_that_of_a_soft_finger():
    assert SEARCH.spinning_friction == pytest.approx(SEARCH.friction * SEARCH.patch_radius / 3.0)
    combined = 2.0 * SEARCH.friction * SEARCH.spinning_friction  # as Bullet combines two bodies
    assert combined == pytest.approx(2.0 / 3.0 * SEARCH.patch_radius * SEARCH.contact_friction)
    assert SD_OBMAN.spinning_friction == SD_SEED.spinning_friction == 0.0
