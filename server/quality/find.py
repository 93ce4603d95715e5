"""All checks of a recording's labels, and what each of them could look at."""

from __future__ import annotations

import uuid
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from server.quality.background import check_background
from server.quality.bones import check_bone_lengths
from server.quality.evidence import check_detected, check_reprojection, check_residuals
from server.quality.finding import KINDS, Finding, Kind, Looked
from server.quality.labels import Label
from server.quality.neighbours import check_handedness, check_jumps
from server.quality.one_label import check_depth, check_finger_order, check_outside
from server.quality.witnesses import Detections, TrackedHands

if TYPE_CHECKING:
    from tracker import Camera


@dataclass(frozen=True)
class Setting:
    """What is known of the recording.

    Attributes:
        hands: Those that are said to be seen.
        cameras: By id.
        has_depth: Any camera has depth images.
        tracked: The hands of the track that labels are compared with.
        detected: What the hand detector found in the whole recording.
        track_missing: Why a label may have no track to be compared with.
    """

    hands: tuple[str, ...]
    cameras: dict[str, Camera]
    has_depth: bool = True
    tracked: TrackedHands = field(default_factory=TrackedHands)
    detected: Detections = field(default_factory=Detections)
    track_missing: str = "there is no track"


@dataclass(frozen=True)
class Coverage:
    """What one check could look at.

    Attributes:
        kind: Of the check.
        labels: Places that it looked at.
        missing: What it lacked for the others, a sentence; empty where it looked at all.
    """

    kind: Kind
    labels: frozenset[uuid.UUID]
    missing: str


@dataclass(frozen=True)
class LabelCheck:
    """What all checks found, the worst first, and what they looked at."""

    findings: list[Finding]
    coverage: list[Coverage]


def find_flags(labels: Sequence[Label], setting: Setting) -> list[Finding]:
    """What looks wrong, the worst first; of each kind at most one for a label."""
    return check_labels(labels, setting).findings


def check_labels(labels: Sequence[Label], setting: Setting) -> LabelCheck:
    """Every check of every label."""
    sizes = {name: (camera.width, camera.height) for name, camera in setting.cameras.items()}
    looked = Looked()
    worst: dict[tuple, Finding] = {}
    for finding in (
        *check_outside(labels, sizes, looked),
        *check_finger_order(labels, looked),
        *check_depth(labels, looked),
        *check_background(labels, setting.cameras, looked),
        *check_bone_lengths(labels, setting.cameras, looked),
        *check_handedness(labels, setting.hands, looked),
        *check_jumps(labels, looked),
        *check_reprojection(labels, setting.cameras, looked),
        *check_residuals(labels, setting.tracked.joints, looked),
        *check_detected(labels, setting.detected.joints, looked),
    ):
        key = finding.label.id, finding.kind
        if key not in worst or finding.score > worst[key].score:
            worst[key] = finding
    order = sorted(worst.values(), key=lambda one: (-round(1e6 * one.score), str(one.label.id), one.kind))
    coverage = [_describe_coverage(kind, looked.find(kind), labels, setting) for kind in KINDS]
    return LabelCheck(order, coverage)


def _describe_coverage(kind: Kind, found: frozenset[uuid.UUID], labels: Sequence[Label], setting: Setting) -> Coverage:
    return Coverage(kind, found, _say_missing(kind, setting) if len(found) < len(labels) else "")


def _say_missing(kind: Kind, setting: Setting) -> str:
    """What a check needs that the labels it did not look at do not have."""
    if kind == "residual":
        return setting.track_missing
    if kind == "reprojection" and len(setting.cameras) < 2:
        return "this recording has one camera"
    if kind == "depth" and not setting.has_depth:
        return "this recording has no depth"
    return MISSING[kind]


MISSING: dict[Kind, str] = {
    "outside": "",
    "finger_order": "needs a finger with all its joints",
    "bone_length": "needs depth at both ends of a bone, or 8 bones in the image",
    "depth": "needs 4 visible joints with depth around them",
    "background": "needs depth, or an image whose background was cut out",
    "handedness": "needs a labelled frame within 15 frames",
    "jump": "needs the same hand labelled within 15 frames",
    "reprojection": "needs the same joint marked in another camera",
    "residual": "",
    "detector": "a track or neighbouring labels say more, or the hand detector has not looked through this recording",
}
