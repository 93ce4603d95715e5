"""What the fits of a part to a frame share: where it should be, what is looked at, and which terms count."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.grips import ball
from tests.tracker.scenes import CAMERA, move_pose, palm_to_camera, photograph
from tracker.capture.frame import Frame
from tracker.fitting.attempt import attempt_fit
from tracker.fitting.frame_fit import FitOptions
from tracker.fitting.objective import Objective
from tracker.fitting.options import TrackOptions
from tracker.fitting.region import is_outgrown, region_around
from tracker.fitting.setup import TrackSetup
from tracker.fitting.sighting import COVERED, SEEN, Sighting, Sightings
from tracker.geometry import se3
from tracker.landmarks import DetectedHand
from tracker.model.default_hand import default_hand
from tracker.search.part import Part
from tracker.search.tools import Tools
from tracker.tracking.part_fits import PartFits
from tracker.tracking.state import TrackState

HAND = default_hand("right")
OPTIONS = TrackOptions(calibrate=False, first_frame=2, iterations=7, first_iterations=31, stop_below_mm=0.5)
MARKS = np.column_stack([np.full((21, 2), 50.0), np.full(21, 2.0)])
SETUP = TrackSetup(("ball", "right"), (ball(0.02), HAND), "cam0", OPTIONS, {"right": MARKS})
POSE = np.r_[0.13, 0.0, 0.45, 0.0, 0.0, 0.0, palm_to_camera(HAND, (0.0, 0.0, 0.45))]
FRAME = photograph(SETUP.scene, POSE)
NOTHING_SEEN = Sightings(FRAME, CAMERA, {}, is_looked_at=False)


def sight(frame: Frame = FRAME, covered: int = 0) -> Sightings:
    """The right hand as a detector sees it, with a thing before some of its joints."""
    hand = DetectedHand(CAMERA.project(SETUP.scene.pose_at(POSE).landmarks(1)), np.zeros((21, 3)), 1.0, 1.0)
    beliefs = np.where(np.arange(21) < covered, COVERED, SEEN)
    return Sightings(frame, CAMERA, {"right": Sighting(hand, beliefs)})


def fits(sightings: Sightings = NOTHING_SEEN, lost=(), setup: TrackSetup = SETUP, **state) -> PartFits:
    given = {"next_frame": 5, "pose": POSE, "earlier_pose": POSE, **state}
    return PartFits(sightings, Part.without(setup, lost), Tools(Objective(), None, None), TrackState(**given))


def test_the_first_frame_has_its_own_number_of_iterations_and_lengths_are_in_metres():
    assert fits(next_frame=2).is_first and fits(next_frame=2).options.iterations == 31
    assert not fits(next_frame=3).is_first and fits(next_frame=3).options.iterations == 7
    assert fits().options.stop_below == pytest.approx(0.0005)


@pytest.mark.parametrize(("threads", "alone", "beside"), [(1, 1, 1), (2, 2, 1), (8, 2, 1)])
def test_a_fit_has_a_second_thread_where_no_detector_needs_it(threads, alone, beside):
    setup = replace(SETUP, options=replace(OPTIONS, threads=threads))
    assert fits(setup=setup).options.threads == alone
    assert fits(sight(), setup=setup).options.threads == beside


@pytest.mark.parametrize("lost", [(), (0,), (1,)])
def test_a_part_goes_on_as_it_moved_last_and_just_as_it_does_in_the_whole(lost):
    step = se3.exp(np.array([0.01, 0.0, -0.02, 0.1, 0.05, 0.0]))
    earlier = move_pose(SETUP.scene, se3.inverse(step), POSE)
    part = fits(lost=lost, earlier_pose=earlier)
    expected = part.part.take(move_pose(SETUP.scene, step, POSE))
    one, other = (part.setup.scene.pose_at(pose).vertices for pose in (part.predict(), expected))
    np.testing.assert_allclose(one, other, atol=1e-9)
    whole = part.state.predict(SETUP.scene)
    np.testing.assert_allclose(part.predict(), part.part.take(whole), atol=1e-12)
    np.testing.assert_array_equal(part.previous, part.part.take(POSE))


def test_a_hand_that_rests_is_expected_where_it_is():
    np.testing.assert_allclose(fits().predict(), POSE, atol=1e-12)


def test_marks_count_in_the_first_frame_alone_and_detected_joints_also_where_a_thing_hides_the_hand():
    usual = Objective()
    names = set(usual.terms)

    def added(sightings: Sightings, frame: int, lost=()) -> set[str]:
        return set(fits(sightings, lost, next_frame=frame).own_objective(usual).terms) - names

    assert added(NOTHING_SEEN, 2) == {"marks_right"}
    assert added(sight(), 2) == {"marks_right", "joints_right"}
    assert added(sight(), 5) == added(sight(covered=2), 5) == set()
    assert added(sight(covered=3), 5) == {"joints_right"}
    assert added(sight(covered=3), 2, lost=(1,)) == set(), "a hand that is left out of the part has no joints in it"
    assert fits().own_objective(usual) is usual and set(usual.terms) == names


def test_a_fit_that_stays_in_what_was_looked_at_is_left_as_it_is():
    there = fits()
    seen = there.look(POSE)
    assert seen is not None
    best = there.fit(seen, POSE, Objective(), FitOptions(iterations=1))
    again, same = there.look_wider(seen, best, Objective(), FitOptions(iterations=1))
    assert again is seen and same is best


def test_a_fit_that_went_beyond_what_was_looked_at_is_made_again_around_where_it_went():
    there = fits()
    aside = move_pose(SETUP.scene, se3.exp(np.array([-0.07, 0.0, 0.0, 0.0, 0.0, 0.0])), POSE)
    seen = there.look(aside)
    assert seen is not None
    options = FitOptions(iterations=3)
    best = attempt_fit(SETUP, seen, POSE, POSE, Objective(), FitOptions(iterations=0))
    wider, again = there.look_wider(seen, best, Objective(), options)
    needed = region_around(SETUP.scene.pose_at(again.pose).vertices, CAMERA)
    assert needed is not None
    assert is_outgrown(seen.region, needed, CAMERA) and not is_outgrown(wider.region, needed, CAMERA)
    assert again is not best and again.quality.explained > 0.99 and not again.lost


def test_a_fit_that_left_the_image_keeps_what_was_seen_of_it():
    there = fits()
    seen = there.look(POSE)
    assert seen is not None
    away = move_pose(SETUP.scene, se3.exp(np.array([3.0, 0.0, 0.0, 0.0, 0.0, 0.0])), POSE)
    best = attempt_fit(SETUP, seen, away, away, Objective(), FitOptions(iterations=0))
    assert there.look_wider(seen, best, Objective(), FitOptions(iterations=1)) == (seen, best)
    assert there.look(away) is None
