"""The learnt hands that come with Handloom and that recordings can be tracked with in place of the default hand."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tracker.model.blend_model import BlendModel


@dataclass(frozen=True)
class BuiltInHand:
    """A hand by its name in commands and params.

    Attributes:
        name: In `--hand NAME` and in a job's `hand_model_id`.
        label: For people, in forms.
        title: Of its right hand, in the list of models.
        load: The hand of a side, "right" or "left".
    """

    name: str
    label: str
    title: str
    load: Callable[[str], BlendModel]


def _load_trained(side: str) -> BlendModel:
    from tracker.model.trained_hand import trained_hand

    return trained_hand(side)


BUILT_IN_HANDS = {
    "trained": BuiltInHand(
        "trained",
        "The hand learnt from scans of generated people",
        "Trained right hand (generated people)",
        _load_trained,
    )
}
"""By name. Commands, forms, jobs and the list of models offer each of them."""
