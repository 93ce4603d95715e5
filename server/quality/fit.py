"""How the track, or a label, fares in a frame: lost, far from the depth, far from what the hand detector saw."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from server.quality.doubt import Doubt
from server.quality.evidence import APART_PX, APART_SHARE, DETECTOR_PX, DETECTOR_SHARE, LEAST_JOINTS
from server.quality.hand import joint_name
from server.quality.labels import Label, find_median
from server.quality.usual import compare_with_usual
from server.quality.views import Marks, measure_size
from server.quality.witnesses import Detections, TrackedHands

Place = tuple[str, int, str]
"""Camera, frame, hand."""

LOST = 3.0
"""A hand that is seen and was lost has no suggestion at all: that comes before any that are a little off."""
DEPTH_MM = 5.0
"""Half a finger's width, and three times a depth camera's noise at arm's length: nearer than this is no misfit."""


def check_track(tracked: TrackedHands, detected: Detections) -> Iterator[Doubt]:
    """Hands that the track lost, has where the detector sees none, or has far from the depth."""
    seen = {(frame, hand) for _, frame, hand in detected.joints}
    for frame, hand in sorted(tracked.lost):
        if (frame, hand) in seen:
            reason = "The track lost the hand here, and the detector sees it."
        else:
            reason = "The track lost the hand here; it may be out of sight."
        yield Doubt(frame, hand, "lost", LOST if (frame, hand) in seen else 1.0, "", (), reason)
    for frame, hand in sorted({(frame, hand) for _, frame, hand in tracked.joints} - seen):
        if frame in detected.frames:
            reason = "The track has a hand here, and the detector sees none in any camera."
            yield Doubt(frame, hand, "unseen", 1.0, "", (), reason)
    yield from _check_depth(tracked)


def _check_depth(tracked: TrackedHands) -> Iterator[Doubt]:
    """The distance is one of all hands of a frame together."""
    if not tracked.depth_mm:
        return
    frames = list(tracked.depth_mm)
    apart = np.array([[tracked.depth_mm[frame]] for frame in frames])
    off, usual = compare_with_usual(apart, np.full(len(frames), DEPTH_MM))
    for frame, hand in sorted({(frame, hand) for _, frame, hand in tracked.joints}):
        if frame in tracked.depth_mm:
            row = frames.index(frame)
            reason = f"The fit is {apart[row, 0]:.1f} mm from the depth; usually it is {usual[0]:.1f} mm."
            yield Doubt(frame, hand, "depth", min(10.0, float(off[row, 0])), "", (), reason)


@dataclass(frozen=True)
class Witness:
    """What hands are compared with.

    Attributes:
        name: For people.
        marks: Where it has them.
        least_px: Where half the joints are nearer than this it does not disagree,
        least_share: nor where they are nearer than this share of the hand.
    """

    name: str
    marks: Marks
    least_px: float
    least_share: float

    @classmethod
    def detector(cls, marks: Marks) -> Witness:
        return cls("what the detector saw", marks, DETECTOR_PX, DETECTOR_SHARE)

    @classmethod
    def track(cls, marks: Marks) -> Witness:
        return cls("the track", marks, APART_PX, APART_SHARE)


def check_fit(tracked: Marks, detected: Marks) -> Iterator[Doubt]:
    """The track, projected, against what the detector saw in each camera."""
    for place, score, joints, reason in _compare("fit", tracked, Witness.detector(detected)):
        yield Doubt(place[1], place[2], "fit", score, place[0], joints, reason)


def check_labels_seen(labels: Sequence[Label], tracked: Marks, detected: Marks) -> Iterator[Doubt]:
    """Labels against the detector and the track, joints that were accepted from a suggestion as all others.

    A label is at no distance from what it was accepted from: that neither speaks for it nor against it.
    """
    by_place = {(label.camera, label.frame, label.hand): label for label in labels}
    marks = {place: label.pixels for place, label in by_place.items()}
    for witness in (Witness.detector(detected), Witness.track(tracked)):
        for place, score, joints, reason in _compare("label", marks, witness):
            yield Doubt(place[1], place[2], "label", score, place[0], joints, reason, by_place[place])


def _compare(what: str, marks: Marks, witness: Witness) -> Iterator[tuple[Place, float, tuple[int, ...], str]]:
    """Place, score, joints and reason of every hand that both have: of all its joints, or of one that alone is off.

    A single joint is compared with what is usual for it, so that a finger's width is enough.
    """
    for hand in ("right", "left"):
        places = sorted(place for place in marks if place in witness.marks and place[2] == hand)
        if not places:
            continue
        distances = np.stack([np.linalg.norm(marks[place] - witness.marks[place], axis=1) for place in places])
        sizes = np.array([measure_size(witness.marks[place]) for place in places])
        least = np.maximum(witness.least_px, witness.least_share * sizes)
        whole = find_median(distances, axis=1) / least
        single, usual = compare_with_usual(distances, np.maximum(APART_PX, APART_SHARE * sizes))
        for row, place in enumerate(places):
            if np.isfinite(distances[row]).sum() < LEAST_JOINTS:
                continue
            joint = int(np.nanargmax(single[row]))
            score = min(10.0, float(max(whole[row], single[row, joint])))
            if whole[row] < 1.0 < single[row, joint]:
                reason = (
                    f"The {joint_name(joint)} of the {what} is {distances[row, joint]:.0f} px from {witness.name} in "
                    f"{place[0]}; usually it is {usual[joint]:.0f} px."
                )
                yield place, score, (joint,), reason
            else:
                yield (
                    place,
                    score,
                    (),
                    f"The {what} is {whole[row] * least[row]:.0f} px from {witness.name} in {place[0]}.",
                )
