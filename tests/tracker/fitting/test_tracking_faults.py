"""A recording that cannot be tracked is refused with a sentence for each reason, one that can with none."""

from __future__ import annotations

import pytest

from tracker.fitting.options import TERMS, TrackOptions
from tracker.fitting.tracking_faults import MAX_VIEWS, find_detector_faults, find_tracking_faults

MANY = [f"c{number}" for number in range(MAX_VIEWS + 1)]


def faults(options: TrackOptions, depth=("d0", "d1"), color=("c0", "c1"), hands=("right",), frames=10) -> list[str]:
    return find_tracking_faults(frames, hands, depth, color, options)


@pytest.mark.parametrize(
    ("options", "depth", "color"),
    [
        (TrackOptions(), ("d0",), ()),
        (TrackOptions(camera="d1"), ("d0", "d1"), ()),
        (TrackOptions(method="t16"), ("d0",), ()),
        (TrackOptions(use_detector=False), ("d0",), ("c0",)),
        (TrackOptions(), (), ("c0",)),
        (TrackOptions(), (), MANY[:MAX_VIEWS]),
        (TrackOptions(cameras="c0,c1"), ("d0",), ("c0", "c1")),
        (TrackOptions(cameras="c0,d0"), ("d0",), ("c0",)),
        (TrackOptions(first_frame=9, last_frame=9), ("d0",), ()),
    ],
)
def test_what_can_be_tracked_has_no_fault(options, depth, color):
    assert faults(options, depth, color) == []


@pytest.mark.parametrize(
    ("options", "depth", "color", "words"),
    [
        (TrackOptions(camera="c0"), ("d0", "d1"), ("c0",), "Camera c0 has no depth images. Choose d0 or d1."),
        (TrackOptions(), (), (), "None of its cameras has colour images"),
        (TrackOptions(cameras="c0"), ("d0",), (), "None of its cameras has colour images"),
        (TrackOptions(cameras="c9"), ("d0",), ("c0",), "c9 is no camera"),
        (TrackOptions(cameras="c8,c0,c9"), ("d0",), ("c0",), "c8 and c9 are no cameras"),
        (TrackOptions(cameras="d0"), ("d0",), ("c0",), "d0 has no colour images"),
        (TrackOptions(cameras="d0,d1"), ("d0", "d1"), ("c0",), "d0 and d1 have no colour images"),
        (TrackOptions(cameras="d0", use_depth=False), ("d0",), ("c0",), "d0 is no camera"),
        (TrackOptions(cameras="c0,c1,c0"), (), ("c0", "c1"), "chosen twice"),
        (TrackOptions(), (), MANY, "17 cameras are too many; at most 16"),
        (TrackOptions(use_detector=False), (), ("c0",), "Switch it on"),
        (TrackOptions(method="t16"), (), ("c0",), "needs one depth camera"),
        (TrackOptions(first_frame=10), ("d0",), (), "the recording has 0 to 9"),
        (TrackOptions(last_frame=10), ("d0",), (), "the recording has 0 to 9"),
    ],
)
def test_what_cannot_be_tracked_has_one_sentence_that_names_what_was_asked_for_and_what_there_is(
    options, depth, color, words
):
    (fault,) = faults(options, depth, color)
    assert words in fault and fault.endswith(".")


def test_every_reason_is_told_at_once():
    everything = TrackOptions(method="t16", use_detector=False, cameras=",".join((*MANY, "c0")), last_frame=99)
    told = faults(everything, (), MANY, hands=())
    assert len(told) == len(set(told)) == 6


def test_a_recording_without_hands_or_without_frames_is_refused():
    assert "right, left or both" in faults(TrackOptions(), hands=())[0]
    assert len(faults(TrackOptions(), frames=0)) == 1


@pytest.mark.parametrize("terms", TERMS)
def test_a_fingertip_detector_serves_the_runs_whose_terms_have_fingertips_and_no_other(terms):
    told = find_detector_faults("depth", "d0", (), TrackOptions(terms=terms))
    assert [terms in fault for fault in told] == ([] if "S" in terms else [True])


def test_a_fingertip_detector_needs_the_images_that_it_looks_at():
    with_tips = TrackOptions(terms="LO+S")
    assert find_detector_faults("depth", "d0", (), with_tips) == []
    assert find_detector_faults("color", "d0", ("d0",), with_tips) == []
    assert "no colour images" in find_detector_faults("color", "d0", ("c0",), with_tips)[0]
    for looks_at in ("depth", "color"):
        (fault,) = find_detector_faults(looks_at, None, ("c0",), with_tips)
        assert "only colour cameras" in fault


def test_a_nail_detector_serves_colour_views_and_no_depth_camera():
    with_tips = TrackOptions(terms="LO+S")
    assert find_detector_faults("color", None, ("c0",), with_tips, "nails") == []
    assert "a depth camera is tracked in" in find_detector_faults("color", "d0", ("d0",), with_tips, "nails")[0]
    assert "use no fingertips" in find_detector_faults("color", None, ("c0",), TrackOptions(terms="LO"), "nails")[0]
