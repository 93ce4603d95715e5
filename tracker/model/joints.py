"""The 21 joints of a hand, in the order every file and page of Handloom uses."""

from __future__ import annotations

FINGERS: tuple[str, ...] = ("thumb", "index", "middle", "ring", "little")

SIDES = ("right", "left")

HAND_JOINTS: tuple[str, ...] = (
    "wrist",
    *("thumb_cmc", "thumb_mcp", "thumb_ip", "thumb_tip"),
    *(f"{finger}_{joint}" for finger in FINGERS[1:] for joint in ("mcp", "pip", "dip", "tip")),
)

HAND_EDGES: tuple[tuple[int, int], ...] = tuple(
    edge
    for base in (1, 5, 9, 13, 17)
    for edge in ((0, base), (base, base + 1), (base + 1, base + 2), (base + 2, base + 3))
)
"""Pairs of joints to draw a line between: wrist to finger base, then along the finger."""
