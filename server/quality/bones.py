"""Checks of bone lengths: in space where there is depth, in the image otherwise."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from server.quality.finding import Finding, Looked
from server.quality.hand import EDGES, find_bone_lengths, joint_name
from server.quality.labels import Label, find_median
from server.quality.usual import SPREADS

if TYPE_CHECKING:
    from tracker import Camera

Array = npt.NDArray[np.float64]


def check_bone_lengths(labels: Sequence[Label], cameras: dict[str, Camera], looked: Looked) -> Iterator[Finding]:
    """Bones longer or shorter in space than this hand's usually are; without depth, far too long for their hand."""
    lengths = find_bone_lengths()
    in_space: dict[str, list[tuple[Label, Array]]] = defaultdict(list)
    for label in labels:
        in_space[label.hand].append((label, _possible_lengths(label, cameras[label.camera].K)))
    for items in in_space.values():
        usual, limit = limit_bones(np.stack([possible[MIDDLE] for _, possible in items]))
        for label, possible in items:
            found = possible[MIDDLE]
            if np.isfinite(found).any() or _count_flat(label) >= LEAST_FLAT:
                looked.at("bone_length", label)
            off = _find_least(np.abs(possible - usual)) / limit
            if np.isfinite(off).any() and np.nanmax(off) > 1:
                bone = int(np.nanargmax(off))
                a, b = EDGES[bone]
                reason = (
                    f"{joint_name(a)} to {joint_name(b)} is {1e3 * found[bone]:.0f} mm; "
                    f"in this recording it usually is {1e3 * usual[bone]:.0f} mm."
                )
                yield Finding(
                    label, "bone_length", min(10.0, float(off[bone])), (int(a), int(b)), reason[0].upper() + reason[1:]
                )
            elif not np.isfinite(found).any() and (finding := _flat_bone(label, lengths)):
                yield finding


SMALLEST, LARGEST = 0.6, 1.5
"""No hand's bones are shorter or longer than these times the default hand's, however many labels say so."""
LEAST_FLAT = 8
"""Bones that must be seen in an image to know how long bones look in it."""
MIDDLE = 4
"""The row of `_possible_lengths` with the median depth at both ends."""


def limit_bones(table: Array, least: float = 0.015, share: float = 0.15) -> tuple[Array, Array]:
    """How long bones are in this recording, and how far from that a length may be: (20,) m each, of (N, 20) m.

    A length may be off by `least`, m, and that share of the bone, or by what is usual. With depth at both ends that
    much is nothing, as pixels at a finger's edge may show what is behind.
    """
    lengths = find_bone_lengths()
    enough = np.isfinite(table).sum(axis=0) >= 5
    usual = np.where(enough, np.clip(find_median(table, axis=0), SMALLEST * lengths, LARGEST * lengths), lengths)
    spread = np.where(enough, 1.4826 * find_median(np.abs(table - usual), axis=0), 0.006)
    return usual, np.maximum(least + share * usual, SPREADS * spread)


def _possible_lengths(label: Label, K: Array) -> Array:
    """(9, 20) m: length of each bone for three depths that either end may have."""
    rays = np.column_stack([(label.pixels - K[:2, 2]) / K[[0, 1], [0, 1]], np.ones(21)])
    points = rays * label.depth_range[:, :, None]  # (3, 21, 3)
    apart = points[:, None, EDGES[:, 0]] - points[None, :, EDGES[:, 1]]
    return np.linalg.norm(apart, axis=3).reshape(9, len(EDGES))


def _find_least(values: Array) -> Array:
    """The least of each column; NaN where nothing is known."""
    return np.where(
        np.isfinite(values).any(axis=0), np.min(np.where(np.isfinite(values), values, np.inf), axis=0), np.nan
    )


def _count_flat(label: Label) -> int:
    """Bones of which both ends are placed."""
    return int(label.is_placed[EDGES].all(axis=1).sum())


def _flat_bone(label: Label, lengths: Array) -> Finding | None:
    """A bone that looks too long beside the others: turning away makes bones look shorter only."""
    seen = np.linalg.norm(label.pixels[EDGES[:, 0]] - label.pixels[EDGES[:, 1]], axis=1) / lengths
    if _count_flat(label) < LEAST_FLAT:
        return None
    usual = float(np.nanpercentile(seen, 75))
    off = seen / (1.7 * usual)
    bone = int(np.nanargmax(off))
    if off[bone] <= 1:
        return None
    a, b = (int(joint) for joint in EDGES[bone])
    times = f"{1.7 * off[bone]:.1f} times"
    reason = f"{joint_name(a)} to {joint_name(b)} looks {times} as long as the other bones of this hand."
    return Finding(label, "bone_length", min(10.0, float(off[bone])), (a, b), reason[0].upper() + reason[1:])
