"""The hand models there are. So far those that come with Handloom."""

from __future__ import annotations

import uuid
from functools import cache
from typing import TYPE_CHECKING

from server.hand_models.schemas import HandModelOut

if TYPE_CHECKING:
    from tracker import ArticulatedModel

NAMESPACE = uuid.UUID("6d9a0f4e-64d5-4f0e-9a39-0b8f3f4c6f11")
"""Of the ids of models that come with Handloom: they are the same everywhere."""


@cache
def list_hand_models() -> tuple[HandModelOut, ...]:
    """The default right and left hand."""
    from tracker import default_hand  # loads numba: not before somebody asks

    return tuple(_describe(default_hand(side)) for side in ("right", "left"))


def _describe(model: ArticulatedModel) -> HandModelOut:
    assert model.hand is not None
    return HandModelOut(
        id=uuid.uuid5(NAMESPACE, f"default/{model.hand.side}"),
        name=model.name,
        side="right" if model.hand.side == "right" else "left",
        vertices=len(model.vertices),
        faces=len(model.faces),
        bones=list(model.skeleton.bone_names),
        degrees_of_freedom=model.num_dofs,
        shape_parameters=[] if model.shape is None else list(model.shape.names),
        provenance=model.provenance,
    )
