"""The hand that comes with Handloom, made from MakeHuman's CC0 data by `scripts/build_default_hand.py`."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from tracker.model.articulated import ArticulatedModel
from tracker.model.mirroring import mirror
from tracker.model.npz_files import load_npz_model

DATA = Path(__file__).parent / "data" / "hand_right.npz"


@cache
def default_hand(side: str) -> ArticulatedModel:
    """The default hand; the left one is the mirror image of the right.

    Its frame: origin at the wrist, x towards the middle knuckle, z out of the back of the hand; y towards the thumb of
    a right hand and away from that of a left hand. 20 bones, 31 revolute joints (their signs: `hand_axes`), about 1,500
    faces, 20 mm of forearm.

    Args:
        side: "right" or "left".
    """
    assert side in ("right", "left"), f"side is {side!r}, not 'right' or 'left'"
    right = load_npz_model(DATA)
    return right if side == "right" else mirror(right)
