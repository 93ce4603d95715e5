"""The collision term: its fields, its unit, and that it drives apart what is in each other."""

import numpy as np
import pytest

from tests.tracker.terms.test_colliding_parts import bent
from tests.tracker.toys import tube
from tracker.geometry import se3
from tracker.model.default_hand import default_hand
from tracker.model.scene import Scene
from tracker.solver.damped_step import compute_damped_step
from tracker.terms.colliding_parts import find_crossings
from tracker.terms.collision import REACH, WIDEST, Collision, compute_repulsion, measure_cone_depth
from tracker.terms.normal_equations import NormalEquations
from tracker.terms.penetration import find_swallowed, measure_penetration

RADIUS = 0.008


ELSEWHERE = se3.exp(np.array([0.4, -0.2, 0.7, 0.3, -0.8, 0.5]))


def two_tubes(shift=(0.02, 0.002, 0.006), turn=(0.1, 0.2, 0.7)) -> tuple[Scene, np.ndarray]:
    """Two bent tubes, in each other by some 8 mm unless told otherwise, away from the world's origin."""
    scene = Scene((tube(bones=2, rings=13, sides=12), tube(bones=2, rings=13, sides=12)))
    pose = scene.rest_pose()
    for where in scene.pose_slices:
        pose[where.start + 6 : where.stop] = 0.2
    pose[scene.pose_slices[0]][:6] = se3.log(ELSEWHERE)
    pose[scene.pose_slices[1]][:6] = se3.log(ELSEWHERE @ se3.exp(np.array([*shift, *turn])))
    return scene, pose


def take_step(scene: Scene, pose: np.ndarray) -> np.ndarray:
    """The pose after one step of the term alone, held back a little in what it says nothing about."""
    posed = scene.pose_at(pose)
    equations = NormalEquations.at(posed)
    Collision().find(posed).add_to(equations)
    JtJ, Jtr = equations.assemble()
    JtJ += 1e-3 * np.trace(JtJ) / len(JtJ) * np.eye(len(JtJ))
    return scene.retract(pose, compute_damped_step(JtJ, Jtr, 1e-3, np.full(scene.num_dofs, 0.2)))


def push_apart(scene: Scene, pose: np.ndarray, most: int) -> tuple[np.ndarray, int]:
    """Steps of the collision term alone until nothing crosses, and how many it took."""
    for step in range(most):
        if len(find_crossings(scene.pose_at(pose)).pairs) == 0:
            return pose, step
        pose = take_step(scene, pose)
    return pose, most


def field_of(triangle: np.ndarray, vertex: np.ndarray, sigma: float) -> float:
    """√Ψ, mm, by [T16] Eq. 9-11, ended where the term ends it: triangle (3, 3) and vertex (3,) in mm."""
    a, b, c = triangle
    normal = np.cross(b - a, c - a)
    normal /= np.linalg.norm(normal)
    sides = np.stack([2 * (b - a), 2 * (c - a), normal])
    center = np.linalg.solve(sides, [b @ b - a @ a, c @ c - a @ a, normal @ a])
    radius = np.linalg.norm(center - a)
    h = normal @ (vertex - center)
    if h >= sigma:
        return 0.0
    phi = np.linalg.norm(vertex - center - h * normal) / min(-radius / sigma * h + radius, WIDEST * radius)
    if phi >= 1 or np.linalg.norm(vertex - center) > REACH * radius:
        return 0.0
    if h <= -sigma:
        upsilon = -h + 1 - sigma
    else:
        upsilon = -(1 - 2 * sigma) / (4 * sigma**2) * h**2 - h / (2 * sigma) + (3 - 2 * sigma) / 4
    return (1 - phi) * upsilon


