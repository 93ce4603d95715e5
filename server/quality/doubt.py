"""Something about a hand in a frame that a person should look at, labelled or not."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from server.quality.finding import Finding
from server.quality.labels import Label

DoubtKind = Literal["lost", "unseen", "depth", "fit", "label", "left_out", "bones", "flag"]


@dataclass(frozen=True)
class Doubt:
    """One reason to look at a hand.

    Attributes:
        score: 1 is where something begins to look wrong, as of a `Finding`.
        camera: The one that it is about; empty where it is about all.
        joints: Those meant; none: the whole hand.
        reason: A sentence.
        label: The label that it is about, if it is about one.
        flag: The label check's kind, where it comes from there.
    """

    frame: int
    hand: str
    kind: DoubtKind
    score: float
    camera: str
    joints: tuple[int, ...]
    reason: str
    label: Label | None = None
    flag: str = ""


def doubt_label(finding: Finding) -> Doubt:
    """What the label check found, as a reason to look."""
    label = finding.label
    return Doubt(
        label.frame,
        label.hand,
        "flag",
        finding.score,
        label.camera,
        finding.joints,
        finding.reason,
        label,
        finding.kind,
    )
