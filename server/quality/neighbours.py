"""Checks of a label against those of the frames before and after."""

from __future__ import annotations

import warnings
from bisect import bisect_left, bisect_right
from collections import defaultdict
from collections.abc import Iterator, Sequence

import numpy as np
import numpy.typing as npt

from server.quality.finding import Finding, Looked
from server.quality.hand import joint_name
from server.quality.labels import Label, find_median

Array = npt.NDArray[np.float64]

REACH_FRAMES = 15
"""Annotated frames farther apart say nothing about each other."""


STILL_FRAMES = 3
"""Annotated frames farther apart than this may well differ by a motion: a joint must be the farther off."""


def check_handedness(labels: Sequence[Label], hands: Sequence[str], looked: Looked) -> Iterator[Finding]:
    """Labels nearer to the other hand in the neighbouring frames than to their own."""
    tracks = _by_hand(labels)
    frames = {hand: [label.frame for label in track] for hand, track in tracks.items()}
    for label in labels:
        other = "left" if label.hand == "right" else "right"
        own_px, other_px = (
            _nearest(label, tracks[label.camera, hand], frames.get((label.camera, hand), []))
            for hand in (label.hand, other)
        )
        if np.isfinite([own_px, other_px]).any() or (hands and label.hand not in hands):
            looked.at("handedness", label)
        if not np.isfinite(other_px) or other_px > 0.5 * label.size_px:
            if hands and label.hand not in hands and not np.isfinite(own_px):
                yield Finding(label, "handedness", 2.0, (), f"This recording is said to have no {label.hand} hand.")
            continue
        own_px = min(own_px, 2.0 * label.size_px)
        if own_px > 2.0 * other_px + 4:
            score = min(10.0, own_px / (2.0 * other_px + 4))
            reason = (
                f"In the neighbouring frames the {other} hand is here ({other_px:.0f} px away), the {label.hand} one "
                f"{own_px:.0f} px away: are they swapped?"
            )
            yield Finding(label, "handedness", score, (), reason)


def check_jumps(labels: Sequence[Label], looked: Looked) -> Iterator[Finding]:
    """Joints far from where they are in the annotated frames before and after, the hand's own motion taken off; and
    whole hands that are elsewhere than just before and just after."""
    for track in _by_hand(labels).values():
        yield from _find_stray_hands(track)
        jumps = [_jump(track, place) for place in range(len(track))]
        for place, (label, jump) in enumerate(zip(track, jumps, strict=True)):
            if not np.isfinite(jump).any():
                continue
            looked.at("jump", label)
            typical = float(np.nanmedian(jump))
            others = [track[other] for other in (place - 1, place + 1) if 0 <= other < len(track)]
            apart = min(abs(label.frame - other.frame) for other in others)
            limit = max(8.0, 0.1 * label.size_px, 5.0 * typical) * max(1.0, apart / STILL_FRAMES)
            beside = [jumps[other] for other in (place - 1, place + 1) if 0 <= other < len(track)]
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", RuntimeWarning)
                of_others = np.nanmax([*beside, np.zeros(21)], axis=0)
            is_own = ~(of_others > 1.3 * jump)  # a neighbour that jumps more is the one to blame
            joints = np.flatnonzero((jump > limit) & is_own)
            if joints.size:
                worst = joints[np.argmax(jump[joints])]
                reason = f"The {joint_name(worst)} is {jump[worst]:.0f} px from where the neighbouring frames have it."
                yield Finding(label, "jump", float(jump[worst] / limit), tuple(map(int, joints)), reason)


def _find_stray_hands(track: Sequence[Label]) -> Iterator[Finding]:
    """A hand that is elsewhere in one frame, and at the same place in the labelled frames just before and just after:
    its label may belong to another frame."""
    for before, label, after in zip(track, track[1:], track[2:], strict=False):
        if after.frame - before.frame > 2 * STILL_FRAMES:
            continue
        to_before, to_after = _find_shift(before, label), _find_shift(after, label)
        limit = max(20.0, 0.2 * label.size_px) + 2.0 * _find_shift(before, after)
        away = min(to_before, to_after)
        if away > limit:
            reason = (
                f"The whole hand is {away:.0f} px from where frames {before.frame} and {after.frame} have it: is this "
                "the label of another frame?"
            )
            yield Finding(label, "jump", min(10.0, float(away / limit)), (), reason)


def _find_shift(one: Label, other: Label) -> float:
    """How far a hand as a whole is from where it is in another frame, px; NaN where no joint is in both."""
    return float(np.linalg.norm(find_median(one.pixels - other.pixels, axis=0)))


def _by_hand(labels: Sequence[Label]) -> dict[tuple[str, str], list[Label]]:
    """Labels of one hand in one camera, by frame."""
    tracks: dict[tuple[str, str], list[Label]] = defaultdict(list)
    for label in sorted(labels, key=lambda one: one.frame):
        tracks[label.camera, label.hand].append(label)
    return tracks


def _nearest(label: Label, track: Sequence[Label], frames: Sequence[int]) -> float:
    """Mean distance, px, to the nearest of the labels just before and after; infinite without any."""
    beside = bisect_left(frames, label.frame) - 1, bisect_right(frames, label.frame)
    near = [track[at] for at in beside if 0 <= at < len(track) and abs(frames[at] - label.frame) <= REACH_FRAMES]
    found = [np.linalg.norm(label.pixels - one.pixels, axis=1) for one in near]
    means = [float(np.nanmean(d)) for d in found if np.isfinite(d).any()]
    return min(means, default=np.inf)


def _jump(track: Sequence[Label], place: int) -> Array:
    """(21,) px from where the labels before and after would have each joint, the median shift taken off."""
    label = track[place]
    before = track[place - 1] if place > 0 else None
    after = track[place + 1] if place + 1 < len(track) else None
    if before is not None and label.frame - before.frame > REACH_FRAMES:
        before = None
    if after is not None and after.frame - label.frame > REACH_FRAMES:
        after = None
    if before is not None and after is not None:
        share = (label.frame - before.frame) / (after.frame - before.frame)
        expected = before.pixels + share * (after.pixels - before.pixels)
    elif before is not None or after is not None:
        one = before or after
        assert one is not None
        expected = one.pixels
    else:
        return np.full(21, np.nan)
    moved = label.pixels - expected
    if not np.isfinite(moved).any():
        return np.full(21, np.nan)
    return np.linalg.norm(moved - find_median(moved, axis=0), axis=1)
