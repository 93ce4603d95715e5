"""One scan of a person from points to a registration, [R17] section 4.3.1."""

from __future__ import annotations

import time
from collections.abc import Callable
from copy import copy
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Literal

import numpy as np
import numpy.typing as npt
from scipy.spatial import KDTree

from tracker.bodies.body_fit import Anchor, BodyFit
from tracker.bodies.body_prior import make_body_prior
from tracker.bodies.body_registration import BodyRegistration
from tracker.bodies.body_start import BodyStart
from tracker.bodies.body_state import SIDES, BodyState, with_hands
from tracker.bodies.body_verdict import judge_body
from tracker.bodies.hand_mixture import HandMixture, default_mixture
from tracker.bodies.hand_search import HandSearch
from tracker.capture.scan import Scan
from tracker.model.blend_model import BlendModel
from tracker.model.body_hands import body_hand
from tracker.registration.free_fit import FreeFit, FreeSettings, FreeSurface
from tracker.registration.model_fit import Evaluation, FitSettings
from tracker.registration.registration import digest_model, digest_scan
from tracker.registration.scan_points import ScanPoints
from tracker.registration.stage_clock import StageClock

Array = npt.NDArray[np.float64]
Progress = Callable[[str, float], None]

START_POINTS = 20_000
"""So many are enough to find the body."""
NEAR_HAND = 0.03
"""Points this close to a hand are the hand's, m."""
HOLD = 1000.0
"""Weight of the pose of a hand that the scan does not show, 1/rad²."""


@dataclass(frozen=True)
class BodyOptions:
    """How scans of people are registered; the defaults were measured, see docs/bodies.md.

    Attributes:
        hand_components: Of each hand while it is searched, and in the first fit of the whole body.
        fine_components: Of each hand in the last fits.
        model_stages: Fits of pose and shape ([R17] Eq. 12), each with the number of points it uses.
        free_stages: Fits of the free surface (Eq. 20).
        max_points: So many points are fitted at most.
        hand_density: How many times denser the fitted points are on hands.
    """

    hand_components: int = 6
    fine_components: int = 24
    model_stages: tuple[tuple[int, FitSettings], ...] = field(
        default=(
            (4000, FitSettings(20.0, 8, to_scan=0.1, pose_weight=3.0, shape_weight=15.0)),
            (8000, FitSettings(10.0, 8, to_scan=0.1, pose_weight=1.0, shape_weight=10.0)),
        )
    )
    free_stages: tuple[tuple[int, FreeSettings], ...] = field(
        default=(
            (10000, FreeSettings(1.0, 10.0, 3, pose_weight=0.5, shape_weight=3.0)),
            (20000, FreeSettings(0.2, 7.0, 3, pose_weight=0.3, shape_weight=1.0)),
            (30000, FreeSettings(0.05, 5.0, 4, pose_weight=0.3, shape_weight=1.0)),
        )
    )
    max_points: int = 40_000
    hand_density: float = 6.0


