"""Where a joint in an annotation came from: placed by hand, or a suggestion that a person accepted."""

from __future__ import annotations

import uuid
from dataclasses import dataclass

from tracker.capture.document import Node

SOURCE_KINDS = ("track", "fit", "detector", "triangulation", "interpolation", "copy", "import")


@dataclass(frozen=True)
class JointSource:
    """What a person accepted for a joint instead of placing it.

    Attributes:
        kind: `track`, `fit` (a model fitted to other joints), `detector` (the hand detector's own), `triangulation`
            (from other cameras), `interpolation` (between key frames), `copy` (of another frame's pose) or `import`
            (with a file).
        label: For people, after "from": "Track 2", "model fit of 7 joints".
        track_id: The track it is of.
        model: Name of the hand model behind it.
        is_independent: Of a triangulation, an interpolation or a copy: no track, no fit and no detector had a part
            in any joint that it was made of. False also where nobody noted it.
    """

    kind: str
    label: str = ""
    track_id: uuid.UUID | None = None
    model: str = ""
    is_independent: bool = False

    def to_json(self) -> dict:
        """Its entry in `annotations.json`; what is not known is left out."""
        members = {"label": self.label, "track_id": str(self.track_id or ""), "model": self.model}
        document: dict = {"kind": self.kind} | {name: text for name, text in members.items() if text}
        return document | ({"is_independent": True} if self.is_independent else {})

    @staticmethod
    def from_json(entry: dict) -> JointSource:
        """From what `to_json` gave."""
        track_id = entry.get("track_id")
        track = uuid.UUID(track_id) if track_id else None
        independent = bool(entry.get("is_independent", False))
        return JointSource(entry["kind"], entry.get("label", ""), track, entry.get("model", ""), independent)


JointSources = tuple[JointSource | None, ...]
"""Of the 21 joints; None: placed by hand, or not placed at all."""


def parse_source(node: Node) -> JointSource | None:
    """From an entry of `annotations.json`."""
    if node.value is None:
        return None
    track_id = None
    if node.has("track_id"):
        try:
            track_id = uuid.UUID(node.get("track_id").text(36))
        except ValueError:
            node.get("track_id").fail("the id of a track, a UUID")
    kind = node.get("kind").choice(*SOURCE_KINDS)
    is_independent = node.get("is_independent").value if node.has("is_independent") else False
    if not isinstance(is_independent, bool):
        node.get("is_independent").fail("true or false")
    return JointSource(kind, _parse_text(node, "label"), track_id, _parse_text(node, "model"), is_independent)


def _parse_text(node: Node, name: str) -> str:
    is_said = node.has(name) and node.get(name).value != ""
    return node.get(name).text(200) if is_said else ""
