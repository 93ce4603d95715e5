"""Twins move as the authors' files say."""

from __future__ import annotations

import numpy as np
import pytest

from tracker.errors import SequenceError
from tracker.model.joints import HAND_JOINTS
from tracker.model.t16_files import load_t16_motion
from tracker.synthesis.performance import render_moment
from tracker.synthesis.twin import load_t16_camera, load_twin

pytestmark = pytest.mark.shared_data


def test_joints_of_a_twin_are_the_bones_of_the_motion_file(shared_data):
    folder = shared_data / "ijcv16"
    twin = load_twin(folder, "09", 1500)
    names, Ts, _ = load_t16_motion(folder / "seq" / "09" / "Model_Hand_R.MOTION.gz")
    assert twin.num_moments == 138
    moment = render_moment(twin, 70)
    index_pip, little_mcp = HAND_JOINTS.index("index_pip"), HAND_JOINTS.index("little_mcp")
    np.testing.assert_allclose(moment.joints[0], Ts[70, names.index("Lower Arm R"), :3, 3], atol=1e-9)
    np.testing.assert_allclose(moment.joints[index_pip], Ts[70, names.index("RFing.3_1"), :3, 3], atol=1e-9)
    np.testing.assert_allclose(moment.joints[little_mcp], Ts[70, names.index("RFing.0_0"), :3, 3], atol=1e-9)
    assert (moment.face >= 0).sum() > 5000


def test_a_decimated_twin_shows_the_same_surface_as_the_full_mesh_within_a_millimetre(shared_data):
    folder = shared_data / "ijcv16"
    full, light = load_twin(folder, "09", None), load_twin(folder, "09", 1500)
    assert len(full.actors[0].model.faces) == 20000
    a, b = render_moment(full, 10), render_moment(light, 10)
    both = (a.face >= 0) & (b.face >= 0)
    assert np.median(np.abs(a.depth[both] - b.depth[both])) < 0.001
    np.testing.assert_allclose(a.joints, b.joints, atol=1e-9)


def test_a_twin_with_an_object_has_its_motion_and_no_joints_of_it(shared_data):
    twin = load_twin(shared_data / "ijcv16", "15", 1500)
    assert [actor.name for actor in twin.actors] == ["right", "ball"]
    assert len(twin.joint_names) == 21
    center = twin.objects[0].vertices(5).mean(axis=0)
    assert 0.3 < center[2] < 1.2


def test_an_articulated_object_has_a_joint_for_each_bone(shared_data):
    twin = load_twin(shared_data / "ijcv16", "18", 1500)
    rope = twin.objects[0]
    assert len(rope.joint_names) == 36
    assert rope.joint_names[0].startswith("pipe_green_long:")


def test_a_sequence_that_is_not_there_is_refused_with_those_that_are(shared_data):
    with pytest.raises(SequenceError, match="it has 01, 04, 09, 12, 15, 17, 18, 20"):
        load_twin(shared_data / "ijcv16", "99", 1500)


def test_a_camera_file_with_too_few_numbers_is_refused(tmp_path):
    path = tmp_path / "Cameras.txt"
    path.write_text("1 2 3")
    with pytest.raises(SequenceError, match="holds 3 numbers; needed 22"):
        load_t16_camera(path)
