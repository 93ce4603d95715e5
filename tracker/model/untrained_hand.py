"""The crude hand that scans are first registered with, made by `scripts/build_untrained_hand.py`."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from tracker.model.blend_files import load_blend_model
from tracker.model.blend_mirroring import mirror_blend
from tracker.model.blend_model import BlendModel


@cache
def untrained_hand(side: str = "right") -> BlendModel:
    """The hand that registration starts with, without pose blend shapes; the left one is the mirror image.

    Its frame is the default hand's: origin at the wrist, x towards the middle knuckle, z out of the back of the hand, y
    towards the thumb of a right hand and away from that of a left one. MANO's 16 joints; open 10 mm behind the wrist.

    Args:
        side: "right" or "left".
    """
    assert side in ("right", "left"), f"side is {side!r}, not 'right' or 'left'"
    right = load_blend_model(Path(__file__).parent / "data" / "untrained_hand.npz")
    return right if side == "right" else mirror_blend(right)
