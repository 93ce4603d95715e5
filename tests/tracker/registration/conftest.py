"""Scans of the untrained hand itself, so that the truth is known."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

from tracker.capture.scan import Scan
from tracker.model.blend_limits import blend_limits
from tracker.model.untrained_hand import untrained_hand
from tracker.registration.register import Registrar
from tracker.registration.start_poses import FOLDED, STRAIGHT, curl_finger


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
