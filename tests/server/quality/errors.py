"""Mistakes that annotators make, put into labels that are right."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

KINDS = ("swapped hands", "swapped fingers", "shifted joint", "jump", "on the background", "outside")


@dataclass
class Item:
    """An annotation as the API takes it."""

    frame: int
    hand: str
    points: np.ndarray


def inject(items: list[Item], kind: str, frame: int, rng: np.random.Generator) -> None:
    """Make one mistake in a frame."""
    here = [item for item in items if item.frame == frame]
    item = here[int(rng.integers(len(here)))]
    points = item.points
    centre = points[:, :2].mean(axis=0)
    if kind == "swapped hands":
        assert len(here) == 2
        here[0].points, here[1].points = here[1].points, here[0].points
    elif kind == "swapped fingers":
        first = int(rng.integers(1, 4))
        a, b = slice(1 + 4 * first, 5 + 4 * first), slice(5 + 4 * first, 9 + 4 * first)
        points[a], points[b] = points[b].copy(), points[a].copy()
    elif kind == "shifted joint":
        angle = rng.uniform(0, 2 * np.pi)
        joint = int(rng.integers(1, 21))
        points[joint, :2] += 30 * np.array([np.cos(angle), np.sin(angle)])
    elif kind == "jump":
        finger = int(rng.integers(5))
        points[1 + 4 * finger : 5 + 4 * finger, :2] += rng.choice([-1, 1], 2) * 25
    elif kind == "on the background":
        tip = 4 * int(rng.integers(1, 6))
        out = points[tip, :2] - points[0, :2]
        points[tip, :2] += 25 * out / np.linalg.norm(out)
        points[tip, 2] = 2
    elif kind == "outside":
        points[int(rng.integers(21)), 0] = -6.0
    else:
        raise AssertionError(kind)
    assert np.isfinite(centre).all()
