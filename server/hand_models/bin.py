"""Hand models in the bin."""

from __future__ import annotations

from server.bin.kinds import make_kind
from server.hand_models.models import HandModelRow
from server.hand_models.service import AREA

HAND_MODELS = make_kind("hand_model", "hand model", HandModelRow, AREA)
