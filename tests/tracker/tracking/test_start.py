"""A run begins where its first frame shows the hands, whatever else it is told, and says what it is doing."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from tests.tracker.grips import ball
from tracker.capture.annotations import Annotations
from tracker.capture.recorded_object import RecordedObject
from tracker.detection import OwnDetector
from tracker.detection.default_detector import default_detector
from tracker.errors import TrackingError
from tracker.fitting.options import TrackOptions
from tracker.fitting.setup import TrackSetup
from tracker.geometry import se3
from tracker.model.default_hand import default_hand
from tracker.tracking.start import MIN_MARKED, start_tracking
from tracker.tracking.state import TrackState

QUICK = TrackOptions(calibrate=False)


def marked(annotations: Annotations, joints: int) -> Annotations:
    """The marks of the first frame, of so many joints."""
    (item,) = (item for item in annotations.items if item.frame == 0)
    points = item.points.copy()
    points[joints:, 2] = 0
    return Annotations((replace(item, points=points),))


def right_error(recorded, setup: TrackSetup, state: TrackState) -> float:
    """Of the right hand's joints, m."""
    found = setup.scene.pose_at(state.pose).landmarks(setup.names.index("right"))
    return float(np.linalg.norm(found - recorded.truth.joints_3d[0], axis=1).mean())


@pytest.mark.parametrize("hands", [("right",), ("right", "left"), ("left", "right")])
def test_a_hand_that_the_first_frame_does_not_show_is_nowhere_and_takes_no_pixel_of_the_other(recorded, hands):
    setup, state = start_tracking(replace(recorded.sequence, hands=hands), QUICK)
    assert setup.names == hands
    assert right_error(recorded, setup, state) < 3e-3
    assert state.is_lost is (len(hands) > 1)
    for name, where in zip(setup.names, setup.scene.pose_slices, strict=True):
        assert np.any(state.pose[where]) == (name == "right")


@pytest.mark.parametrize(("joints", "counts"), [(MIN_MARKED - 1, False), (MIN_MARKED, True), (21, True)])
def test_marks_count_from_so_many_joints_on_and_fewer_are_as_none(recorded, joints, counts):
    setup, state = start_tracking(recorded.sequence, QUICK, annotations=marked(recorded.annotations, joints))
    assert set(setup.marks) == ({"right"} if counts else set())
    assert right_error(recorded, setup, state) < 4e-3
    if not counts:
        np.testing.assert_array_equal(state.pose, start_tracking(recorded.sequence, QUICK)[1].pose)


def test_a_run_may_begin_in_the_middle_and_starts_where_the_hand_is_then(recorded):
    options = replace(QUICK, first_frame=7)
    setup, state = start_tracking(recorded.sequence, options, annotations=marked(recorded.annotations, 21))
    assert state.next_frame == 7 and setup.marks == {}, "the marks of another frame are not looked at"
    joints = setup.scene.pose_at(state.pose).landmarks(0)
    assert np.linalg.norm(joints - recorded.truth.joints_3d[7], axis=1).mean() < 3e-3
    np.testing.assert_array_equal(state.earlier_pose, state.pose)


def test_hands_come_before_objects_and_what_is_given_takes_the_place_of_what_comes_along(recorded):
    T = se3.exp(np.array([0.2, 0.1, 0.6, 0.3, 0.0, 0.0]))
    sequence = replace(recorded.sequence, objects=(RecordedObject("ball", "nowhere.ply", T),))
    given = {"ball": ball(), "right": replace(default_hand("right"), name="mine")}
    options = replace(QUICK, static_scene="none")
    setup, state = start_tracking(sequence, options, given, marked(recorded.annotations, 21))
    assert setup.names == ("right", "ball")
    assert setup.models == (given["right"], given["ball"])
    np.testing.assert_allclose(se3.exp(state.pose[setup.scene.pose_slices[1]]), T, atol=1e-9)
    assert right_error(recorded, setup, state) < 3e-3


def test_who_waits_is_told_a_share_that_rises_and_may_end_it(recorded):
    told: list[tuple[str, float]] = []
    marks = marked(recorded.annotations, 21)
    start_tracking(recorded.sequence, QUICK, annotations=marks, progress=lambda *each: told.append(each))
    assert told[0] == ("placing the right hand", 0.0)
    assert all(0.0 <= earlier[1] <= later[1] <= 1.0 for earlier, later in pairwise([*told, ("end", 1.0)]))

    def stop(stage: str, share: float) -> None:
        raise TimeoutError

    with pytest.raises(TimeoutError):
        start_tracking(recorded.sequence, QUICK, annotations=marks, progress=stop)


def test_what_cannot_be_tracked_is_refused_with_the_name_of_what_is_at_fault(recorded):
    own = OwnDetector(default_detector(), "tips-of-mine", "0" * 64)
    with pytest.raises(TrackingError, match=r"tips-of-mine: The terms LO use no fingertips"):
        start_tracking(recorded.sequence, replace(QUICK, terms="LO"), detector=own)
    with pytest.raises(TrackingError, match=recorded.sequence.name):
        start_tracking(recorded.sequence, replace(QUICK, camera="nobody"))
    setup, _ = start_tracking(recorded.sequence, QUICK, annotations=marked(recorded.annotations, 21), detector=own)
    assert setup.own_detector is own
