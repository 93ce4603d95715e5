"""Only what may not touch collides: neighbours and folds of the skin do not."""

import numpy as np
import pytest

from tests.tracker.toys import tube
from tracker.geometry.triangles import do_triangles_cross
from tracker.model.default_hand import default_hand
from tracker.model.scene import Scene
from tracker.terms.colliding_parts import SAME_SKIN, find_crossings, find_parts


@pytest.fixture(scope="module")
def hand() -> Scene:
    return Scene((default_hand("right"),))


def bent(scene: Scene, *turns: tuple[str, int, float]) -> np.ndarray:
    """The rest pose with joint number `which` of a bone turned by an angle, rad."""
    skeleton, pose = scene.models[0].skeleton, scene.rest_pose()
    for bone, which, angle in turns:
        joints = np.flatnonzero(skeleton.dof_bones == skeleton.bone_names.index(bone))
        pose[6 + joints[which]] = angle
    return pose


@pytest.mark.parametrize("side", ["right", "left"])
def test_nothing_crosses_at_rest(side):
    scene = Scene((default_hand(side),))
    assert len(find_crossings(scene.pose_at(scene.rest_pose())).pairs) == 0
    allowed, parents = find_parts(scene).allowed.groups, scene.arrays.parents
    for bone in range(20):  # nothing was forbidden for touching at rest either
        for other in range(bone):
            assert allowed[bone, other] == (parents[bone] != other)


def test_a_joint_bent_by_90_degrees_does_not_collide(hand):
    skeleton = hand.models[0].skeleton
    hinges = [n for n in skeleton.bone_names if n.startswith(("index", "middle", "ring", "little"))]
    for name in hinges:
        if not name.endswith("metacarpal"):
            assert len(find_crossings(hand.pose_at(bent(hand, (name, 0, np.pi / 2)))).pairs) == 0, name
    for name in ("thumb_proximal", "thumb_distal"):
        limit = skeleton.upper[np.flatnonzero(skeleton.dof_bones == skeleton.bone_names.index(name))[0]]
        assert len(find_crossings(hand.pose_at(bent(hand, (name, 0, limit)))).pairs) == 0, name


def test_a_finger_leant_on_its_neighbour_collides_with_it_alone(hand):
    crossings = find_crossings(hand.pose_at(bent(hand, ("index_proximal", 1, -0.4))))
    names = hand.models[0].skeleton.bone_names
    fingers = {tuple(sorted(names[g].split("_")[0] for g in crossings.parts.tree.groups[p])) for p in crossings.pairs}
    assert fingers == {("index", "middle")}


def test_crossings_are_those_of_all_pairs_that_may_collide():
    scene = Scene((tube(bones=2, rings=7, sides=8), tube(bones=2, rings=7, sides=8)))
    pose = scene.rest_pose()
    pose[8 : 8 + 3] = [0.01, 0.004, 0.009]
    pose[6:8], pose[14:16] = [0.3, -0.5], [-0.4, 0.2]
    posed = scene.pose_at(pose)
    found = {frozenset(pair) for pair in find_crossings(posed).pairs.tolist()}
    faces, models = scene.arrays.faces, scene.face_models
    expected = {
        frozenset((f, g))
        for f in np.flatnonzero(models == 0)
        for g in np.flatnonzero(models == 1)
        if do_triangles_cross(posed.vertices, faces, f, g)
    }
    assert found == expected
    assert len(found) > 20


def test_more_crossings_than_there_was_room_for_are_all_found(monkeypatch):
    scene = Scene((tube(bones=1), tube(bones=1)))
    pose = scene.rest_pose()
    pose[6:9] = [0.0, 0.003, 0.009]
    posed = scene.pose_at(pose)
    before = find_crossings(posed).pairs
    monkeypatch.setattr("tracker.terms.colliding_parts.USUAL_PAIRS", 3)
    np.testing.assert_array_equal(find_crossings(posed).pairs, before)
    assert len(before) > 3


def test_parts_of_one_model_that_touch_at_rest_do_not_collide():
    """A tube whose far end has been put through its near end, on bones that are no neighbours."""
    model = tube(bones=4, rings=17)
    vertices = model.vertices.copy()
    far = vertices[:, 0] > 0.09
    vertices[far] = vertices[far] @ np.array([[0.0, 1, 0], [1, 0, 0], [0, 0, -1]]) + np.array([0.01, -0.105, 0.0])
    crossed = Scene((type(model)(**{**model.__dict__, "vertices": vertices}),))
    allowed = find_parts(crossed).allowed
    assert not allowed.groups[0, 3] and not allowed.groups[3, 0]
    assert find_parts(Scene((model,))).allowed.groups[0, 3]
    assert len(find_crossings(crossed.pose_at(crossed.rest_pose())).pairs) == 0


def test_two_models_that_stand_in_each_other_at_rest_still_collide():
    scene = Scene((tube(bones=2), tube(bones=2, radius=0.006)))
    pose = scene.rest_pose()
    pose[8 : 8 + 3] = [0.02, 0.003, 0.003]
    assert len(find_crossings(scene.pose_at(pose)).pairs) > 0


def test_triangles_near_a_part_along_the_skin_do_not_meet_it(hand):
    parts, names = find_parts(hand), hand.models[0].skeleton.bone_names
    faces, vertices, groups = hand.arrays.faces, hand.arrays.vertices, parts.tree.groups
    palm, finger = names.index("wrist"), names.index("index_proximal")
    on_finger = np.flatnonzero(groups == finger)
    of_palm = vertices[np.unique(faces[groups == palm])]
    gaps = np.linalg.norm(vertices[faces[on_finger]][:, :, None] - of_palm, axis=-1).min(axis=(1, 2))
    assert parts.allowed.groups[palm, finger]
    assert parts.allowed.triangles[on_finger[gaps > 1.5 * SAME_SKIN], palm].all()
    assert not parts.allowed.triangles[on_finger[gaps == 0.0], palm].any()
