"""A hand model's mesh registered to a scan, with its verdict."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from tracker.capture.scan import Scan
from tracker.model.blend_model import BlendModel

Array = npt.NDArray[np.float64]

VERDICTS = ("good", "doubtful", "bad")


@dataclass(frozen=True)
class RegistrationStart:
    """Where to begin when it is known: from an earlier registration, or from the pose of a protocol.

    Attributes:
        side: "right" or "left".
        pose: (B, 3) axis-angle, the root first, of the right hand that a left one is the mirror image of, rad.
        translation: (3,) m.
        shape: (S,) or fewer.
        vertices: (V, 3) of the earlier registration, scan's frame, m: the pose is then found from them, whatever model
            it belonged to.
    """

    side: str
    pose: Array
    translation: Array
    shape: Array = field(default_factory=lambda: np.zeros(0))
    vertices: Array | None = None


@dataclass(frozen=True)
class Registration:
    """A registered scan.

    Attributes:
        vertices: (V, 3) the free surface, scan's frame, m.
        model_vertices: (V, 3) the model it is coupled to, scan's frame, m.
        faces: (F, 3) outwards in the scan's frame.
        pose: (B, 3) axis-angle, the root first, rad; for a left hand that of the mirrored right hand.
        shape: (S,) standard deviations.
        translation: (3,) m; for a left hand of the mirrored right hand.
        side: "right" or "left", as found.
        verdict: "good", "doubtful" or "bad".
        score: Estimated chance that it is wrong, 0 to 1; queues are ordered by it.
        reasons: Why it is not good, and what was left out of the scan.
        scan_to_mesh: (N,) m, of each point of the scan to the free surface; NaN where a point counts as no part of the
            hand: an object, a loose bit, the forearm behind the rim.
        seconds: Time that it took.
        timings: Seconds of processor time by stage.
        scan: The scan's name.
        scan_digest: SHA-256 of its points.
        model_digest: SHA-256 of the model.
        subject: Whose hand it is; "" if unknown.
        pose_name: The pose of the protocol; "" if unknown.
        measures: What the verdict rests on.
    """

    vertices: Array
    model_vertices: Array
    faces: npt.NDArray[np.int64]
    pose: Array
    shape: Array
    translation: Array
    side: str
    verdict: str
    score: float
    reasons: tuple[str, ...]
    scan_to_mesh: Array
    seconds: float
    timings: dict[str, float] = field(default_factory=dict)
    scan: str = ""
    scan_digest: str = ""
    model_digest: str = ""
    subject: str = ""
    pose_name: str = ""
    measures: dict[str, float] = field(default_factory=dict)

    @property
    def scan_to_mesh_mm(self) -> dict[str, float]:
        """mean, median and p95 over the points that count, mm; NaN if none does."""
        return summarize_distances(self.scan_to_mesh)

    def as_start(self) -> RegistrationStart:
        """To begin another registration of the same scan with."""
        return RegistrationStart(self.side, self.pose, self.translation, self.shape, self.vertices)


def summarize_distances(distances: Array) -> dict[str, float]:
    """mean, median and p95 of distances (N,), m, in mm; those that are NaN do not count."""
    counted = distances[np.isfinite(distances)] * 1e3
    if not len(counted):
        return {"mean": float("nan"), "median": float("nan"), "p95": float("nan")}
    return {
        "mean": float(counted.mean()),
        "median": float(np.median(counted)),
        "p95": float(np.percentile(counted, 95)),
    }


def digest_scan(scan: Scan) -> str:
    """SHA-256 of a scan's points."""
    return hashlib.sha256(np.ascontiguousarray(scan.points, dtype=np.float64).tobytes()).hexdigest()


def digest_model(model: BlendModel) -> str:
    """SHA-256 of all that a blend model's surface depends on."""
    digest = hashlib.sha256()
    arrays = (
        model.template,
        model.faces,
        model.shape_directions,
        model.pose_directions,
        model.skinning_weights,
        model.joint_regressor.toarray(),
        model.parents,
    )
    for array in arrays:
        digest.update(np.ascontiguousarray(array, dtype=np.float64).tobytes())
    return digest.hexdigest()
