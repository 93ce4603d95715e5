"""Where each joint of an annotation came from, as the database keeps it: 21 entries, null where a hand placed it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from tracker.capture import JointSource, JointSources

JOINT_COUNT = 21


def read_sources(stored: list[Any] | None) -> JointSources | None:
    """As the tracker's annotations have them."""
    if stored is None:
        return None
    return tuple(None if entry is None else JointSource.from_json(entry) for entry in stored)


def write_sources(sources: JointSources | None) -> list[Any] | None:
    """As the database keeps them."""
    return None if sources is None else [None if source is None else source.to_json() for source in sources]


def imported_sources(points: Sequence[Sequence[float]], label: str) -> list[Any]:
    """Of joints that came in a file which does not say more."""
    source = JointSource("import", label).to_json()
    return [source if is_decided(point) else None for point in points]


def carry_sources(before: list[Any] | None, was: list[Any] | None, points: list[Any]) -> list[Any]:
    """When nobody says: joints that stay keep theirs, what moved was placed by hand."""
    if before is None or was is None:
        return [None] * JOINT_COUNT
    return [source if old[:2] == new[:2] else None for source, old, new in zip(before, was, points, strict=True)]


def settle_sources(
    before: list[Any] | None, was: list[Any] | None, points: list[Any] | None, said: list[Any] | None
) -> list[Any] | None:
    """Of new joints: what was said of them, or carried; a deleted annotation has none."""
    if points is None:
        return None
    return carry_sources(before, was, points) if said is None else said


def is_decided(point: Sequence[float]) -> bool:
    """Somebody placed the joint or said that it is not in the image: v = 0 with a position other than (0, 0)."""
    return bool(point[2]) or bool(point[0]) or bool(point[1])


def count_decided(points: list[Any] | None) -> int:
    """Joints that need nobody any more."""
    return sum(map(is_decided, points or ()))
