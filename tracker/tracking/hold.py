"""Let the hands hold the object: contacts that keep it from falling, and a short fit with them; [T16] §3.2.6."""

from __future__ import annotations

from dataclasses import replace

from tracker.observation import Observation
from tracker.tracking.attempt import Attempt, attempt_fit
from tracker.tracking.frame_fit import FitOptions
from tracker.tracking.objective import Objective
from tracker.tracking.setup import TrackSetup
from tracker.tracking.state import TrackState
from tracker.tracking.tools import Tools

HOLDING = 5
"""Iterations with contacts, after the others."""


def hold_object(
    setup: TrackSetup,
    tools: Tools,
    seen: Observation,
    objective: Objective,
    state: TrackState,
    fitted: Attempt,
    options: FitOptions,
) -> Attempt:
    """The fitted pose, or where its object would fall one that is drawn into contact with it.

    Args:
        setup: Models and options.
        tools: With the run's physics world, if it has one.
        seen: The frame.
        objective: Of the fit.
        state: After the frame before.
        fitted: What the fit gave.
        options: Of the fit.
    """
    if tools.world is None or fitted.quality.is_lost:
        return fitted
    held = tools.with_support(objective, setup, fitted.pose)
    if held is None:
        return fitted
    again = attempt_fit(setup, seen, fitted.pose, state.pose, held, replace(options, iterations=HOLDING))
    return replace(again, fit=replace(again.fit, costs=fitted.fit.costs + again.fit.costs))
