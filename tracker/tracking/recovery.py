"""Hands that are gone from their place: follow the rest of the scene without them, and look for them."""

from __future__ import annotations

from dataclasses import dataclass

from tracker.fitting.attempt import Attempt
from tracker.fitting.setup import TrackSetup
from tracker.fitting.sighting import Sightings
from tracker.search.find_again import find_again, find_seen
from tracker.search.part import Part
from tracker.search.tools import Tools
from tracker.tracking.follow_part import follow_part
from tracker.tracking.state import TrackState


@dataclass(frozen=True)
class Recovery:
    """What became of a frame in which a hand was gone.

    Attributes:
        attempt: At the scene.
        gone: Hands that are still gone.
        found: Hands that were found again.
    """

    attempt: Attempt | None
    gone: tuple[int, ...]
    found: tuple[int, ...]


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
    gone = setup.hands if attempt is None else tuple(sorted({*state.gone_hands(setup), *attempt.gone}))
    if attempt is not None and not gone:
        return Recovery(attempt, (), ())
    if attempt is not None and attempt.gone:  # a hand that is not there has pulled at the others
        attempt = follow_part(sightings, Part.without(setup, gone), tools, state).attempt
        gone = setup.hands if attempt is None else tuple(sorted({*gone, *attempt.gone}))
    if not recover:
        return Recovery(attempt, gone, ())
    pose = state.pose if attempt is None else attempt.pose
    found = find_seen(sightings, setup, tools, pose, gone)
    if found is None and not all(setup.names[hand] in sightings.hands for hand in gone):
        found = find_again(sightings, setup, tools, pose, gone, state.next_frame)
    if found is None:
        return Recovery(attempt, gone, ())
    return Recovery(found[0], found[1], tuple(hand for hand in gone if hand not in found[1]))