@pytest.mark.parametrize("sigma", [0.5, 0.2, 1.0])
def test_repulsion_is_the_capped_sum_of_the_fields_of_the_paper(sigma):
    scene, pose = two_tubes()
    posed = scene.pose_at(pose)
    faces, pairs = scene.arrays.faces, find_crossings(posed).pairs
    ids, push = compute_repulsion(posed.vertices, posed.normals, faces, pairs, sigma, 1000.0)
    sums, strongest = np.zeros(len(posed.vertices)), np.zeros(len(posed.vertices))
    for pair in pairs:
        for receiver, intruder in (pair, pair[::-1]):
            triangle = 1000.0 * posed.vertices[faces[receiver]]
            normal = np.cross(triangle[1] - triangle[0], triangle[2] - triangle[0])
            normal /= np.linalg.norm(normal)
            for v in faces[intruder]:
                cosine = max(-normal @ posed.normals[v], 0.0)
                depth = field_of(triangle, 1000.0 * posed.vertices[v], sigma)
                sums[v] += depth**2 * cosine
                strongest[v] = max(strongest[v], depth * cosine)
    assert len(ids) > 10
    np.testing.assert_array_equal(ids, np.flatnonzero(sums > 0))
    np.testing.assert_allclose(push, np.minimum(sums, strongest)[ids], rtol=1e-6, atol=1e-9)


@pytest.mark.parametrize("sigma", [0.5, 0.2, 1.0])
def test_a_field_is_continuous_grows_with_the_depth_and_ends_at_the_apex(sigma):
    heights = np.linspace(sigma + 2.0, -8.0, 4001)
    depths = np.array([measure_cone_depth(h, 0.3, 3.0, sigma) for h in heights])
    assert np.all(depths[heights >= sigma] == 0.0)
    assert np.all(np.diff(depths) >= 0.0)
    assert np.abs(np.diff(depths)).max() < 0.1
    assert measure_cone_depth(-6.0, 0.0, 3.0, sigma) == pytest.approx(7.0 - sigma)


def test_repulsion_is_the_same_whatever_the_unit_of_the_scene():
    scene, pose = two_tubes()
    posed = scene.pose_at(pose)
    faces, pairs = scene.arrays.faces, find_crossings(posed).pairs
    metres = compute_repulsion(posed.vertices, posed.normals, faces, pairs, 0.5, 1000.0)
    millimetres = compute_repulsion(1000.0 * posed.vertices, posed.normals, faces, pairs, 0.5, 1.0)
    np.testing.assert_array_equal(metres[0], millimetres[0])
    np.testing.assert_allclose(metres[1], millimetres[1], rtol=1e-9)


def test_repulsion_measures_the_depth():
    """Deeper means a stronger push: in metres the cones of the paper would push 0.5 to 0.51 whatever the depth."""
    pushes = []
    for depth in (0.0005, 0.001, 0.002, 0.004):
        scene = Scene((tube(bones=1, sides=16), tube(bones=1, sides=16)))
        pose = scene.rest_pose()
        pose[6:9] = [0.0013, 0.0, 2 * RADIUS - depth]
        posed = scene.pose_at(pose)
        block = Collision().find(posed).linearize(posed)
        pushes.append(block.residual.max())
        assert 0.2 < block.residual.max() <= 1000.0 * depth + 0.5 + 1e-9
    assert np.all(np.diff(pushes) > 0.0)
    assert pushes[-1] > 2.0


def test_separated_scenes_have_no_residual():
    scene, pose = two_tubes(shift=(0.0, 0.0, 0.04))
    posed = scene.pose_at(pose)
    residual = Collision().find(posed)
    assert residual.count == 0
    assert residual.linearize(posed).jacobian.shape == (0, scene.num_dofs)
    hand = Scene((default_hand("left"),))
    assert Collision().find(hand.pose_at(hand.rest_pose())).count == 0


def test_jacobian_agrees_with_finite_differences():
    scene, pose = two_tubes()
    posed = scene.pose_at(pose)
    residual = Collision().find(posed)
    assert residual.count > 10
    block, step = residual.linearize(posed), 1e-6
    for dof in range(scene.num_dofs):
        delta = np.zeros(scene.num_dofs)
        delta[dof] = step
        ahead = residual.linearize(scene.pose_at(scene.retract(pose, delta))).residual
        behind = residual.linearize(scene.pose_at(scene.retract(pose, -delta))).residual
        np.testing.assert_allclose(block.jacobian[:, dof], (ahead - behind) / (2 * step), atol=1e-4)


