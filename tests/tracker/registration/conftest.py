"""Scans of the untrained hand itself, so that the truth is known."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

from tracker.capture.scan import Scan
from tracker.model.blend_limits import blend_limits
from tracker.model.untrained_hand import untrained_hand
from tracker.registration import surface_search
from tracker.registration.anatomy import make_anatomical_prior
from tracker.registration.model_fit import ModelFit
from tracker.registration.register import Registrar
from tracker.registration.scan_points import ScanPoints
from tracker.registration.start_poses import FOLDED, STRAIGHT, curl_finger
from tracker.registration.vertex_fit import fit_to_vertices


@dataclass(frozen=True)
class OwnScan:
    """A scan sampled from the model, and the vertices it was sampled from."""

    scan: Scan
    vertices: np.ndarray


def scan_model(seed: int = 0, count: int = 8000, folded: tuple[str, ...] = (), side: str = "right") -> OwnScan:
    rng = np.random.default_rng(seed)
    hand = untrained_hand()
    limits = blend_limits(hand)
    pose = limits.pose_at(limits.mean)
    for finger in ("index", "middle", "ring", "little"):
        pose = curl_finger(limits, pose, finger, FOLDED if finger in folded else STRAIGHT)
    pose[0] = rng.normal(size=3)
    posed = hand.pose_at(pose, 0.7 * rng.normal(size=hand.num_shape), rng.uniform(-0.1, 0.1, 3))
    vertices, faces = posed.vertices, np.asarray(hand.faces)
    corners = vertices[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas = np.linalg.norm(normals, axis=1)
    chosen = rng.choice(len(faces), count, p=areas / areas.sum())
    points = np.einsum("nk,nkd->nd", rng.dirichlet([1.0, 1.0, 1.0], count), corners[chosen])
    normals = normals[chosen] / areas[chosen, None]
    points = points + 1e-4 * rng.normal(size=(count, 1)) * normals
    flip = np.array([1.0 if side == "right" else -1.0, 1.0, 1.0])
    return OwnScan(Scan(points * flip, normals * flip, name=f"own_{seed}"), vertices * flip)


@pytest.fixture(scope="session")
def registrar() -> Registrar:
    return Registrar(untrained_hand())


@pytest.fixture(scope="session")
def own_scan() -> OwnScan:
    return scan_model()


@pytest.fixture(scope="session")
def fit() -> ModelFit:
    """Of the untrained hand, held by anatomy."""
    hand = untrained_hand()
    return ModelFit(hand, make_anatomical_prior(hand))


@pytest.fixture(scope="session")
def near(fit, own_scan):
    """A state some millimetres off, and 400 points away from the rim, where the cost is smooth."""
    rng = np.random.default_rng(0)
    state = fit_to_vertices(fit, fit.neutral(), own_scan.vertices)
    state = state.retract(fit.model, 0.02 * rng.normal(size=fit.model.num_parameters) * fit.scales)
    points = ScanPoints(own_scan.scan.points[:2000], own_scan.scan.normals[:2000])
    found = fit.search.match(state.posed(fit.model).vertices, points.points, points.normals, 0.03)
    ids = np.flatnonzero(~found.on_rim & (found.faces >= 0))[:400]
    return state, ScanPoints(points.points[ids], points.normals[ids])


@pytest.fixture
def flat_triangles(monkeypatch):
    """Where no triangle bulges the derivatives are exact; how they bulge is held otherwise."""
    monkeypatch.setattr(surface_search, "find_bulges", lambda vertices, faces: np.zeros((len(faces), 3, 3)))
