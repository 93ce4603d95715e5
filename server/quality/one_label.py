"""Checks of a label by itself: its image, its depth, the order of its joints."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from server.quality.finding import Finding, Looked
from server.quality.hand import EDGES, FINGERS, KNUCKLES, find_bone_lengths, joint_name
from server.quality.labels import Label, find_median


def check_outside(labels: Sequence[Label], sizes: dict[str, tuple[int, int]], looked: Looked) -> Iterator[Finding]:
    """Joints that are said to be there but lie outside the image."""
    for label in labels:
        looked.at("outside", label)
        width, height = sizes[label.camera]
        x, y = label.pixels.T
        with np.errstate(invalid="ignore"):
            beyond = np.maximum.reduce([-0.5 - x, -0.5 - y, x - (width - 0.5), y - (height - 0.5)])
        joints = np.flatnonzero(beyond > 0)
        if joints.size:
            worst = joints[np.argmax(beyond[joints])]
            yield Finding(
                label,
                "outside",
                1.0 + float(beyond[worst]) / 20,
                tuple(map(int, joints)),
                f"The {joint_name(worst)} lies {beyond[worst]:.0f} px outside the image but is not marked as outside.",
            )


def check_finger_order(labels: Sequence[Label], looked: Looked) -> Iterator[Finding]:
    """Joints of a finger that go back and forth, and knuckles that do not stand side by side in their order."""
    for label in labels:
        for finger, name in enumerate(FINGERS):
            chain = label.pixels[1 + 4 * finger : 5 + 4 * finger]
            if not np.isfinite(chain).all():
                continue
            looked.at("finger_order", label)
            steps = np.diff(chain, axis=0)
            lengths = np.linalg.norm(steps, axis=1)
            if lengths.min() < 3:
                continue
            turns = np.einsum("ij,ij->i", steps[:-1], steps[1:]) / (lengths[:-1] * lengths[1:])
            if turns.max() < -0.3:
                joints = tuple(range(1 + 4 * finger, 5 + 4 * finger))
                yield Finding(
                    label,
                    "finger_order",
                    1 - float(turns.max()),
                    joints,
                    f"The {name} goes back and forth: are its joints in order?",
                )
        knuckles = label.pixels[KNUCKLES]
        across = knuckles[3] - knuckles[0] if np.isfinite(knuckles).all() else np.zeros(2)
        width = max(float(np.linalg.norm(across)), 0.15 * label.size_px)
        centred = knuckles - knuckles.mean(axis=0)
        if np.isfinite(centred).all() and width > 8:
            axis = np.linalg.svd(centred)[2][0]
            along = centred @ axis * np.sign(across @ axis or 1.0)
            back = float(np.max(-np.diff(along)))
            spread = float(np.ptp(along))
            if back > 0.2 * spread:
                place = int(np.argmax(-np.diff(along)))
                pair = f"{FINGERS[place + 1]} and {FINGERS[place + 2]}"
                joints = (int(KNUCKLES[place]), int(KNUCKLES[place + 1]))
                yield Finding(
                    label,
                    "finger_order",
                    5 * back / spread,
                    joints,
                    f"The knuckles of {pair} are not in order: are these fingers swapped?",
                )


def check_depth(labels: Sequence[Label], looked: Looked) -> Iterator[Finding]:
    """Visible joints farther in depth from the joint they hang on than a bone is long: one of them is elsewhere."""
    lengths = find_bone_lengths()
    for label in labels:
        near = label.depths[:, 0]
        if np.isfinite(near).sum() < 4:
            continue
        looked.at("depth", label)
        everything = find_median(label.depth)
        best: tuple[float, int, float] | None = None
        joints = []
        for joint in np.flatnonzero(np.isfinite(near)):
            values = label.depths[joint][np.isfinite(label.depths[joint])]
            around = EDGES[(joint == EDGES).any(axis=1)]
            reach = 1.2 * float(np.max(lengths[(joint == EDGES).any(axis=1)])) + 0.02
            beside = [other for pair in around for other in pair if other != joint and np.isfinite(near[other])]
            if not beside:
                continue
            gap = min(float(np.min(np.abs(values - label.depth[other]))) for other in beside)
            if gap > reach and float(np.min(np.abs(values - everything))) > 0.12:
                joints.append(int(joint))
                if best is None or gap / reach > best[0]:
                    best = gap / reach, int(joint), gap
        if best is not None:
            score, joint, gap = best
            reason = (
                f"The depth at the {joint_name(joint)} is {1e3 * gap:.0f} mm from the joint beside it: is it "
                "on the hand, and visible?"
            )
            yield Finding(label, "depth", min(10.0, score), tuple(joints), reason)
