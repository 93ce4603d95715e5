"""A camera whose pictures are mirrored: it sees the other hand than all others."""

from __future__ import annotations

from collections.abc import Sequence as Many

import numpy as np

from tracker.capture.sequence import Sequence
from tracker.errors import TrackingError
from tracker.landmarks import HandDetector

FIRST, LOOKED_AT, ENOUGH = 60, 8, 4
"""Length of the beginning, how many of its frames are examined in each view, and in how many a view must see the hand
before it is judged."""

SURE = 0.8
"""A view sees the other hand where the detector is so sure of it in nearly every frame, and of the recording's hand in
the other views together. Of the five views of the real recordings at hand none sees another hand so in any of eight
frames."""


def check_mirrored(sequence: Sequence, views: Many[str], hand: str, frames: range, detector: HandDetector) -> None:
    """Refuse views of which one is mirrored.

    With both hands in the pictures a mirrored one has both, too, exchanged; that is not told here.

    Args:
        sequence: The recording.
        views: Two cameras with colour or more.
        hand: The only one that the recording shows.
        frames: Of the run.
        detector: Tells a hand's side.

    Raises:
        TrackingError: It says which, and what to do.
    """
    first = frames[:FIRST]
    looked_at = [first[round(at)] for at in np.linspace(0, len(first) - 1, min(LOOKED_AT, len(first)))]
    sides = {view: _look(sequence, view, hand, looked_at, detector) for view in views}
    for view, own in sides.items():
        others = np.concatenate([found for other, found in sides.items() if other != view])
        is_other = own < 1.0 - SURE
        if len(own) < ENOUGH or len(others) < ENOUGH or is_other.mean() < 0.9 or np.median(others) < SURE:
            continue
        left = [other for other in views if other != view]
        seen = "left" if hand == "right" else "right"
        raise TrackingError(
            f"{view} sees a {seen} hand in {np.count_nonzero(is_other)} of {len(own)} frames, and {' and '.join(left)} "
            f"a {hand} one: its pictures are mirrored. Mirror them back, switch mirroring off where it was recorded, "
            f"or leave the camera out: choose {','.join(left)}."
        )


def _look(sequence: Sequence, view: str, hand: str, frames: Many[int], detector: HandDetector) -> np.ndarray:
    """(N,) probability that the hand is the recording's, in the frames that show one, each looked at by itself."""
    found = []
    for frame in frames:
        hands = detector.find(sequence.color(frame, view), 1)
        found += [hands[0].right if hand == "right" else 1.0 - hands[0].right] if hands else []
    return np.array(found, dtype=np.float64)
