"""The kernels that all models share, against NumPy written as the equations are."""

import numpy as np

from tests.tracker.random_blend import random_blend, random_pose
from tracker.model.pose_blend import join_pose_blends, stack_pose_blend
from tracker.model.skinning import add_pose_blend, blend_motions, shift_bones, skin_into, take_back

MODEL = random_blend()
POSED = MODEL.pose_at(*random_pose(MODEL))


def plain_features() -> np.ndarray:
    """(16, 9) of R against the parent's, less the identity; the root's are not used."""
    R = POSED.Ts[:, :, :3]
    return (R[MODEL.parents].transpose(0, 2, 1) @ R - np.eye(3)).reshape(-1, 9)


def test_pose_blend_shapes_are_sums_over_the_bones_rotations_also_where_vertices_have_different_bones():
    rng = np.random.default_rng(0)
    directions = rng.normal(size=(40, 3, 5, 9)) * (rng.random((40, 1, 5, 1)) < 0.4)
    bones, places = np.array([3, 1, 7, 15, 2]), rng.permutation(60)[:40]
    stacked = [stack_pose_blend(directions[s].reshape(-1, 3, 45), bones, places[s]) for s in (slice(25), slice(25, 40))]
    rest = np.zeros((60, 3))
    add_pose_blend(rest, POSED.Ts, MODEL.arrays.parents, join_pose_blends(stacked))
    expected = np.zeros((60, 3))
    expected[places] = np.einsum("vxbk,bk->vx", directions, plain_features()[bones])
    np.testing.assert_allclose(rest, expected, atol=1e-13)


def test_bones_that_move_a_vertex_by_next_to_nothing_are_left_out():
    directions = np.zeros((2, 3, 18))
    directions[0, 0, 3], directions[1, 0, 12] = 1e-3, 1e-6
    stacked = stack_pose_blend(directions, np.array([4, 5]), negligible=1e-5)
    assert stacked.starts.tolist() == [0, 1, 1] and stacked.bones.tolist() == [4]


def test_each_bone_carries_a_vertex_to_its_own_place_and_the_weights_mix_them():
    arrays = MODEL.arrays
    vertices, carried = np.empty((len(POSED.rest), 3)), np.zeros((*arrays.weights.shape, 3))
    skin_into(vertices, carried, POSED.rest, arrays, POSED.Ts)
    own = POSED.Ts[arrays.weight_bones]
    places = np.einsum("vwxy,vy->vwx", own[:, :, :, :3], POSED.rest) + own[:, :, :, 3]
    is_used = arrays.weights != 0.0
    np.testing.assert_allclose(carried[is_used], places[is_used], atol=1e-14)
    np.testing.assert_allclose(vertices, np.einsum("vw,vwx->vx", arrays.weights, places), atol=1e-14)


def test_posed_vertices_are_taken_back_to_where_they_were_at_rest():
    motions = blend_motions(MODEL.skinning_weights, POSED.Ts)
    np.testing.assert_allclose(
        np.einsum("vxy,vy->vx", motions[:, :, :3], POSED.rest) + motions[:, :, 3], POSED.vertices
    )
    np.testing.assert_allclose(take_back(motions, POSED.vertices), POSED.rest, atol=1e-12)


def test_joints_that_move_at_rest_shift_all_that_hangs_on_them():
    rng = np.random.default_rng(1)
    joints, parents = rng.normal(size=(16, 3, 4)), MODEL.parents
    shifts = shift_bones(POSED.Ts, MODEL.arrays.parents, joints)
    R = POSED.Ts[:, :, :3]
    for bone in range(16):
        expected, above = np.zeros((3, 4)), bone
        while above >= 0:
            before = R[parents[above]] if parents[above] >= 0 else np.eye(3)
            expected += (before - R[above]) @ joints[above]
            above = parents[above]
        np.testing.assert_allclose(shifts[bone], expected, atol=1e-12)
