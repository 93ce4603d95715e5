"""Scans of hands with their truth: who, in which pose, which hand, and by chance what the scanner misses."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
import numpy.typing as npt

from tracker.capture.scan import Scan
from tracker.model.mirroring import MIRROR
from tracker.synthesis.scans.arrange import SIDES, arrange
from tracker.synthesis.scans.colors import paint
from tracker.synthesis.scans.deform import PosedHand, deform
from tracker.synthesis.scans.generated_scan import GeneratedScan, HandTruth
from tracker.synthesis.scans.held import place_object
from tracker.synthesis.scans.pose_list import POSE_NAMES, POSES
from tracker.synthesis.scans.scanner import Scanner, scan_surface
from tracker.synthesis.scans.subject import BONES, Subject, load_surface
from tracker.synthesis.scans.ties import OVERHANG, load_ties

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

FOREARM = (0.030, 0.045)
"""How much forearm is in a scan, behind the untrained hand's border, m."""

ROUGH_CUT = (-0.006, 0.002)
"""Where a scan without forearm is cut, from the untrained hand's border towards the fingers, m."""

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
        holds_object: Whether grasps hold a green object, which hides skin and is scanned with it.
        has_forearm: Whether some 40 mm of forearm are in the scan; else it is cut at the wrist, roughly.
        is_moved: Whether the hand lies anyhow in the scan's coordinates; else the wrist is at the origin.
        is_varied: Whether poses differ from subject to subject and from seed to seed.
    """

    scanner: Scanner = field(default_factory=Scanner)
    strength: float = 1.0
    holds_object: bool = False
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
    person, name, angles = arrange(subject, pose, side, seed, options.is_varied)
    return _make_truth(person, name, deform(person, angles, options.strength), side)


def _make_truth(person: Subject, name: str, posed: PosedHand, side: str) -> HandTruth:
    surface, ties = load_surface(), load_ties()
    joints = np.einsum("bij,bj->bi", posed.Ts[:, :, :3], person.joints) + posed.Ts[:, :, 3]
    fine, faces = surface.fine @ posed.vertices, surface.fine_faces
    truth = HandTruth(ties.matrix @ posed.vertices, fine, faces, joints[JOINT_BONES], person.number, name, "right")
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
    person, pose_name, angles = arrange(subject, pose, side, seed, options.is_varied)
    posed = deform(person, angles, options.strength)
    truth = _make_truth(person, pose_name, posed, side)
    number = POSE_NAMES.index(pose_name) if pose_name in POSE_NAMES else len(POSES)
    rng = np.random.default_rng([subject, number, SIDES.index(side), seed, 1])
    vertices, faces = truth.surface, truth.surface_faces
    along = load_ties().along_arm[faces]
    first = -rng.uniform(*FOREARM) if options.has_forearm else rng.uniform(*ROUGH_CUT)
    is_kept, is_hand = along.min(axis=1) > first, along.mean(axis=1) > -OVERHANG
    held = POSES[number].held if options.holds_object and number < len(POSES) else None
    if held is not None:
        thing = place_object(person, posed, held)
        points, turned = (thing.vertices, thing.faces) if side == "right" else mirror_mesh(thing.vertices, thing.faces)
        vertices, faces = np.concatenate([vertices, points]), np.concatenate([faces, turned + len(vertices)])
        is_kept = np.concatenate([is_kept, np.ones(len(turned), dtype=bool)])
        is_hand = np.concatenate([is_hand, np.zeros(len(turned), dtype=bool)])
    seen = scan_surface(vertices, faces, is_kept, options.scanner, rng)
    R, t = (_random_rotation(rng), rng.uniform(-0.1, 0.1, 3)) if options.is_moved else (np.eye(3), np.zeros(3))
    colors = paint(seen.faces >= len(truth.surface_faces), subject, rng)
    name = scan_name(subject, pose_name, side, seed)
    return GeneratedScan(
        Scan(seen.points @ R.T + t, seen.normals @ R.T, colors=colors, name=name),
        truth.vertices @ R.T + t,
        (truth.surface @ R.T + t, truth.surface_faces),
        truth.joints @ R.T + t,
        is_hand[seen.faces],
        subject,
        pose_name,
        side,
    )


def scan_name(subject: int, pose_name: str, side: str, seed: int) -> str:
    return f"subject{subject:02d}_{pose_name}_{side}_{seed}"


def _mirror(truth: HandTruth) -> HandTruth:
    surface, faces = mirror_mesh(truth.surface, truth.surface_faces)
    return replace(
        truth,
        vertices=truth.vertices * MIRROR,
        surface=surface,
        surface_faces=faces,
        joints=truth.joints * MIRROR,
        side="left",
    )


def mirror_mesh(vertices: Array, faces: Ints) -> tuple[Array, Ints]:
    """A mesh seen in the mirror that makes left hands of right ones; its faces look outwards again."""
    return vertices * MIRROR, faces[:, ::-1]


def _random_rotation(rng: np.random.Generator) -> Array:
    """(3, 3), all rotations alike."""
    Q, R = np.linalg.qr(rng.standard_normal((3, 3)))
    Q = Q * np.sign(np.diag(R))
    Q[:, 0] *= np.linalg.det(Q)
    return Q
