"""The hands of a recording that most need a person, the worst first."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from server.quality.detections import check_bones_in_space, check_detections
from server.quality.doubt import Doubt
from server.quality.find import Setting
from server.quality.fit import check_fit, check_labels_seen, check_track
from server.quality.labels import Label
from server.quality.views import triangulate_views


@dataclass(frozen=True)
class Queued:
    """A hand in a frame.

    Attributes:
        score: 1 is where something begins to look wrong; more is worse. The root of the sum of the doubts' squares:
            the worst one counts most, and several that agree count more than one.
        doubts: Why, the worst first: those that look wrong, else the one nearest to it.
    """

    frame: int
    hand: str
    score: float
    doubts: tuple[Doubt, ...]

    @property
    def order(self) -> tuple[int, int, str]:
        """The place in the queue."""
        return -round(1e6 * self.score), self.frame, self.hand


def find_doubts(setting: Setting) -> list[Doubt]:
    """What speaks against the track and the detector, whatever the labels are."""
    tracked, detected = setting.tracked, setting.detected
    return [
        *check_track(tracked, detected),
        *check_fit(tracked.joints, detected.joints),
        *check_detections(detected.joints, setting.cameras),
    ]


def find_label_doubts(labels: Sequence[Label], setting: Setting) -> Iterator[Doubt]:
    """What speaks against labels besides the label check, above all against those accepted from a suggestion."""
    yield from check_labels_seen(labels, setting.tracked.joints, setting.detected.joints)
    marks = {(label.camera, label.frame, label.hand): label.pixels for label in labels}
    yield from check_bones_in_space(triangulate_views(marks, setting.cameras), "the labels of all cameras")


def queue_hands(doubts: Iterable[Doubt], labels: Sequence[Label]) -> list[Queued]:
    """Every hand that anything is known of, once.

    Where a picture is labelled the label is looked at in place of the fit. Where a person placed the hand there by
    themselves, only the label check speaks about it.
    """
    labelled = {(label.camera, label.frame, label.hand) for label in labels}
    settled = {(label.camera, label.frame, label.hand) for label in labels if is_by_hand(label)}
    looked_at = {(frame, hand) for _, frame, hand in settled}
    by_hand: dict[tuple[int, str], list[Doubt]] = defaultdict(list)
    for doubt in doubts:
        place = doubt.camera, doubt.frame, doubt.hand
        if doubt.kind == "flag":
            is_answered = False
        elif doubt.camera:
            is_answered = place in (labelled if doubt.kind == "fit" else settled)
        else:
            is_answered = (doubt.frame, doubt.hand) in looked_at
        if not is_answered:
            by_hand[doubt.frame, doubt.hand].append(doubt)
    return sorted((_queue(*place, found) for place, found in by_hand.items()), key=lambda one: one.order)


def is_by_hand(label: Label) -> bool:
    """A person placed it: neither a track nor the detector had a part in any joint."""
    return bool(label.is_placed.any() and label.is_independent[label.is_placed].all())


def _queue(frame: int, hand: str, found: Sequence[Doubt]) -> Queued:
    """One hand; every kind of doubt counts once, by the worst of it."""
    worst: dict[tuple[str, str], Doubt] = {}
    for doubt in sorted(found, key=lambda one: (-one.score, one.kind, one.camera, one.flag)):
        worst.setdefault((doubt.kind, doubt.flag), doubt)
    first = list(worst.values())
    told = tuple(doubt for doubt in first if doubt.score >= 1.0) or tuple(first[:1])
    return Queued(frame, hand, float(np.linalg.norm([doubt.score for doubt in told])), told)
