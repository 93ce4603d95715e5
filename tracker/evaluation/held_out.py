"""Registered scans of people that a model was not trained on, as what the model is judged by."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.capture.scan import Scan
from tracker.errors import RegistrationError
from tracker.evaluation.model_study import TestHand
from tracker.registration.registration import Registration

Array = npt.NDArray[np.float64]

MEASURED_POINTS = 15_000
"""Of a scan, at most, by chance."""


@dataclass(frozen=True)
class HeldOut:
    """People kept for testing.

    Attributes:
        hands: To judge by.
        flats: A registration (V, 3), m, of each person that is none of `hands`, for a template of their own; not of
            people with a single registration.
    """

    hands: tuple[TestHand, ...]
    flats: Mapping[str, Array]

    @property
    def with_template(self) -> tuple[TestHand, ...]:
        """Those of people whose template can be found."""
        return tuple(hand for hand in self.hands if hand.subject in self.flats)


def make_test_hand(scan: Scan, found: Registration) -> TestHand:
    """A scan that was registered, as a right hand. The registration's vertices stand for the true ones.

    Args:
        scan: What was registered, in the same order of points.
        found: Its registration. What it took for no part of the hand is left out.
    """
    if len(scan.points) != len(found.scan_to_mesh):
        raise RegistrationError(
            scan.name, f"{len(scan.points)} points", f"the {len(found.scan_to_mesh)} that were registered"
        )
    counted = np.flatnonzero(np.isfinite(found.scan_to_mesh))
    if not len(counted):
        raise RegistrationError(scan.name, "no point that counts as hand", "a registration that found a hand")
    ids = np.random.default_rng(0).permutation(counted)[:MEASURED_POINTS]
    flip = np.array([-1.0, 1.0, 1.0]) if found.side == "left" else np.ones(3)
    nobody_knows = np.full((len(found.pose), 3), np.nan)
    return TestHand(
        found.subject,
        found.pose_name,
        scan.points[ids] * flip,
        scan.normals[ids] * flip,
        found.vertices * flip,
        nobody_knows,
    )


def choose_held_out(subjects: Sequence[str], poses: Sequence[Array], most: int) -> tuple[dict[str, int], list[int]]:
    """Places of the registrations that give each person's template, and of those that are judged.

    Args:
        subjects: (N,) whose.
        poses: (N,) of (B, 3) axis-angle, the root first. A template comes from the hand that is bent least.
        most: To judge, at most: as many of each person as there are, spread over all of theirs.
    """
    bent = np.array([np.linalg.norm(pose[1:]) for pose in poses])
    mine = {name: [n for n, other in enumerate(subjects) if other == name] for name in sorted(set(subjects))}
    flats = {name: min(places, key=lambda n: (bent[n], n)) for name, places in mine.items() if len(places) > 1}
    left = {name: [n for n in places if n != flats.get(name)] for name, places in mine.items()}
    counts = dict.fromkeys(left, 0)
    while sum(counts.values()) < most:
        fewest = [name for name in left if counts[name] < len(left[name])]
        if not fewest:
            break
        counts[min(fewest, key=lambda name: counts[name])] += 1
    judged = [
        left[name][place]
        for name, count in counts.items()
        for place in np.linspace(0, len(left[name]) - 1, count).astype(int)
    ]
    return flats, judged
