"""Hands that are gone from their place: follow the rest of the scene without them, and look for them."""

from __future__ import annotations

from dataclasses import dataclass

from tracker.fitting.attempt import Attempt
from tracker.fitting.quality import Quality
from tracker.fitting.setup import TrackSetup
from tracker.fitting.sighting import Sightings
from tracker.search.find_again import find_again, find_seen
from tracker.search.part import Part
from tracker.search.tools import Tools
from tracker.tracking.follow_part import SCORE_DROP, SCORE_GAIN, follow_part
from tracker.tracking.patience import Patience
from tracker.tracking.state import TrackState

DOUBTFUL = 0.25
"""With this share of hand pixels unexplained the whole image is searched, now and then."""

LEAST_REST, LONGEST_REST = 15, 120
"""Frames to wait after the image was searched in vain: the first time, and at most."""


@dataclass(frozen=True)
class Recovery:
    """What became of a frame in which a hand was gone.

    Attributes:
        attempt: At the scene.
        gone: Hands that are still gone.
        found: Hands that were found again.
        image: When the whole image may be searched again.
    """

    attempt: Attempt | None
    gone: tuple[int, ...]
    found: tuple[int, ...]
    image: Patience


def recover_hands(
    sightings: Sightings, setup: TrackSetup, tools: Tools, state: TrackState, attempt: Attempt | None, recover: bool
) -> Recovery:
    """Look for the hands that are gone, where the detector sees them or else in the depth image.

    Args:
        sightings: The frame, and what the detector sees in it.
        setup: Models and options.
        tools: Of the run.
        state: After the frame before.
        attempt: At what was followed; None where nothing was.
        recover: Whether to look for hands at all.
    """
    image = state.image.pass_frame()
    gone = setup.hands if attempt is None else tuple(sorted({*state.gone_hands(setup), *attempt.gone}))
    if attempt is not None and not gone:
        may_search = recover and not sightings.is_looked_at and image.is_over
        if may_search and _is_doubtful(attempt.quality, state):
            return _look_elsewhere(sightings, setup, tools, state, attempt)
        return Recovery(attempt, (), (), image)
    if attempt is not None and attempt.gone:  # a hand that is not there has pulled at the others
        attempt = follow_part(sightings, Part.without(setup, gone), tools, state).attempt
        gone = setup.hands if attempt is None else tuple(sorted({*gone, *attempt.gone}))
    if not recover:
        return Recovery(attempt, gone, (), image)
    pose = state.pose if attempt is None else attempt.pose
    found = find_seen(sightings, setup, tools, pose, gone)
    if found is None and not all(setup.names[hand] in sightings.hands for hand in gone):
        found = find_again(sightings, setup, tools, pose, gone, state.next_frame)
    if found is None:
        return Recovery(attempt, gone, (), image)
    return Recovery(found[0], found[1], tuple(hand for hand in gone if hand not in found[1]), image)


def _look_elsewhere(
    sightings: Sightings, setup: TrackSetup, tools: Tools, state: TrackState, attempt: Attempt
) -> Recovery:
    """Search the image for a hand that may well be elsewhere."""
    found = find_again(sightings, setup, tools, attempt.pose, (attempt.worst,), state.next_frame)
    is_better = found is not None and not found[1] and found[0].worth > attempt.worth + SCORE_GAIN
    image = state.image.after_search(is_better, LEAST_REST, LONGEST_REST)
    if found is None or not is_better:
        return Recovery(attempt, (), (), image)
    return Recovery(found[0], (), (attempt.worst,), image)


def _is_doubtful(quality: Quality, state: TrackState) -> bool:
    """Whether the hand may well be elsewhere: worse than it was, or much is left unexplained."""
    return quality.is_lost or quality.score < state.score - SCORE_DROP or quality.explained < 1.0 - DOUBTFUL
