"""Fit what is followed of a scene to the next frame, and try again where that leaves something."""

from __future__ import annotations

from dataclasses import dataclass, replace
from time import perf_counter

from tracker.fitting.attempt import MIN_PIXELS, UNSETTLED, Attempt, try_again
from tracker.fitting.objective import Objective
from tracker.fitting.sighting import Sightings
from tracker.observation import Observation
from tracker.search.part import Part
from tracker.search.seen_hands import find_doubtful, try_where_seen
from tracker.search.shown_tips import reach_shown_tips
from tracker.search.tools import Tools
from tracker.tracking.hold import hold_object
from tracker.tracking.part_fits import PartFits
from tracker.tracking.patience import Patience
from tracker.tracking.state import TrackState

UNEXPLAINED = 0.15
"""So large a share of hand pixels that no model explains calls for a second try: a finger may hide in the palm."""

WORTH_GAIN = 0.02
"""A search was worth it if it raised the worth by this."""

FINGER_REST, TIP_REST, SEEN_REST = (4, 64), (2, 16), (2, 8)
"""Frames to wait after a second try that failed, the first time and at most: after a search of fingers in the depth
image, after a finger was moved to a visible tip, and after fits from detected joints, which a lost hand does not wait
for. Meanwhile these joints are in the first fit: on `d405_take001` a frame takes half the time."""

SEEN_ITERATIONS = 1.5
"""Fits from the detector's joints take this many times the iterations of others: they start farther off."""

SETTLED = 2e-4
"""They stop when the mean joint moves less, m; [T16] §4.1.1."""


@dataclass(frozen=True)
class Followed:
    """A part of the scene in a frame.

    Attributes:
        attempt: At the whole scene, what is not of the part where it was; None where nothing of it is in sight.
        second_try: When there may be another.
        tips: When a finger may be taken to a tip again.
        stages: Seconds by stage.
    """

    attempt: Attempt | None
    second_try: Patience
    tips: Patience
    stages: dict[str, float]


def follow_part(sightings: Sightings, part: Part, tools: Tools, state: TrackState) -> Followed:
    """Fit a part of the scene from the predicted pose, and try again if that left something unexplained."""
    second_try, tips = state.second_try.pass_frame(), state.tips.pass_frame()
    nothing = Followed(None, second_try, tips, {})
    if not part.kept:
        return nothing
    fits, started = PartFits(sightings, part, tools, state), perf_counter()
    predicted = fits.predict()
    seen = fits.look(predicted, MIN_PIXELS if part.setup.hands else 0)
    stages = {"observing": perf_counter() - started}
    if seen is None:
        return replace(nothing, stages=stages)
    usual = fits.usual_objective(seen)
    objective = fits.own_objective(usual)
    helped = objective if second_try.is_over else fits.lead(objective)
    best = fits.fit(seen, predicted, helped, fits.options)
    stages |= best.fit.stages
    seen, best = fits.look_wider(seen, best, helped, fits.options)
    if best.qualities:
        started = perf_counter()
        best, second_try = _try_where_seen(fits, best, objective if fits.is_first else usual, second_try)
        best, tips = _try_shown_tips(fits, seen, best, usual, tips)
        seen, best, second_try = _try_fingers(fits, seen, best, objective, second_try)
        stages["second try"] = perf_counter() - started
        if tools.world is not None and part.setup is part.whole:
            started = perf_counter()
            best = hold_object(part.setup, tools, seen, objective, state, best, fits.options)
            stages["physics"] = perf_counter() - started
    return Followed(part.widen(best, state.pose), second_try, tips, stages)


def _try_where_seen(
    fits: PartFits, best: Attempt, objective: Objective, second_try: Patience
) -> tuple[Attempt, Patience]:
    """Fits from the joints that the hand detector saw."""
    if not fits.sightings.is_looked_at or not (fits.is_first or second_try.is_over or best.lost):
        return best, second_try
    iterations = round(SEEN_ITERATIONS * fits.setup.options.iterations)
    again = replace(fits.options, iterations=iterations, stop_below=SETTLED)
    best = try_where_seen(fits.setup, fits.sightings, best, objective, again)
    return best, second_try.after_search(not find_doubtful(best), *SEEN_REST)


def _try_shown_tips(
    fits: PartFits, seen: Observation, best: Attempt, objective: Objective, tips: Patience
) -> tuple[Attempt, Patience]:
    """Fingers taken to tips that show beyond a thing."""
    if not fits.sightings.tells_color or not tips.is_over:
        return best, tips
    reached = reach_shown_tips(fits.setup, seen, best, objective, fits.options, fits.sightings)
    return reached or best, tips.after_search(reached is None or reached is not best, *TIP_REST)


def _try_fingers(
    fits: PartFits, seen: Observation, best: Attempt, objective: Objective, second_try: Patience
) -> tuple[Observation, Attempt, Patience]:
    """Other places of fingers in the depth image.

    What nobody explains may be of a hand that is left out of the part. Where the detector looks it tells where fingers
    are: on `uvr_cube_white` a search besides found nothing and took half a second.
    """
    if fits.sightings.is_looked_at:
        return seen, best, second_try
    is_whole = fits.setup is fits.part.whole
    is_unsettled = is_whole and (best.quality.explained < 1.0 - UNEXPLAINED or best.misfit > UNSETTLED)
    starts = [best.pose] if is_unsettled and second_try.is_over else []
    if best.lost if is_whole else best.gone:
        starts = [fits.previous, best.pose]
    if not starts:
        return seen, best, second_try
    again = replace(fits.options, iterations=fits.setup.options.iterations)
    first, guided = best, fits.tools.with_fingertips(seen)
    for start in starts:
        other = try_again(fits.setup, seen, start, objective, guided, again, fits.sightings)
        best = max((best, other), key=lambda attempt: attempt.worth)
        if best.misfit < UNSETTLED:
            break
    is_better = best.misfit < UNSETTLED or best.worth > first.worth + WORTH_GAIN
    return *fits.look_wider(seen, best, objective, again), second_try.after_search(is_better, *FINGER_REST)
