"""Scans of people with their truth: who, in which pose, and by chance what the scanner misses."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt
from scipy.spatial import KDTree

from tracker.capture.scan import Scan
from tracker.registration.curved_triangles import refine
from tracker.synthesis.bodies.body_poses import draw_pose
from tracker.synthesis.bodies.person import Person, hand_vertices, make_person
from tracker.synthesis.scans.scanner import Scanner, scan_surface

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

SIDES = ("left", "right")

BODY_SCANNER = Scanner(
    num_points=150_000,
    noise=0.5e-3,
    normal_noise_deg=6.0,
    views=16,
    holes=(4, 10),
    hole_radius=(10e-3, 35e-3),
    distance=2.5,
    pixels=900,
)
"""A ring of stereo heads around a person, after [R17] 4.1: coarser than a scanner of hands, with larger holes."""

TO_RING = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])
"""From a body (y up) to the axes of the scanner, whose heads stand around x."""


@dataclass(frozen=True, eq=False)
class GeneratedBody:
    """A scan of a person and what it is a scan of.

    Attributes:
        scan: In metres, y up.
        true_vertices: (V, 3) m, in the topology of the body that comes with Handloom.
        joints: (52, 3) m.
        pose: (52, 3) rad of the true skeleton.
        person: Number of the person.
        shows_hand: For "left" and "right" whether the scan has the hand at all.
        is_seen: (V,) which vertices have points within 10 mm.
    """

    scan: Scan
    true_vertices: Array
    joints: Array
    pose: Array
    person: int
    shows_hand: dict[str, bool]
    is_seen: npt.NDArray[np.bool_]

    def true_surface(self, faces: Ints, levels: int = 1) -> tuple[Array, Ints]:
        """The surface that was scanned: vertices and faces."""
        return refine(self.true_vertices, faces, levels)


@dataclass(frozen=True)
class BodyScanOptions:
    """How people are scanned.

    Attributes:
        scanner: The scanner.
        missing_hands: Chance that a hand is not in the scan at all.
        wildness: Share of the range of poses that is used.
    """

    scanner: Scanner = field(default_factory=lambda: BODY_SCANNER)
    missing_hands: float = 0.0
    wildness: float = 1.0


def generate_body(number: int, seed: int = 0, options: BodyScanOptions | None = None) -> GeneratedBody:
    """A person in a random pose; the same arguments make the same scan.

    Args:
        number: Of the person.
        seed: Of what is chance: another pose, other holes.
        options: See `BodyScanOptions`.
    """
    options = options or BodyScanOptions()
    rng = np.random.default_rng([number, seed, 23])
    person = make_person(number)
    pose = draw_pose(person, rng, options.wildness)
    shown = {side: bool(rng.uniform() >= options.missing_hands) for side in SIDES}
    translation = np.array([rng.uniform(-0.2, 0.2), 0.0, rng.uniform(-0.2, 0.2)])
    vertices, _ = person.posed(pose, translation)
    translation[1] = -vertices[:, 1].min()
    return scan_person(person, pose, translation, shown, options.scanner, rng, f"person{number:03d}_{seed}")


def scan_person(
    person: Person,
    pose: Array,
    translation: Array,
    shown: dict[str, bool],
    scanner: Scanner,
    rng: np.random.Generator,
    name: str,
) -> GeneratedBody:
    """Scan a person.

    Args:
        person: Who.
        pose: (52, 3) rad.
        translation: (3,) m.
        shown: For each side whether the hand gives points.
        scanner: The scanner.
        rng: Chance.
        name: Of the scan.
    """
    vertices, joints = person.posed(pose, translation)
    faces = person.model.faces
    fine, fine_faces = refine(vertices, faces, 1)
    kept = np.ones(len(faces), dtype=bool)
    for side, ids in hand_vertices(person.model).items():
        if not shown[side]:
            kept &= ~np.isin(faces, ids).all(axis=1)
    is_kept = np.repeat(kept, 4)
    seen = scan_surface(fine @ TO_RING.T, fine_faces, is_kept, scanner, rng)
    scan = Scan(seen.points @ TO_RING, seen.normals @ TO_RING, name=name)
    is_seen = find_seen(vertices, scan.points)
    return GeneratedBody(scan, vertices, joints, pose, person.number, shown, is_seen)


def find_seen(vertices: Array, points: Array, reach: float = 0.010) -> npt.NDArray[np.bool_]:
    """(V,) which vertices (V, 3) have one of the points (N, 3) within `reach`, m."""
    return np.asarray(np.isfinite(KDTree(points).query(vertices, distance_upper_bound=reach)[0]))
