"""What looking at a track needs: names of parts in the order of the bones, a world where something is held."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.grips import ball
from tests.tracker.toys import tube
from tracker.fitting.options import TrackOptions
from tracker.fitting.setup import TrackSetup
from tracker.inspection.view_aids import ViewAids
from tracker.model.default_hand import default_hand
from tracker.model.joints import FINGERS

RIGHT, LEFT = default_hand("right"), default_hand("left")
ALL = TrackSetup(("ball", "right", "rope", "left"), (ball(), RIGHT, tube(4), LEFT), "cam0", TrackOptions())
HANDS = TrackSetup(("right", "left"), (RIGHT, LEFT), "cam0", TrackOptions())


def test_every_bone_of_the_scene_has_a_name_of_its_own_that_says_whose_it_is():
    names = ViewAids(ALL, np.eye(4)).part_names
    assert len(names) == len(set(names)) == sum(model.skeleton.num_bones for model in ALL.models)
    for name, where in zip(ALL.names, ALL.scene.bone_slices, strict=True):
        assert all(each.split()[0] == name for each in names[where])
    assert names[ALL.scene.bone_slices[0]] == ("ball",)
    assert names[ALL.scene.bone_slices[2]] == tuple(f"rope bone_{number}" for number in range(4))


@pytest.mark.parametrize("finger", FINGERS)
def test_the_skin_of_a_fingertip_is_called_by_its_finger_and_both_hands_alike(finger):
    right, left = (ViewAids(ALL, np.eye(4)).part_names[ALL.scene.bone_slices[index]] for index in (1, 3))
    assert [name.removeprefix("right") for name in right] == [name.removeprefix("left") for name in left]
    assert RIGHT.hand is not None
    tip = RIGHT.hand.fingertips[FINGERS.index(finger)]
    bone = int(np.bincount(RIGHT.skinning_weights[tip].argmax(axis=1)).argmax())
    assert right[bone] == f"right {finger} distal"


def test_there_is_a_world_where_there_are_hands_and_objects_whether_the_run_had_one_or_not():
    pytest.importorskip("pybullet")
    aids = ViewAids(replace(ALL, options=TrackOptions(terms="LO")), np.eye(4))
    assert aids.world is not None and aids.world is aids.world
    assert aids.tools.world is None and aids.tools is aids.tools
    aids.close()
    for setup in (HANDS, TrackSetup(("ball",), (ball(),), "cam0", TrackOptions())):
        alone = ViewAids(setup, np.eye(4))
        assert alone.world is None
        alone.close()


def test_tools_are_those_of_the_run_and_what_was_never_asked_for_is_closed_just_so():
    aids = ViewAids(replace(HANDS, options=TrackOptions(terms="LO+SC")), np.eye(4))
    assert aids.tools.detector is not None and "collision" in aids.tools.objective.terms
    aids.close()
    aids.close()
    ViewAids(ALL, np.eye(4)).close()
