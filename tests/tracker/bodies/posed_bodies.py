"""Bodies in known states, and scans that are points of their very surface: nothing is generated that could differ."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tracker.bodies.body_registration import BodyRegistration
from tracker.bodies.body_state import BodyState, hand_space, make_state
from tracker.bodies.body_verdict import BodyVerdict
from tracker.capture.scan import Scan
from tracker.geometry.vertex_normals import find_unit_normals
from tracker.model.body_hands import body_hand
from tracker.model.body_model import body_model
from tracker.model.mano_files import BODY_JOINTS
from tracker.registration.scan_points import ScanPoints

MODEL = body_model()
SPACE = hand_space(MODEL, 6)
LIMIT = 2e-3
"""m; states that were found are called right when their surface is off by less."""


def turned(**degrees: Sequence[float]) -> np.ndarray:
    """(22, 3) rad: rotation vectors of joints by name, others zero."""
    pose = np.zeros((22, 3))
    for name, turn in degrees.items():
        pose[BODY_JOINTS.index(name)] = np.radians(turn)
    return pose


A_POSE = turned(left_shoulder=(0, 0, -50), right_shoulder=(0, 0, 50), left_elbow=(0, -15, 0), right_elbow=(0, 15, 0))


def stand(
    pose: np.ndarray = A_POSE, hands: np.ndarray | None = None, place: tuple[float, ...] = (0, 0, 0)
) -> BodyState:
    state = make_state(MODEL, SPACE, pose, hands)
    return BodyState(state.pose, state.shape, np.array(place, dtype=np.float64), state.hands)


def draw_state(seed: int) -> BodyState:
    """A pose, a shape, hands and a place by chance."""
    rng = np.random.default_rng(seed)
    state = make_state(MODEL, SPACE, 0.3 * rng.standard_normal((22, 3)), 0.3 * rng.standard_normal((2, 6)))
    return BodyState(state.pose, rng.standard_normal(MODEL.num_shape), rng.standard_normal(3), state.hands)


def scan_of(state: BodyState, without: tuple[str, ...] = (), seed: int = 0) -> Scan:
    """All vertices of the body in any order, those of some hands left out."""
    vertices = state.posed(MODEL).vertices
    normals = find_unit_normals(vertices, MODEL.faces)
    kept = np.setdiff1d(np.arange(len(vertices)), [i for side in without for i in body_hand(MODEL, side).vertices])
    kept = np.random.default_rng(seed).permutation(kept)
    return Scan(vertices[kept], normals[kept], name="posed")


def points_of(state: BodyState, without: tuple[str, ...] = ()) -> ScanPoints:
    scan = scan_of(state, without)
    return ScanPoints(scan.points, scan.normals)


def apart(a: BodyState, b: BodyState, ids: np.ndarray | slice = slice(None)) -> float:
    """Mean distance of the two surfaces' vertices, m."""
    difference = a.posed(MODEL).vertices[ids] - b.posed(MODEL).vertices[ids]
    return float(np.linalg.norm(difference, axis=1).mean())


def registration_of(state: BodyState, name: str = "good", **more) -> BodyRegistration:
    """As if a scan had been registered without any error."""
    vertices = state.posed(MODEL).vertices
    verdict = BodyVerdict(name, () if name == "good" else ("the scan shows only part of a person",))
    return BodyRegistration(
        vertices, vertices, state, more.pop("shown", (True, True)), np.zeros(4), verdict.name, verdict.reasons, **more
    )