class Registrar:
    """Registers scans of people with one model; what depends on the model alone is computed once.

    Args:
        model: A body with SMPL-H's joints.
        options: How.
        mixture: How hands are held; None for no prior of them, left out for the one that comes with Handloom.
    """

    def __init__(
        self,
        model: BlendModel,
        options: BodyOptions | None = None,
        mixture: HandMixture | Literal["default"] | None = "default",
    ) -> None:
        self.model = model
        self.model_digest = digest_model(model)
        self.options = options or BodyOptions()
        mixture = default_mixture() if mixture == "default" else mixture
        prior = make_body_prior()
        few, many = self.options.hand_components, self.options.fine_components
        self.coarse = BodyFit(model, prior, mixture, few)
        self.fine = BodyFit(model, prior, mixture, many)
        self.free = FreeFit(self.fine)
        self.hand_ids = [body_hand(model, side).vertices for side in SIDES]
        self._prior = prior

    @cached_property
    def start(self) -> BodyStart:
        return BodyStart(self.coarse)

    @cached_property
    def hands(self) -> HandSearch:
        return HandSearch(self.model, self._prior, self.coarse.mixture, default_mixture(), self.options.hand_components)

    def register(
        self, scan: Scan, start: BodyState | None = None, progress: Progress | None = None
    ) -> BodyRegistration:
        """Lay the body onto a scan and judge it, [R17] Eq. 12 and 20.

        Args:
            scan: In metres.
            start: Where the body is already, roughly; found when left out.
            progress: Is told a stage and its share of the whole; what it raises ends the work.
        """
        tell = progress or (lambda stage, share: None)
        clock = StageClock(time.perf_counter)
        if start is None:
            with clock.measure("start"):
                tell("start", 0.0)
                found = self.start.find(arrange(scan, None, START_POINTS))[0].state
            assert isinstance(found, BodyState)
            with clock.measure("hands"):
                tell("hands", 0.35)
                hands = self.hands.find(found, points_near_hands(scan, found, self.model, self.options.max_points))
            state, shown = self._relax(hands.state, hands.are_shown), hands.are_shown
        else:
            state, shown = start, self.find_shown(start, scan)
        with clock.measure("model"):
            tell("model", 0.6)
            points = self.points_for(scan, state)
            evaluation = self.fit_model(state, points, shown)
        with clock.measure("surface"):
            tell("surface", 0.7)
            surface = self.fit_surface(evaluation, points, shown)
        with clock.measure("judge"):
            tell("judge", 0.95)
            return self.judge(scan, surface, shown, clock)

    def _relax(self, state: BodyState, shown: tuple[bool, bool]) -> BodyState:
        """The state with hands that the scan does not show at their mean pose, straight behind the forearm."""
        pose, hands = state.pose.copy(), state.hands.copy()
        for k, side in enumerate(SIDES):
            if not shown[k]:
                pose[body_hand(self.model, side).wrist] = 0.0
                hands[k] = 0.0
        return with_hands(replace(state, pose=pose), self.coarse.space, hands)

    def find_shown(self, state: BodyState, scan: Scan) -> tuple[bool, bool]:
        """Whether the scan has hands where a state has them."""
        points = points_near_hands(scan, state, self.model, self.options.max_points)
        found = [self.hands.is_shown(state, self.hands.points_of(state, points, k), k) for k in range(2)]
        return found[0], found[1]

    def points_for(self, scan: Scan, state: BodyState) -> ScanPoints:
        """The points that are fitted, denser on the hands than elsewhere."""
        posed = state.posed(self.model)
        hands = KDTree(posed.vertices[np.concatenate(self.hand_ids)])
        near = hands.query(scan.points, distance_upper_bound=NEAR_HAND)[0] < NEAR_HAND
        return arrange(scan, np.where(near, self.options.hand_density, 1.0), self.options.max_points)

    def holding(
        self, fit: BodyFit, state: BodyState, shown: tuple[bool, bool], anchor: Anchor | None = None
    ) -> BodyFit:
        """The fit without hands that the scan does not show: they keep what they are held like."""
        missing = [k for k in range(2) if not shown[k]]
        if anchor is None and missing:
            anchor = Anchor(state, 0.0, np.array([0.0 if each else HOLD for each in shown]))
        if anchor is not None:
            anchor = replace(anchor, state=with_hands(anchor.state, fit.space, anchor.state.hands))
        if not missing:
            return fit.anchored(anchor)
        return fit.without(np.concatenate([self.hand_ids[k] for k in missing])).anchored(anchor)

    def fit_model(
        self, state: BodyState, points: ScanPoints, shown: tuple[bool, bool], anchor: Anchor | None = None
    ) -> Evaluation:
        """Pose and shape, stage by stage; hands of few components in all but the last."""
        evaluation: Evaluation | None = None
        known = state.hands
        for number, (count, settings) in enumerate(self.options.model_stages):
            fit = self.fine if number == len(self.options.model_stages) - 1 else self.coarse
            hands = with_hands(state, fit.space, state.hands).hands.copy()
            for k in range(2):
                if not shown[k]:
                    hands[k] = with_hands(state, fit.space, known).hands[k]
            state = with_hands(state, fit.space, hands)
            evaluation = self.holding(fit, state, shown, anchor).fit(state, points.first(count), settings)
            assert isinstance(evaluation.state, BodyState)
            state = evaluation.state
        assert evaluation is not None
        return evaluation

    def fit_surface(
        self, evaluation: Evaluation, points: ScanPoints, shown: tuple[bool, bool], anchor: Anchor | None = None
    ) -> FreeSurface:
        """The free surface, coupled to the model less and less."""
        assert isinstance(evaluation.state, BodyState)
        vertices = evaluation.posed.vertices
        surface = FreeSurface(vertices, evaluation.state, vertices, evaluation.matches, evaluation.weights, 0.0)
        free = copy(self.free)
        free.fit_model = self.holding(self.fine, evaluation.state, shown, anchor)
        for count, settings in self.options.free_stages:
            surface = free.fit(surface, points.first(count), settings)
        return surface

    def judge(self, scan: Scan, surface: FreeSurface, shown: tuple[bool, bool], clock: StageClock) -> BodyRegistration:
        """Distances of every point, and the verdict."""
        found = self.fine.search.match(surface.vertices, scan.points, np.zeros_like(scan.points), reach=10.0)
        state = replace(surface.state, translation=surface.state.translation + surface.offset)
        assert isinstance(state, BodyState)
        distances = np.abs(found.offsets)
        is_body = np.ones(len(surface.vertices), dtype=np.bool_)
        is_body[np.concatenate(self.hand_ids)] = False
        verdict = judge_body(surface.vertices, is_body, scan.points, distances, state.shape)
        guessed = tuple(
            f"the {side} hand is guessed: the scan does not show it"
            for side, each in zip(SIDES, shown, strict=True)
            if not each
        )
        return BodyRegistration(
            surface.vertices,
            surface.model_vertices + surface.offset,
            state,
            shown,
            distances,
            verdict.name,
            (*verdict.reasons, *guessed),
            verdict.measures,
            clock.seconds,
            scan.name,
            digest_scan(scan),
            self.model_digest,
        )


def arrange(scan: Scan, density: Array | None, count: int) -> ScanPoints:
    """At most `count` points, by chance but denser where `density` (N,) is larger; any first n are spread likewise."""
    keys = np.random.default_rng(1).exponential(size=len(scan.points))
    keys = keys if density is None else keys / density
    chosen = np.argsort(keys, kind="stable")[:count]
    return ScanPoints(np.ascontiguousarray(scan.points[chosen]), np.ascontiguousarray(scan.normals[chosen]))


def points_near_hands(scan: Scan, state: BodyState, model: BlendModel, count: int) -> ScanPoints:
    """Points within reach of the hands, with a share of all others that is not used."""
    joints = state.posed(model).joints
    wrists = [joints[body_hand(model, side).wrist] for side in SIDES]
    near = np.min([np.linalg.norm(scan.points - wrist, axis=1) for wrist in wrists], axis=0) < 0.45
    return arrange(scan, np.where(near, 1e3, 1.0), count)
