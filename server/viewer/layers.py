"""Which layers of a scene are shown, and in which colours."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from tracker.inspection import FrameView, ModelView

Color = tuple[int, int, int]

FINGER_COLORS: dict[str, Color] = {
    "thumb": (250, 82, 82),
    "index": (252, 196, 25),
    "middle": (81, 207, 102),
    "ring": (34, 184, 207),
    "little": (204, 93, 232),
}
"""The five hues fingers keep in every skeleton."""

WRIST_COLOR: Color = (206, 212, 218)


def term_color(term: str, dark: bool = True) -> Color:
    """Colour of the correspondences of a term, on dark or white ground."""
    from tracker.inspection import find_term_look

    look = find_term_look(term)
    red, green, blue = bytes.fromhex((look.color if dark else look.color_on_white)[1:])
    return red, green, blue


def joint_colors(model: ModelView) -> npt.NDArray[np.uint8]:
    """(J, 3) colours of a model's joints: each its finger's and grey for the wrist, or the object's own."""
    if model.name not in ("right", "left"):
        return repeat(model.color, len(model.joints))
    return hand_colors()


def hand_colors() -> npt.NDArray[np.uint8]:
    """(21, 3) colours of a hand's joints: each its finger's and grey for the wrist."""
    from tracker import HAND_JOINTS

    fingers = [FINGER_COLORS.get(joint.partition("_")[0], WRIST_COLOR) for joint in HAND_JOINTS]
    return np.array(fingers, dtype=np.uint8)


def repeat(color: Color, count: int) -> npt.NDArray[np.uint8]:
    """(N, 3) of one colour."""
    return np.tile(np.array(color, dtype=np.uint8), (count, 1))


@dataclass(frozen=True)
class Layers:
    """What is visible. A term is visible when `correspondences` is true and it is not in `hidden_terms`."""

    cloud: bool = True
    mesh: bool = True
    skeleton: bool = False
    correspondences: bool = False
    detections: bool = False
    collisions: bool = False
    contacts: bool = False
    unknown: bool = False
    distances: bool = False
    cameras: bool = False
    hidden_terms: frozenset[str] = field(default_factory=frozenset)
    dark: bool = True

    def with_changes(self, changes: dict[str, Any]) -> Layers:
        """Layers after `changes`, such as `{"cloud": False, "correspondences": {"model_to_data": True}}`.

        For correspondences a mapping of terms shows those that are true and hides those that are false; the layer is
        on, even if every term is hidden.
        """
        changes = dict(changes)
        result = self
        terms = changes.get("correspondences")
        if isinstance(terms, dict):
            hidden = (self.hidden_terms | {t for t, on in terms.items() if not on}) - {
                t for t, on in terms.items() if on
            }
            changes["correspondences"] = True
            result = replace(result, hidden_terms=frozenset(hidden))
        known = {name: bool(value) for name, value in changes.items() if name in LAYER_NAMES}
        return replace(result, **known)

    def shows_term(self, term: str) -> bool:
        return self.correspondences and term not in self.hidden_terms

    @property
    def is_inside_shown(self) -> bool:
        """Whether what is shown lies on and in the meshes, which then let more through."""
        return self.detections or self.collisions or self.contacts

    def prepare(self, view: FrameView) -> None:
        """Have a frame work out what these layers show."""
        for name, attribute in VIEW_ATTRIBUTES.items():
            if getattr(self, name):
                getattr(view, attribute)


LAYER_NAMES = (
    "cloud",
    "mesh",
    "skeleton",
    "correspondences",
    "detections",
    "collisions",
    "contacts",
    "unknown",
    "distances",
    "cameras",
    "dark",
)

VIEW_ATTRIBUTES = {
    "cloud": "cloud",
    "mesh": "models",
    "skeleton": "models",
    "correspondences": "correspondences",
    "detections": "detections",
    "collisions": "collisions",
    "contacts": "contacts",
    "unknown": "unknown",
    "distances": "surface_fit",
    "cameras": "cameras",
}
"""Layer to what of a `FrameView` it shows."""
