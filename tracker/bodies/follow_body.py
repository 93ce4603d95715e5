"""A moving person from scan to scan, [R17] 4.3.2: each frame begins where the one before ended."""

from __future__ import annotations

import time
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np
import numpy.typing as npt

from tracker.bodies.body_fit import Anchor, BodyFit
from tracker.bodies.body_registration import BodyRegistration
from tracker.bodies.body_state import NUM_TURNED, BodyState, with_hands
from tracker.bodies.hand_mixture import HandMixture, default_mixture
from tracker.bodies.register_body import BodyOptions, Registrar, arrange, points_near_hands
from tracker.capture.scan import Scan
from tracker.model.blend_model import BlendModel
from tracker.registration.free_fit import FreeSettings
from tracker.registration.model_fit import FitSettings
from tracker.registration.stage_clock import StageClock

Array = npt.NDArray[np.float64]

LOST_MM, MOST_LOST = 4.0, 0.10
"""A hand is searched again when this share of its points is this far from it."""


@dataclass(frozen=True)
class FollowOptions:
    """How a moving person is followed; each of the three is a switch.

    Attributes:
        prior: Of the hands: a mixture of Gaussians ([R17] Eq. 17), one Gaussian, or none.
        holds_hands: E_r (Eq. 21) holds a hand that the scan does not show to what it was.
        has_velocity: E_r holds the whole pose a little to that of the frame before.
        hold: Weight of the first, 1/rad².
        velocity: Weight of the second, 1/rad²: on body and hands alike.
    """

    prior: Literal["mixture", "gaussian", "none"] = "mixture"
    holds_hands: bool = True
    has_velocity: bool = True
    hold: float = 1000.0
    velocity: float = 30.0


FOLLOW_STAGES = BodyOptions(
    fine_components=24,
    model_stages=(
        (3000, FitSettings(15.0, 6, to_scan=0.1, pose_weight=3.0, shape_weight=10.0)),
        (6000, FitSettings(8.0, 6, to_scan=0.05, pose_weight=1.0, shape_weight=10.0)),
    ),
    free_stages=((15000, FreeSettings(0.1, 6.0, 3, pose_weight=0.5, shape_weight=1.0)),),
    max_points=25_000,
)
"""With a person's own template there is less to find out than in a single scan."""


BODY_STAGE = (2500, FitSettings(40.0, 6, pose_weight=3.0, shape_weight=10.0, tolerance=5e-3))
"""Number of points and settings with which the body is followed before the hands."""


def choose_mixture(prior: str) -> HandMixture | None:
    """What the hands are expected to do."""
    mixture = default_mixture()
    return {"mixture": mixture, "gaussian": mixture.as_one(), "none": None}[prior]


class BodyFollower:
    """Follows one person; what that takes seconds to make ready is made when the first frame is registered.

    Args:
        model: The person's own.
        options: How.
    """

    def __init__(self, model: BlendModel, options: FollowOptions | None = None) -> None:
        self.model = model
        self.options = options or FollowOptions()

    @cached_property
    def registrar(self) -> Registrar:
        return Registrar(self.model, FOLLOW_STAGES, choose_mixture(self.options.prior))

    @cached_property
    def body(self) -> BodyFit:
        """Without the hands' parameters: the body is followed first, so that it is known where hands should be."""
        coarse = self.registrar.coarse
        columns = np.arange(NUM_TURNED)
        return BodyFit(self.model, coarse.prior, coarse.mixture, coarse.space.size, columns=columns)

    def begin(self, scan: Scan, start: BodyState | None = None) -> BodyRegistration:
        """The first scan; without a start the body is searched."""
        return self.registrar.register(scan, start)

    def follow(self, scan: Scan, before: BodyRegistration) -> BodyRegistration:
        """The scan behind a registered one."""
        registrar, clock = self.registrar, StageClock(time.perf_counter)
        with clock.measure("body"):
            state = self._follow_body(scan, before)
        with clock.measure("hands"):
            state, shown = self._find_hands(scan, state, before)
        with clock.measure("model"):
            points = registrar.points_for(scan, state)
            anchor = self._anchor(before, shown)
            evaluation = registrar.fit_model(state, points, shown, anchor)
        with clock.measure("hands"):
            lost = self._find_lost(scan, evaluation, shown)
            if lost:
                assert isinstance(evaluation.state, BodyState)
                state, _ = self._search(scan, evaluation.state, lost)
        if lost:
            with clock.measure("model"):
                other = registrar.fit_model(state, points, shown, anchor)
                evaluation = min(evaluation, other, key=lambda each: each.cost)
        with clock.measure("surface"):
            surface = registrar.fit_surface(evaluation, points, shown, anchor)
        with clock.measure("judge"):
            return registrar.judge(scan, surface, shown, clock)

    def _follow_body(self, scan: Scan, before: BodyRegistration) -> BodyState:
        """The state of the frame before with the body moved to where it is now, hands held as they were."""
        space = self.registrar.fine.space
        few = with_hands(before.state, self.body.space, before.state.hands)
        count, settings = BODY_STAGE
        moved = self.body.fit(few, arrange(scan, None, count), settings).state
        assert isinstance(moved, BodyState)
        return with_hands(moved, space, before.state.hands)

    def _find_hands(
        self, scan: Scan, state: BodyState, before: BodyRegistration
    ) -> tuple[BodyState, tuple[bool, bool]]:
        """Where to begin, and which hands are shown; hands that have come back are searched."""
        shown = self.registrar.find_shown(state, scan)
        back = tuple(k for k in range(2) if shown[k] and not before.are_shown[k])
        if not back:
            return state, shown
        state, found = self._search(scan, state, back)
        return state, (shown[0] and found[0], shown[1] and found[1])

    def _search(self, scan: Scan, state: BodyState, sides: tuple[int, ...]) -> tuple[BodyState, tuple[bool, bool]]:
        """The state with these hands (0 left, 1 right) searched again, and whether the scan shows them after all."""
        registrar, space = self.registrar, self.registrar.fine.space
        near = points_near_hands(scan, state, registrar.model, registrar.options.max_points)
        found = registrar.hands.find(state, near, sides)
        hands = with_hands(state, space, state.hands).hands.copy()
        hands[list(sides)] = with_hands(found.state, space, found.state.hands).hands[list(sides)]
        return with_hands(found.state, space, hands), found.are_shown

    def _anchor(self, before: BodyRegistration, shown: tuple[bool, bool]) -> Anchor:
        """What the frame is held to; a hand that has just come back is not."""
        velocity = self.options.velocity if self.options.has_velocity else 0.0
        hold = self.options.hold if self.options.holds_hands else 0.0
        weights = [
            (velocity if was_shown else 0.0) if is_shown else hold
            for is_shown, was_shown in zip(shown, before.are_shown, strict=True)
        ]
        return Anchor(before.state, velocity, np.array(weights))

    def _find_lost(self, scan: Scan, evaluation, shown: tuple[bool, bool]) -> tuple[int, ...]:
        """Hands that do not lie on their points."""
        registrar = self.registrar
        vertices = evaluation.posed.vertices
        lost = []
        for k in range(2):
            middle = vertices[registrar.hand_ids[k]].mean(axis=0)
            near = np.flatnonzero(np.linalg.norm(scan.points - middle, axis=1) < 0.11)
            if not shown[k] or not len(near):
                continue
            points = np.ascontiguousarray(scan.points[near])
            found = registrar.fine.search.match(vertices, points, np.zeros_like(points), reach=1.0)
            if np.mean(np.abs(found.offsets) > 1e-3 * LOST_MM) > MOST_LOST:
                lost.append(k)
        return tuple(lost)
