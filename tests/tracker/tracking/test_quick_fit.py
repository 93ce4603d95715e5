"""A model fitted to a few marked joints knows about where the others are."""

import numpy as np
import pytest

from tracker.errors import TrackingError
from tracker.model.default_hand import default_hand
from tracker.model.scene import Scene
from tracker.tracking.quick_fit import find_hidden, fit_marked, view_track_hands
from tracker.tracking.track import join_chunks

FEW = [0, 5, 17, 4, 12, 20]
OTHERS = [joint for joint in range(21) if joint not in FEW]


def mark(recorded, frame, joints):
    truth = recorded.annotations.find(frame, "cam0", "right").points
    points = truth.copy()
    points[[joint for joint in range(21) if joint not in joints], 2] = 0
    return truth, points


@pytest.mark.parametrize(("with_depth", "limit_px"), [(True, 2.0), (False, 8.0)])
def test_six_joints_tell_the_other_fifteen(recorded, with_depth, limit_px):
    truth, points = mark(recorded, 6, FEW)
    frame = recorded.sequence.frame(6, "cam0") if with_depth else None
    fit = fit_marked(default_hand("right"), points, recorded.sequence.camera("cam0"), frame)
    assert np.linalg.norm(fit.joints - truth[:, :2], axis=1)[OTHERS].mean() < limit_px
    assert fit.uses_depth == with_depth


def test_marks_alone_are_met_to_the_pixel(recorded):
    truth, points = mark(recorded, 0, FEW)
    fit = fit_marked(default_hand("right"), points, recorded.sequence.camera("cam0"))
    assert np.linalg.norm(fit.joints - truth[:, :2], axis=1)[FEW].max() < 2.0


def test_three_joints_are_too_few(recorded):
    with pytest.raises(TrackingError, match=r"3 joints.*4 or more"):
        fit_marked(default_hand("right"), mark(recorded, 0, FEW[:3])[1], recorded.sequence.camera("cam0"))


def test_a_track_is_seen_as_its_joints_were_stored(recorded, run):
    setup, _, _, chunk = run
    track = join_chunks(recorded.sequence, setup, [chunk])
    view = view_track_hands(track, 4, recorded.sequence.camera("cam0"))["right"]
    assert np.allclose(view.joints, track.joints_2d[4, 0], atol=1e-6)


def test_what_lies_behind_the_palm_is_hidden(recorded):
    scene = Scene((default_hand("right"),))
    pose = scene.rest_pose()
    camera = recorded.sequence.camera("cam0")
    pose[:3] = camera.T_world_camera[:3, 3] + camera.T_world_camera[:3, 2] * 0.5
    posed = scene.pose_at(pose)
    middle = posed.vertices[scene.is_palm].mean(axis=0)
    away = camera.T_world_camera[:3, 2]
    assert find_hidden(posed, np.stack([middle - 0.1 * away, middle + 0.1 * away]), camera).tolist() == [False, True]
