"""Fit what is followed of a scene to the next frame, and try again where that leaves something."""

from __future__ import annotations

from dataclasses import dataclass, replace
from time import perf_counter

import numpy as np
import numpy.typing as npt

from tracker.fitting.attempt import MIN_PIXELS, UNSETTLED, Attempt, attempt_fit, look, try_again
from tracker.fitting.frame_fit import FitOptions
from tracker.fitting.objective import Objective
from tracker.fitting.region import is_outgrown, region_around
from tracker.fitting.sighting import Sightings
from tracker.observation import Observation
from tracker.search.part import Part
from tracker.search.seen_hands import find_doubtful, try_where_seen
from tracker.search.shown_tips import reach_shown_tips
from tracker.search.start_annotated import with_marks
from tracker.search.tools import Tools
from tracker.tracking.hold import hold_object
from tracker.tracking.patience import Patience
from tracker.tracking.state import TrackState

Array = npt.NDArray[np.float64]

SCORE_DROP = 0.10
"""A score this far below the running one calls for a second try."""

UNEXPLAINED = 0.15
"""So does this share of hand pixels that the model does not explain: a finger may be hidden in the palm."""

SCORE_GAIN = 0.02
"""A search was worth it if it raised the score by this."""

FINGER_REST, TIP_REST, SEEN_REST = (4, 64), (2, 16), (2, 8)
"""Frames to wait after a second try in vain, the first time and at most: after a search of fingers in the depth image,
after a finger was taken to a tip that shows, and after fits from detected joints, which a lost hand does not wait for.
Meanwhile these joints are in the first fit: on `d405_take001` a frame takes half the time."""

SEEN_ITERATIONS = 1.5
"""Fits from the detector's joints take so many times the iterations of others: they start farther off."""

SETTLED = 2e-4
"""They stop when the mean joint moves less, m; [T16] §4.1.1."""

WIDER = 3
"""So often at most the region follows a fit that went beyond it."""


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
    stages: dict[str, float] = {}
    second_try, tips = state.second_try.pass_frame(), state.tips.pass_frame()
    if not part.kept:
        return Followed(None, second_try, tips, stages)
    setup, previous = part.setup, part.take(state.pose)
    predicted = replace(state, pose=previous, earlier_pose=part.take(state.earlier_pose)).predict(setup.scene)
    started = perf_counter()
    seen = look(sightings.frame, sightings.camera, setup, predicted, MIN_PIXELS if setup.hands else 0)
    stages["observing"] = perf_counter() - started
    if seen is None:
        return Followed(None, second_try, tips, stages)
    is_first = state.next_frame == setup.options.first_frame
    options = FitOptions(
        iterations=setup.options.first_iterations if is_first else setup.options.iterations,
        stop_below=0.001 * setup.options.stop_below_mm,
        threads=min(setup.options.threads, 2),
    )
    every_frame = tools.objective if setup.own_detector is None else tools.with_fingertips(seen)
    objective = every_frame
    if sightings.is_covered or is_first:
        objective = sightings.add_to(objective, setup.scene, setup.names)
    if is_first:
        objective = with_marks(objective, setup.scene, setup.names, setup.marks, sightings.camera)
    helped = objective
    if not second_try.is_over:
        helped = sightings.add_to(objective, setup.scene, setup.names)
    best = attempt_fit(setup, seen, predicted, previous, helped, options, sightings)
    stages |= best.fit.stages
    seen, best = _look_wider(sightings, part, seen, best, previous, helped, options)
    if best.qualities:
        started = perf_counter()
        again = replace(options, iterations=round(SEEN_ITERATIONS * setup.options.iterations), stop_below=SETTLED)
        if sightings.is_looked_at and (is_first or second_try.is_over or best.lost):
            best = try_where_seen(setup, sightings, best, objective if is_first else every_frame, again)
            second_try = second_try.after_search(not find_doubtful(best), *SEEN_REST)
        if sightings.tells_color and tips.is_over:
            reached = reach_shown_tips(setup, seen, best, every_frame, options, sightings)
            tips = tips.after_search(reached is None or reached is not best, *TIP_REST)
            best = reached or best
        starts = _find_finger_starts(sightings, part, state, second_try, best)
        if starts:
            again = replace(options, iterations=setup.options.iterations)
            first, guided = best, tools.with_fingertips(seen)
            for start in starts:
                other = try_again(setup, seen, start, objective, guided, again, sightings)
                best = other if other.worth > best.worth else best
                if best.misfit < UNSETTLED:
                    break
            is_better = best.misfit < UNSETTLED or best.worth > first.worth + SCORE_GAIN
            second_try = second_try.after_search(is_better, *FINGER_REST)
            seen, best = _look_wider(sightings, part, seen, best, previous, objective, again)
        stages["second try"] = perf_counter() - started
        if tools.world is not None and setup is part.whole:
            started = perf_counter()
            best = hold_object(setup, tools, seen, objective, state, best, options)
            stages["physics"] = perf_counter() - started
    return Followed(part.widen(best, state.pose), second_try, tips, stages)


def _find_finger_starts(
    sightings: Sightings, part: Part, state: TrackState, second_try: Patience, best: Attempt
) -> tuple[Array, ...]:
    """Poses (d,) from which fingers are searched in the depth image; none where there is no need or it is no use.

    What nobody explains may be of a hand that is left out of the part. Where the detector looks it tells where fingers
    are: on `uvr_cube_white` a search besides found nothing and took half a second.
    """
    if sightings.is_looked_at:
        return ()
    is_whole = part.setup is part.whole
    is_falling = bool(best.lost if is_whole else best.gone) or best.quality.score < state.score - SCORE_DROP
    is_unsettled = is_whole and (best.quality.explained < 1.0 - UNEXPLAINED or best.misfit > UNSETTLED)
    if is_falling:
        return part.take(state.pose), best.pose
    return (best.pose,) if is_unsettled and second_try.is_over else ()


def _look_wider(
    sightings: Sightings,
    part: Part,
    seen: Observation,
    best: Attempt,
    previous: Array,
    objective: Objective,
    options: FitOptions,
) -> tuple[Observation, Attempt]:
    """What is seen around the pose that was found, and a fit to that, if it went so far that part of it was cut off."""
    camera, setup = sightings.camera, part.setup
    for _ in range(WIDER):
        needed = region_around(setup.scene.pose_at(best.pose).vertices, camera)
        if needed is None or not is_outgrown(seen.region, needed, camera):
            break
        wider = look(sightings.frame, camera, setup, best.pose)
        if wider is None:
            break
        seen, best = wider, attempt_fit(setup, wider, best.pose, previous, objective, options, sightings)
    return seen, best
