"""A part of a scene: taken out and put back nothing changes, whatever is missing."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest

from tests.tracker.grips import ball, cube
from tracker.fitting.attempt import Attempt
from tracker.fitting.frame_fit import Fit
from tracker.fitting.object_quality import ObjectQuality
from tracker.fitting.options import TrackOptions
from tracker.fitting.quality import Quality
from tracker.fitting.setup import TrackSetup
from tracker.model.default_hand import default_hand
from tracker.search.part import Part

WHOLE = TrackSetup(
    ("ball", "right", "cube", "left"),
    (ball(), default_hand("right"), cube(), default_hand("left")),
    "cam0",
    TrackOptions(),
    marks={"right": np.ones((21, 3))},
)
EVERY_LOSS = [lost for count in range(5) for lost in combinations(range(4), count)]


@pytest.fixture
def pose(rng) -> np.ndarray:
    return rng.normal(size=WHOLE.scene.num_dofs)


@pytest.mark.parametrize("lost", EVERY_LOSS)
def test_what_is_taken_and_put_back_is_the_pose_whatever_is_missing_and_in_whatever_order_it_is_told(pose, lost):
    part = Part.without(WHOLE, lost)
    assert part == Part.without(WHOLE, lost[::-1])
    np.testing.assert_array_equal(part.put(part.take(pose), pose), pose)
    own = np.arange(len(part.take(pose)), dtype=np.float64)
    before = pose.copy()
    np.testing.assert_array_equal(part.take(part.put(own, pose)), own)
    np.testing.assert_array_equal(pose, before)


@pytest.mark.parametrize("lost", EVERY_LOSS)
def test_a_part_and_what_it_lacks_share_the_pose_between_them(pose, lost):
    part, rest = Part.without(WHOLE, lost), Part(WHOLE, lost)
    assert len(part.take(pose)) + len(rest.take(pose)) == len(pose)
    other = -pose
    np.testing.assert_array_equal(rest.take(part.put(part.take(pose), other)), rest.take(other))


def test_models_keep_their_names_their_order_and_what_the_whole_has():
    setup = Part.without(WHOLE, (2, 0)).setup
    assert setup.names == ("right", "left") and setup.models == WHOLE.models[1::2]
    assert setup.hands == (0, 1) and setup.objects == ()
    assert setup.options is WHOLE.options and setup.marks is WHOLE.marks
    assert Part.without(WHOLE, ()).setup is WHOLE


def test_an_attempt_at_a_part_is_one_at_the_whole_with_everybody_under_their_own_number(pose):
    part = Part.without(WHOLE, (0, 1))
    of_hand = Quality(0.002, 0.9, 0.9, 0.9, 0.8, 0.9, 0.0, 0.0, 4e-3)
    of_thing = ObjectQuality.of_nothing()
    own = part.take(pose) + 1.0
    attempt = Attempt(own, {1: of_hand}, Fit(own, (), {}), {0: of_thing})
    wide = part.widen(attempt, pose)
    assert wide.qualities == {3: of_hand} and wide.objects == {2: of_thing}
    assert wide.fit is attempt.fit
    np.testing.assert_array_equal(part.take(wide.pose), own)
    kept = Part.without(WHOLE, (2, 3))
    np.testing.assert_array_equal(kept.take(wide.pose), kept.take(pose))