def test_fast_sum_equals_plain_jacobian():
    scene, pose = two_tubes()
    posed = scene.pose_at(pose)
    residual = Collision().find(posed)
    block = residual.linearize(posed)
    equations = NormalEquations.at(posed)
    residual.add_to(equations)
    JtJ, Jtr = equations.assemble()
    weighted = block.jacobian * block.weights[:, None]
    np.testing.assert_allclose(JtJ, weighted.T @ block.jacobian, rtol=1e-9, atol=1e-6)
    np.testing.assert_allclose(Jtr, weighted.T @ block.residual, rtol=1e-9, atol=1e-6)
    assert equations.cost == pytest.approx(block.cost, rel=1e-9)


def test_one_step_lowers_its_own_cost():
    scene, pose = two_tubes()
    posed, after = scene.pose_at(pose), scene.pose_at(take_step(scene, pose))
    residual = Collision().find(posed)
    before = residual.linearize(posed).cost
    assert residual.linearize(after).cost < 0.5 * before  # the same correspondences
    assert Collision().find(after).linearize(after).cost < 0.5 * before  # new ones
    assert measure_penetration(after) < 0.5 * measure_penetration(posed)


@pytest.mark.parametrize("seed", range(5))
def test_tubes_in_each_other_are_driven_apart_and_no_farther_than_needed(seed):
    rng = np.random.default_rng(seed)
    scene = Scene((tube(bones=1, rings=15, sides=20), tube(bones=1, rings=15, sides=20)))
    middle = np.r_[0.015, np.zeros(5)]
    shift = np.r_[rng.uniform(-0.005, 0.005, size=2), rng.uniform(0.006, 0.013), rng.normal(scale=0.5, size=3)]
    pose = scene.rest_pose()
    pose[6:12] = se3.log(se3.exp(middle) @ se3.exp(shift) @ se3.exp(-middle))
    assert measure_penetration(scene.pose_at(pose)) > 0.001
    apart, steps = push_apart(scene, pose, most=10)
    assert len(find_crossings(scene.pose_at(apart)).pairs) == 0
    assert steps <= 5
    first, second = (scene.pose_at(apart).vertices[where] for where in scene.vertex_slices)
    assert np.linalg.norm(first[:, None] - second[None], axis=2).min() < 0.004  # with vertices 2.5 mm apart


def test_a_finger_is_driven_out_of_its_neighbour():
    scene = Scene((default_hand("right"),))
    pose = bent(scene, ("index_proximal", 1, -0.36))
    assert measure_penetration(scene.pose_at(pose)) > 0.001
    apart, _ = push_apart(scene, pose, most=10)
    assert len(find_crossings(scene.pose_at(apart)).pairs) == 0
    assert np.abs(apart[6:] - pose[6:]).max() < 0.35


def test_a_body_that_is_wholly_inside_another_is_pushed_to_the_near_side():
    scene = Scene((tube(bones=1, sides=32), tube(bones=1, sides=16, radius=0.002, length=0.006)))
    pose = scene.rest_pose()
    pose[6:9] = [0.012, 0.0, 0.004]
    posed = scene.pose_at(pose)
    assert len(find_crossings(posed).pairs) == 0
    assert len(find_swallowed(posed, find_crossings(posed)).ids) > 20
    equations = NormalEquations.at(posed)
    Collision().find(posed).add_to(equations)
    step = compute_damped_step(*equations.assemble(), 0.01, np.full(scene.num_dofs, 0.2))
    assert step[8] - step[2] > 0.002  # m, to +z, where the surface is nearest


def test_degenerate_triangles_have_no_field(rng):
    vertices = rng.normal(scale=0.003, size=(6, 3))
    vertices[2] = 0.5 * (vertices[0] + vertices[1])
    normals = np.tile([[0.0, 0.0, 1.0]], (6, 1))
    faces = np.array([[0, 1, 2], [3, 4, 5]], dtype=np.int32)
    ids, push = compute_repulsion(vertices, normals, faces, np.array([[0, 1]], dtype=np.int32), 0.5, 1000.0)
    assert set(ids) <= {0, 1, 2}
    assert np.isfinite(push).all()


def test_rows_carry_the_weight_once_each():
    scene, pose = two_tubes()
    residual = Collision(weight=3.0).find(scene.pose_at(pose))
    assert len(np.unique(residual.ids[:, 0])) == residual.count
    np.testing.assert_array_equal(residual.weights, 3.0)
