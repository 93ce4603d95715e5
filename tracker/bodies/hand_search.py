"""How a body's hands are held: each begun in many poses and turns of its wrist, low-dimensional, the body fixed."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
from scipy.spatial import KDTree
from scipy.spatial.transform import Rotation

from tracker.bodies.body_fit import BodyFit, find_parts, hand_columns, joint_columns
from tracker.bodies.body_state import SIDES, BodyState, with_hands
from tracker.bodies.hand_mixture import HandMixture
from tracker.model.blend_model import BlendModel
from tracker.model.body_hands import BodyHand, body_hand
from tracker.registration.model_fit import Evaluation, FitSettings
from tracker.registration.pose_prior import PosePrior
from tracker.registration.scan_points import ScanPoints

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

REACH = 0.26
"""Points this far from where the knuckles are thought to be may be forearm's or hand's, m."""
AWAY = 0.03
"""Points nearer to the rest of the body are not, m."""
PAST_WRIST, FEWEST = 0.045, 0.06
"""A hand is shown when so much of the points within reach (share) lies this far (m) past the wrist."""
COVERED, LEAST_COVERED = 0.010, 0.15
"""And when, in the end, so much of it (share) has points as near as this, m."""

TURNS_DEG = (0.0, -75.0, 75.0, 150.0)
"""Turns of the forearm about itself that are tried."""

ROUGH = FitSettings(25.0, 5, to_scan=0.5, pose_weight=3.0, shape_weight=0.0, tolerance=1e-2)
FINE = FitSettings(10.0, 10, to_scan=0.4, pose_weight=2.0, shape_weight=0.0, tolerance=2e-3)
ROUGH_POINTS, FINE_POINTS, FOLLOWED = 250, 900, 5
"""Points of each stage, and how many candidates reach the second. Chosen, not measured."""


@dataclass(frozen=True)
class FoundHands:
    """What was found of both hands.

    Attributes:
        state: The body with those forearms and hands; a hand that the scan does not show is as it was.
        are_shown: Whether the scan has the left and the right hand.
    """

    state: BodyState
    are_shown: tuple[bool, bool]


class HandSearch:
    """Searches both hands of one model.

    Args:
        model: The body.
        prior: Of its joints.
        mixture: Of its hands; None for no prior.
        starts: Its means are begun with.
        size: Components for each hand.
    """

    def __init__(
        self, model: BlendModel, prior: PosePrior, mixture: HandMixture | None, starts: HandMixture, size: int = 6
    ) -> None:
        self.model = model
        self.means = starts.first(size).means
        self.hands: list[BodyHand] = [body_hand(model, side) for side in SIDES]
        self.fits: list[BodyFit] = []
        self.rest: list[Ints] = []
        for k, hand in enumerate(self.hands):
            ids, rest = find_parts(model, [hand.elbow, hand.wrist, *hand.fingers])
            columns = np.concatenate([joint_columns(hand.elbow), joint_columns(hand.wrist), hand_columns(size, k)])
            self.fits.append(BodyFit(model, prior, mixture, size, ids, columns))
            self.rest.append(rest)

    def find(self, state: BodyState, scan: ScanPoints, sides: tuple[int, ...] = (0, 1)) -> FoundHands:
        """Hands from a state whose arms are about right.

        Args:
            state: With any number of coefficients of the hands.
            scan: Points about the hands at least.
            sides: Which are searched, of left (0) and right (1); the other stays and counts as shown.
        """
        shown = [True, True]
        state = with_hands(state, self.fits[0].space, state.hands)
        for k in sides:
            points = self.points_of(state, scan, k)
            shown[k] = self.is_shown(state, points, k)
            if shown[k]:
                best = self._search(k, state, points).state
                assert isinstance(best, BodyState)
                shown[k] = self.covered_share(best, scan, k) >= LEAST_COVERED
                state = best if shown[k] else state
        return FoundHands(state, (shown[0], shown[1]))

    def points_of(self, state: BodyState, scan: ScanPoints, k: int) -> ScanPoints:
        """Points that may be forearm's and hand's; those that others of the body are nearer to are not."""
        posed = state.posed(self.model)
        middle = posed.joints[self.hands[k].fingers].mean(axis=0)
        near = np.flatnonzero(np.linalg.norm(scan.points - middle, axis=1) < REACH)
        rest = KDTree(posed.vertices[self.rest[k]])
        ids = near[rest.query(scan.points[near], distance_upper_bound=AWAY)[0] > AWAY]
        return scan.chosen(ids)

    def is_shown(self, state: BodyState, points: ScanPoints, k: int) -> bool:
        """Whether there are points past the wrist."""
        joints, hand = state.posed(self.model).joints, self.hands[k]
        along = joints[hand.wrist] - joints[hand.elbow]
        past = (points.points - joints[hand.wrist]) @ (along / np.linalg.norm(along))
        return len(past) > 0 and bool(np.mean(past > PAST_WRIST) > FEWEST)

    def covered_share(self, state: BodyState, scan: ScanPoints, k: int) -> float:
        """Share of a hand's vertices that have a point beside them."""
        vertices = state.posed(self.model).vertices[self.hands[k].vertices]
        near = (
            np.linalg.norm(scan.points - vertices.mean(axis=0), axis=1) < 2.0 * COVERED + np.ptp(vertices, axis=0).max()
        )
        if not near.any():
            return 0.0
        return float(np.mean(KDTree(scan.points[near]).query(vertices, distance_upper_bound=COVERED)[0] < COVERED))

    def _search(self, k: int, state: BodyState, points: ScanPoints) -> Evaluation:
        fit, few, many = self.fits[k], points.first(ROUGH_POINTS), points.first(FINE_POINTS)
        tried = [fit.fit(each, few, ROUGH) for each in self._starts(k, state)]
        tried.sort(key=lambda each: each.cost)
        return min((fit.fit(each.state, many, FINE) for each in tried[:FOLLOWED]), key=lambda each: each.cost)

    def _starts(self, k: int, state: BodyState) -> list[BodyState]:
        starts, hand = [], self.hands[k]
        for degrees in TURNS_DEG:
            pose = state.pose.copy()
            turn = Rotation.from_rotvec([np.radians(degrees), 0.0, 0.0])
            pose[hand.elbow] = (Rotation.from_rotvec(pose[hand.elbow]) * turn).as_rotvec()
            turned = replace(state, pose=pose)
            for coefficients in [state.hands[k], *self.means] if degrees == 0.0 else self.means:
                both = state.hands.copy()
                both[k] = coefficients
                starts.append(with_hands(turned, self.fits[k].space, both))
        return starts
