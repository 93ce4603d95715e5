"""Arms and legs are restarted where the fit of the whole body may have left them in a wrong place."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
from scipy.spatial import KDTree
from scipy.spatial.transform import Rotation

from tracker.bodies.body_fit import BodyFit, find_parts, joint_columns
from tracker.bodies.body_state import SIDES, BodyState
from tracker.bodies.hand_mixture import HandMixture
from tracker.model.blend_model import BlendModel
from tracker.model.body_hands import body_hand
from tracker.model.mano_files import BODY_JOINTS
from tracker.registration.model_fit import Evaluation, FitSettings
from tracker.registration.pose_prior import PosePrior
from tracker.registration.scan_points import ScanPoints

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

AWAY = 0.035
"""Points nearer to the rest of the body are not the limb's, m."""
FEW = 40
"""With fewer points of its own a limb is not restarted. Chosen, not measured."""
BETTER = 0.9
"""A new start must cost less than this share of what the limb costs as it is."""

ROUGH = FitSettings(90.0, 6, to_scan=0.6, pose_weight=5.0, shape_weight=0.0, tolerance=1e-2)
FINE = FitSettings(30.0, 10, to_scan=0.6, pose_weight=3.0, shape_weight=0.0, tolerance=2e-3)
ROUGH_POINTS, FINE_POINTS, FOLLOWED = 150, 500, 4
"""Points of each stage, and how many candidates reach the second. Chosen, not measured."""

ARMS_DEG = [(lowered, ahead) for lowered in (-55.0, -10.0, 30.0, 65.0) for ahead in (-10.0, 35.0, 80.0)]
BENT_DEG = (15.0, 70.0, 120.0)
LEGS_DEG = [(ahead, aside) for ahead in (-60.0, -25.0, 5.0) for aside in (3.0, 20.0)]
KNEES_DEG = (5.0, 60.0)
"""Upper arm lowered and brought ahead, elbow bent; thigh brought ahead and aside, knee bent; degrees."""


@dataclass(frozen=True, eq=False)
class Limb:
    """An arm or a leg of the left or right side: its fit, its joints from the trunk on, the rest of the body."""

    fit: BodyFit
    joints: list[int]
    sign: float
    is_arm: bool
    rest: Ints


class LimbSearch:
    """Restarts the limbs of one model.

    Args:
        model: The body.
        prior: Of its joints.
        mixture: Of its hands.
        size: Components for each hand.
    """

    def __init__(self, model: BlendModel, prior: PosePrior, mixture: HandMixture | None, size: int = 6) -> None:
        self.model = model
        self.limbs = [
            _make_limb(model, prior, mixture, size, side, is_arm) for is_arm in (True, False) for side in SIDES
        ]
        self.numbers = np.zeros(len(model.template), dtype=np.int64)
        """(V,) of the limb that a vertex is of, from 1; 0 for the rest of the body."""
        for number, limb in enumerate(self.limbs, start=1):
            self.numbers[np.setdiff1d(np.arange(len(self.numbers)), limb.rest)] = number

    def improve(self, state: BodyState, scan: ScanPoints) -> tuple[BodyState, bool]:
        """The state with limbs that lie on the scan better, and whether any does."""
        changed = False
        for limb in self.limbs:
            points = self._points_of(limb, state, scan)
            if len(points.points) < FEW:
                continue
            few, many = points.first(ROUGH_POINTS), points.first(FINE_POINTS)
            as_it_is = limb.fit.fit(state, many, FINE)
            tried = sorted((limb.fit.fit(each, few, ROUGH) for each in _starts(limb, state)), key=_cost)
            best = min((limb.fit.fit(each.state, many, FINE) for each in tried[:FOLLOWED]), key=_cost)
            if best.cost < BETTER * as_it_is.cost:
                changed, as_it_is = True, best
            assert isinstance(as_it_is.state, BodyState)
            state = as_it_is.state
        return state, changed

    def _points_of(self, limb: Limb, state: BodyState, scan: ScanPoints) -> ScanPoints:
        vertices = state.posed(self.model).vertices
        ids = np.flatnonzero(KDTree(vertices[limb.rest]).query(scan.points, distance_upper_bound=AWAY)[0] > AWAY)
        return scan.chosen(ids)


def _make_limb(model, prior, mixture, size, side: str, is_arm: bool) -> Limb:
    names = ("shoulder", "elbow", "wrist") if is_arm else ("hip", "knee", "ankle", "foot")
    joints = [BODY_JOINTS.index(f"{side}_{name}") for name in names]
    bones = [*joints, *body_hand(model, side).fingers] if is_arm else joints
    ids, rest = find_parts(model, bones)
    columns = np.concatenate([joint_columns(joint) for joint in joints])
    fit = BodyFit(model, prior, mixture, size, ids, columns)
    sign = 1.0 if side == "left" else -1.0
    return Limb(fit, joints, sign, is_arm, rest)


def _starts(limb: Limb, state: BodyState) -> list[BodyState]:
    starts = []
    for a, b in ARMS_DEG if limb.is_arm else LEGS_DEG:
        for bent in BENT_DEG if limb.is_arm else KNEES_DEG:
            turns = [0.0, -limb.sign * b, -limb.sign * a] if limb.is_arm else [a, 0.0, limb.sign * b]
            second = [0.0, -limb.sign * bent, 0.0] if limb.is_arm else [bent, 0.0, 0.0]
            pose = state.pose.copy()
            pose[limb.joints] = 0.0  # a foot that lies folded back would else stay so
            pose[limb.joints[0]] = Rotation.from_euler("xyz", np.radians(turns)).as_rotvec()
            pose[limb.joints[1]] = np.radians(second)
            starts.append(replace(state, pose=pose))
    return starts


def _cost(evaluation: Evaluation) -> float:
    return evaluation.cost
