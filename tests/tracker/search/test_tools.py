"""What a run's terms need besides the frame is made as its letters ask for it, and only then."""

from __future__ import annotations

import numpy as np
import pytest

from tests.tracker.grips import ball
from tests.tracker.scenes import drawn_hand
from tracker.detection.default_detector import default_detector
from tracker.fitting.objective import Objective
from tracker.fitting.options import TrackOptions
from tracker.fitting.setup import TrackSetup
from tracker.model.default_hand import default_hand
from tracker.search.tools import Tools, make_tools
from tracker.terms.salient import Salient

HAND = default_hand("right")
DEPTH_TERMS = set(Objective().terms)


def make_setup(terms: str, with_ball: bool = False, views: tuple[str, ...] = ()) -> TrackSetup:
    names, models = (("right", "ball"), (HAND, ball())) if with_ball else (("right",), (HAND,))
    return TrackSetup(names, models, "cam0", TrackOptions(terms=terms), view_ids=views)


@pytest.mark.parametrize("terms", ["LO", "LO+C", "LO+S", "LO+SC"])
def test_each_letter_brings_its_helper(terms: str) -> None:
    with make_tools(make_setup(terms), np.eye(4)) as tools:
        letters = terms.partition("+")[2]
        assert set(tools.objective.terms) == DEPTH_TERMS | ({"collision"} if "C" in letters else set())
        assert tools.detector is (default_detector() if "S" in letters else None)
        assert tools.world is None and tools.nail_detector is None


@pytest.mark.parametrize(
    ("terms", "with_ball", "has_world"), [("LO+P", True, True), ("LO+P", False, False), ("LO", True, False)]
)
def test_there_is_a_physics_world_only_with_its_letter_and_something_to_hold(terms, with_ball, has_world) -> None:
    with make_tools(make_setup(terms, with_ball), np.eye(4)) as tools:
        assert (tools.world is not None) == has_world


def test_in_colour_views_each_frame_brings_its_own_terms_and_nobody_looks_for_fingertips() -> None:
    with make_tools(make_setup("LO+SC", views=("a", "b")), np.eye(4)) as tools:
        assert set(tools.objective.terms) == {"collision"}
        assert tools.detector is None and tools.nail_detector is None, "nobody gave one for nails"


def test_fingertips_are_a_term_of_their_frame_beside_the_others() -> None:
    seen = drawn_hand().observation
    objective = Objective()
    found = Tools(objective, default_detector(), None).with_fingertips(seen)
    assert set(found.terms) == {*objective.terms, "salient"} and isinstance(found.terms["salient"], Salient)
    assert "salient" not in objective.terms, "the objective of the run stays as it is"
    assert {name: found.terms[name] for name in objective.terms} == objective.terms


def test_without_a_detector_the_objective_is_that_of_the_run() -> None:
    tools = Tools(Objective(), None, None)
    drawn = drawn_hand()
    assert tools.with_fingertips(drawn.observation) is tools.objective
    assert tools.with_nails(drawn.scene.pose_at(drawn.pose), [], 1) is tools.objective
