"""Hand models for the browser and for other people's software."""

from __future__ import annotations

import tempfile
import uuid
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from sqlalchemy.orm import Session

from server.hand_models import storing
from server.hand_models.models import HandModelRow
from server.hand_models.service import get_hand_model
from server.scans.geometry import pack_arrays
from server.storage import Storage

if TYPE_CHECKING:
    from tracker import BlendModel


MANO_VERTICES, MANO_MIRROR = 778, np.array([-1.0, 1.0, 1.0])
"""A model with MANO's own vertices stands in MANO's axes, in which its left hand mirrors the right one's x."""


def open_any_model(session: Session, storage: Storage, model_id: uuid.UUID) -> BlendModel:
    """A stored model, or the untrained one, which is stored only when somebody uses it."""
    if model_id == storing.UNTRAINED_ID and session.get(HandModelRow, model_id) is None:
        from tracker import untrained_hand

        return untrained_hand("right")
    return storing.open_model(storage, get_hand_model(session, model_id))


def pack_model(model: BlendModel) -> bytes:
    """The mesh at rest, what turns it the right way up, and its shape space."""
    arrays = {
        "vertices": model.template.astype(np.float32),
        "faces": model.faces.astype(np.uint32),
        "joints": model.joints_of(model.template).astype(np.float32),
        "tips": model.tips.astype(np.uint32),
        "shape_directions": model.shape_directions.astype(np.float32),
    }
    return pack_arrays(arrays, {"side": model.side, "shape_count": model.num_shape})


def write_mano(model: BlendModel, side: str) -> bytes:
    """The bytes of a MANO file that `smplx` loads; the other hand is the mirror image."""
    from tracker import save_mano

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"MANO_{side.upper()}.pkl"
        save_mano(model if model.side == side else _other_hand(model), path)
        return path.read_bytes()


def _other_hand(model: BlendModel) -> BlendModel:
    from tracker import mirror_blend

    return mirror_blend(model, MANO_MIRROR) if len(model.template) == MANO_VERTICES else mirror_blend(model)
