"""Scans of hands with their truth: who, in which pose, which hand, and by chance what the scanner misses."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
import numpy.typing as npt

from tracker.capture.scan import Scan
from tracker.errors import TrackerError
from tracker.model.mirroring import MIRROR
from tracker.synthesis.scans.angles import clip_to_limits, pose_angles, vary
from tracker.synthesis.scans.deform import deform
from tracker.synthesis.scans.generated_scan import GeneratedScan, HandTruth
from tracker.synthesis.scans.pose_list import POSE_NAMES, POSES
from tracker.synthesis.scans.scanner import Scanner, scan_surface
from tracker.synthesis.scans.settle import settle
from tracker.synthesis.scans.subject import BONES, Subject, load_subject, load_surface
from tracker.synthesis.scans.ties import OVERHANG, load_ties

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

SIDES = ("right", "left")

JOINT_BONES: Ints = np.array(
    [0]
    + [BONES.index(f"{f}_{s}") for f in ("index", "middle", "little", "ring") for s in ("proximal", "middle", "distal")]
    + [BONES.index(f"thumb_{s}") for s in ("metacarpal", "proximal", "distal")]
)
"""The bones that begin at the 16 joints of a `BlendModel`, in its order."""


@dataclass(frozen=True)
class ScanOptions:
    """How hands are deformed and scanned.

    Attributes:
        scanner: The scanner.
        strength: Of swelling, folding and sliding skin; 1 as in life, 2.5 for a harder test.
        has_forearm: Whether some 45 mm of forearm are in the scan; else it is cut at the wrist, roughly.
        is_moved: Whether the hand lies anyhow in the scan's coordinates; else the wrist is at the origin.
        is_varied: Whether poses differ from subject to subject and from seed to seed.
    """

    scanner: Scanner = field(default_factory=Scanner)
    strength: float = 1.0
    has_forearm: bool = True
    is_moved: bool = True
    is_varied: bool = True


def generate_truth(
    subject: int,
    pose: int | str | Array,
    side: str = "right",
    seed: int = 0,
    options: ScanOptions | None = None,
) -> HandTruth:
    """The hand that `generate_scan` scans, with the wrist at the origin; a few milliseconds.

    Args:
        subject: 1 to 37, see `TRAIN_SUBJECTS` and `TEST_SUBJECTS`.
        pose: Number or name in the list of poses, or (31,) rad from the rest pose.
        side: "right" or "left".
        seed: Of what is chance; another seed is another repetition of the pose.
        options: See `ScanOptions`.
    """
    options = options or ScanOptions()
    person, name, angles = _arrange(subject, pose, side, seed, options)
    surface, ties = load_surface(), load_ties()
    posed = deform(person, angles, options.strength)
    joints = np.einsum("bij,bj->bi", posed.Ts[:, :, :3], person.joints) + posed.Ts[:, :, 3]
    fine, faces = surface.fine @ posed.vertices, surface.fine_faces
    truth = HandTruth(ties.matrix @ posed.vertices, fine, faces, joints[JOINT_BONES], subject, name, "right")
    return truth if side == "right" else _mirror(truth)


def generate_scan(
    subject: int,
    pose: int | str | Array,
    side: str = "right",
    seed: int = 0,
    options: ScanOptions | None = None,
) -> GeneratedScan:
    """A scan with its truth; the same arguments, which are those of `generate_truth`, make the same scan."""
    options = options or ScanOptions()
    truth = generate_truth(subject, pose, side, seed, options)
    rng = np.random.default_rng([subject, POSE_NAMES.index(truth.pose_name) if truth.pose_name in POSE_NAMES else 999,
                                 SIDES.index(side), seed, 1])  # fmt: skip
    along = load_ties().along_arm
    first = -rng.uniform(0.030, 0.045) if options.has_forearm else rng.uniform(-0.006, 0.002)
    kept = along[truth.surface_faces].min(axis=1) > first
    seen = scan_surface(truth.surface, truth.surface_faces, kept, options.scanner, rng)
    is_hand = along[truth.surface_faces[seen.faces]].mean(axis=1) > -OVERHANG
    R, t = (_random_rotation(rng), rng.uniform(-0.1, 0.1, 3)) if options.is_moved else (np.eye(3), np.zeros(3))
    name = f"subject{subject:02d}_{truth.pose_name}_{side}_{seed}"
    return GeneratedScan(
        Scan(seen.points @ R.T + t, seen.normals @ R.T, name=name),
        truth.vertices @ R.T + t,
        (truth.surface @ R.T + t, truth.surface_faces),
        truth.joints @ R.T + t,
        is_hand,
        subject,
        truth.pose_name,
        side,
    )


def _arrange(
    subject: int, pose: int | str | Array, side: str, seed: int, options: ScanOptions
) -> tuple[Subject, str, Array]:
    """Who it is, the name of the pose, and the angles (31,) rad from the rest pose."""
    if side not in SIDES:
        raise TrackerError(f"A hand is 'right' or 'left', not {side!r}.")
    if subject == 0:
        raise TrackerError("There is no subject 0; subjects are numbered from 1.")
    person = load_subject(subject)
    if isinstance(pose, np.ndarray):
        if pose.shape != (len(person.dofs),):
            raise TrackerError(f"A pose has {len(person.dofs)} angles; got an array of the shape {pose.shape}.")
        return person, "given", pose.astype(np.float64)
    if isinstance(pose, str):
        if pose not in POSE_NAMES:
            raise TrackerError(f"There is no pose {pose!r}; choose one of {', '.join(POSE_NAMES)}.")
        pose = POSE_NAMES.index(pose)
    if not 0 <= pose < len(POSES):
        raise TrackerError(f"There is no pose {pose}; there are 0 to {len(POSES) - 1}.")
    angles = pose_angles(person, POSES[pose])
    if not options.is_varied:
        return person, POSE_NAMES[pose], settle(person, clip_to_limits(person, angles), POSES[pose].touches)
    habit = np.random.default_rng([subject, pose, 0])
    moment = np.random.default_rng([subject, pose, SIDES.index(side), seed, 0])
    return person, POSE_NAMES[pose], settle(person, vary(person, angles, habit, moment), POSES[pose].touches)


def _mirror(truth: HandTruth) -> HandTruth:
    return replace(
        truth,
        vertices=truth.vertices * MIRROR,
        surface=truth.surface * MIRROR,
        surface_faces=truth.surface_faces[:, ::-1],
        joints=truth.joints * MIRROR,
        side="left",
    )


def _random_rotation(rng: np.random.Generator) -> Array:
    """(3, 3), all rotations alike."""
    Q, R = np.linalg.qr(rng.standard_normal((3, 3)))
    Q = Q * np.sign(np.diag(R))
    Q[:, 0] *= np.linalg.det(Q)
    return Q
