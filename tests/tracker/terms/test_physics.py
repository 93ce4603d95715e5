"""Eq. 16: exact derivatives, the fast sum equal to the plain one, and fingers that come into contact."""

import numpy as np
import pytest

from tests.tracker.grips import PINCH, gripped
from tracker.physics import Contact, PhysicsWorld, find_support
from tracker.physics.closest_points import find_closest_point
from tracker.solver.damped_step import compute_damped_step
from tracker.terms.normal_equations import NormalEquations
from tracker.terms.physics import Physics

CONTACTS = (Contact(0, "thumb_distal", 1), Contact(0, "index_distal", 1))
TERM = Physics(CONTACTS)


def apart(gap=0.005):
    start = gripped(([1, 0.1, 0.2], [-1, 0.2, 0.1]), (gap, gap))
    pose = start.pose.copy()
    pose[3:6] += [0.005, -0.008, 0.01]
    turn = np.zeros(start.scene.num_dofs)
    turn[start.scene.pose_slices[1].start + 3 :] = [0.3, -0.2, 0.4]
    return start.scene.pose_at(start.scene.retract(pose, turn))


def test_jacobian_agrees_with_finite_differences():
    posed = apart()
    scene, residual = posed.scene, TERM.find(posed)
    assert residual.count == 2
    block, step = residual.linearize(posed), 1e-6
    for dof in range(scene.num_dofs):
        delta = step * np.eye(scene.num_dofs)[dof]
        ahead = residual.linearize(scene.pose_at(scene.retract(posed.pose, delta))).residual
        behind = residual.linearize(scene.pose_at(scene.retract(posed.pose, -delta))).residual
        np.testing.assert_allclose(block.jacobian[:, dof], (ahead - behind) / (2 * step), atol=1e-4)


def test_fast_sum_equals_plain_jacobian():
    posed = apart()
    residual = TERM.find(posed)
    block, equations = residual.linearize(posed), NormalEquations.at(posed)
    residual.add_to(equations)
    JtJ, Jtr = equations.assemble()
    weighted = block.jacobian * block.weights[:, None]
    np.testing.assert_allclose(JtJ, weighted.T @ block.jacobian, rtol=1e-9, atol=1e-6)
    np.testing.assert_allclose(Jtr, weighted.T @ block.residual, rtol=1e-9, atol=1e-6)
    assert equations.cost == pytest.approx(block.cost, rel=1e-9)
    assert equations.count == residual.count


def test_one_step_lowers_its_own_cost():
    posed = apart()
    scene, residual = posed.scene, TERM.find(posed)
    equations = NormalEquations.at(posed)
    residual.add_to(equations)
    JtJ, Jtr = equations.assemble()
    stiff = JtJ + 1e-2 * np.diag(JtJ).max() * np.eye(len(JtJ))  # no turning of what hardly matters
    step = compute_damped_step(stiff, Jtr, 1e-3, np.full(scene.num_dofs, 0.2))
    after = residual.linearize(scene.pose_at(scene.retract(posed.pose, step)))
    assert after.cost < residual.linearize(posed).cost


def test_the_hand_moves_and_the_object_does_not():
    posed = apart()
    where = posed.scene.pose_slices[1]
    assert not Physics(CONTACTS).find(posed).linearize(posed).jacobian[:, where].any()


def test_parts_in_contact_and_no_contacts_ask_for_nothing():
    sunken = gripped(PINCH, (-0.002, -0.002))
    assert TERM.find(sunken).count == 0
    assert Physics(CONTACTS, draws_out=True).find(sunken).count == 2
    posed = apart()
    block = Physics(()).find(posed).linearize(posed)
    assert block.residual.shape == (0,) and block.jacobian.shape == (0, posed.scene.num_dofs)


def test_support_found_and_term_together_bring_parts_5_mm_away_into_contact():
    posed = gripped(PINCH, (0.005, 0.005))
    scene = posed.scene
    with PhysicsWorld(scene) as world:
        support = find_support(world, posed)
        assert len(support.contacts) == 2
        term = Physics(support.contacts)
        before = [find_closest_point(posed, c.hand, c.part, c.object).distance for c in support.contacts]
        for _ in range(10):
            residual, equations = term.find(posed), NormalEquations.at(posed)
            residual.add_to(equations)
            JtJ, Jtr = equations.assemble()
            step = compute_damped_step(JtJ + 1e-3 * np.eye(len(JtJ)), Jtr, 1e-3, np.full(scene.num_dofs, 0.2))
            posed = scene.pose_at(scene.retract(posed.pose, step))
        after = [find_closest_point(posed, c.hand, c.part, c.object).distance for c in support.contacts]
        assert min(before) > 0.004 and max(after) < 0.0003
        assert find_support(world, posed).is_stable


def test_sunken_parts_come_back_to_the_surface_where_they_are_to_be_drawn_out():
    posed = gripped(PINCH, (-0.003, -0.002))
    scene, term = posed.scene, Physics(CONTACTS, draws_out=True)
    for _ in range(10):
        residual, equations = term.find(posed), NormalEquations.at(posed)
        residual.add_to(equations)
        JtJ, Jtr = equations.assemble()
        step = compute_damped_step(JtJ + 1e-3 * np.eye(len(JtJ)), Jtr, 1e-3, np.full(scene.num_dofs, 0.2))
        posed = scene.pose_at(scene.retract(posed.pose, step))
    after = [find_closest_point(posed, c.hand, c.part, c.object).distance for c in CONTACTS]
    assert np.abs(after).max() < 0.0005
