"""The hand that was learnt from scans and comes with Handloom, made by `scripts/build_trained_hand.py`."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from tracker.model.blend_files import load_blend_model
from tracker.model.blend_mirroring import mirror_blend
from tracker.model.blend_model import BlendModel

DATA = Path(__file__).parent / "data" / "trained_hand.npz"


@cache
def trained_hand(side: str = "right") -> BlendModel:
    """A hand of MANO's class that Handloom learnt from its own registrations of generated people's scans.

    Its frame and the order of its vertices are the untrained hand's. CC0, as all that it is made from.

    Args:
        side: "right" or "left".
    """
    assert side in ("right", "left"), f"side is {side!r}, not 'right' or 'left'"
    right = load_blend_model(DATA)
    return right if side == "right" else mirror_blend(right)
