"""Let the hands hold the object: contacts that keep it from falling, and a short fit with them; [T16] §3.2.6."""

from __future__ import annotations

from dataclasses import dataclass, replace

from tracker.fitting.attempt import Attempt, attempt_fit
from tracker.fitting.frame_fit import FitOptions
from tracker.fitting.objective import Objective
from tracker.fitting.setup import TrackSetup
from tracker.observation import Observation
from tracker.physics import Support, find_settled_displacement, find_support
from tracker.search.tools import Tools
from tracker.terms.physics import Physics
from tracker.tracking.state import TrackState


@dataclass(frozen=True)
class HoldOptions:
    """How an object that would fall is held.

    Attributes:
        iterations: With contacts, after the others.
        weight: γ_ph of Eq. 16; the paper's 10 leaves most of a gap of 2 mm open where depth says that there is one.
        score_drop: A held pose may explain any hand worse by this much, no more.
        gain: It must move the object less than this share of what the fitted one does.
    """

    iterations: int = 3
    weight: float = 50.0
    score_drop: float = 0.01
    gain: float = 0.5


def hold_object(
    setup: TrackSetup,
    tools: Tools,
    seen: Observation,
    objective: Objective,
    state: TrackState,
    fitted: Attempt,
    options: FitOptions,
    hold: HoldOptions | None = None,
) -> Attempt:
    """The fitted pose, or where its object would fall one that is drawn into contact with it.

    The drawn pose is taken only if it explains the image as well and the object moves less from there. The costs of its
    iterations follow those of the fit.

    Args:
        setup: Models and options.
        tools: With the run's physics world, if it has one.
        seen: The frame.
        objective: Of the fit.
        state: After the frame before.
        fitted: What the fit gave.
        options: Of the fit.
        hold: How.
    """
    world, hold = tools.world, hold or HoldOptions()
    if world is None or fitted.quality.is_lost:
        return fitted
    support = find_support(world, setup.scene.pose_at(fitted.pose))
    enough = hold.gain * support.displacement
    if support.is_stable or not support.contacts or support.held_displacement > enough:
        return fitted
    short = replace(options, iterations=hold.iterations)
    held = attempt_fit(setup, seen, fitted.pose, state.pose, with_contacts(objective, support, hold), short)
    for hand, quality in held.qualities.items():
        if quality.score < fitted.qualities[hand].score - hold.score_drop:
            return fitted
    displacement = find_settled_displacement(world, setup.scene.pose_at(held.pose))
    if displacement > enough:
        return fitted
    return replace(held, fit=replace(held.fit, costs=fitted.fit.costs + held.fit.costs))


def with_contacts(objective: Objective, support: Support, hold: HoldOptions | None = None) -> Objective:
    """The objective that draws the chosen finger parts, and those that touch already, to the object's surface."""
    hold = hold or HoldOptions()
    contacts = Physics(support.contacts + support.touching, hold.weight, draws_out=True)
    return replace(objective, terms={**objective.terms, "physics": contacts})
