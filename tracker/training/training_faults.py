"""What keeps a model from being trained, as far as it is known without the registrations' files."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

LEAST_BEND = np.radians(15.0)
"""Standard deviation of the angle that the most active joint must have over all registrations."""

FEWEST, FEWEST_PEOPLE, FEWEST_OF_A_HAND = 20, 2, 3
"""Registrations that count, people, and registrations of one hand of a person from which on they count."""


@dataclass(frozen=True)
class TrainingHand:
    """One registration: whose it is, whether of a left hand, and its number of vertices."""

    subject: str
    is_left: bool
    vertices: int


def find_training_faults(
    hands: Sequence[TrainingHand], name: str, side: str, vertices: int, with_mirrored: bool = True
) -> list[str]:
    """Why a model cannot be trained, in sentences for people; empty when it can be.

    Args:
        hands: The registrations to learn from.
        name: Of the model that training begins with.
        side: Of that model.
        vertices: Of that model.
        with_mirrored: Whether left hands count, mirrored.
    """
    faults = []
    if side != "right":
        faults.append(f"{name} is a {side} hand; training begins with a right one. Choose another model to begin with.")
    if others := sorted({hand.vertices for hand in hands} - {vertices}):
        faults.append(
            f"Some registrations have {' or '.join(map(str, others))} vertices, {name} has {vertices}. Begin with the "
            "model that the scans were registered with, or register them again with this one."
        )
    return faults + _find_want(hands, with_mirrored)


def _find_want(hands: Sequence[TrainingHand], with_mirrored: bool) -> list[str]:
    """The sentence that says how many registrations and people are missing."""
    counts = Counter((hand.subject, hand.is_left) for hand in hands if with_mirrored or not hand.is_left)
    kept = {hand: count for hand, count in counts.items() if count >= FEWEST_OF_A_HAND}
    count, people = sum(kept.values()), len({subject for subject, _ in kept})
    if count >= FEWEST and people >= FEWEST_PEOPLE:
        return []
    of = f"{_count(count, 'registration')} of {_count(people, 'person', 'people')}"
    said = f"There are {of}; a model needs {FEWEST} of at least {FEWEST_PEOPLE} people."
    if count < len(hands):
        left = "" if with_mirrored else " and left hands are left out"
        said += (
            f" {_count(len(hands) - count, 'registration does', 'registrations do')} not count: a hand needs at least "
            f"{FEWEST_OF_A_HAND} of its own{left}."
        )
    return [f"{said} Register and accept more scans."]


def _count(number: int, one: str, many: str = "") -> str:
    return f"{number} {one if number == 1 else many or one + 's'}"


def find_bend_fault(turns: npt.NDArray[np.float64]) -> str | None:
    """Why the bending of fingers cannot be learnt from these poses; None when it can.

    Args:
        turns: (N, B, 3) axis-angle of each registration's joints, without the root.
    """
    spread = float(np.sqrt(((turns - turns.mean(0)) ** 2).sum(2).mean(0)).max()) if len(turns) else 0.0
    if spread >= LEAST_BEND:
        return None
    return (
        f"The hands hardly move: no joint's angle varies by more than {np.degrees(spread):.0f} degrees over the "
        "registrations. Add scans of poses in which fingers bend."
    )
