"""How a term of the objective is named and coloured wherever people see it."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class TermLook:
    """Of one term; no two have the same colour, also for people who are colour-blind.

    Attributes:
        name: In the objective and in the costs of a track.
        label: For people.
        color: "#rrggbb", on dark ground.
        color_on_white: "#rrggbb", on white ground.
        dash: Strokes and gaps of its curve, px; empty for an unbroken one.
    """

    name: str
    label: str
    color: str
    color_on_white: str
    dash: tuple[int, ...] = ()
