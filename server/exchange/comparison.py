"""What is different between two states of the labels, joint by joint."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from tracker import HAND_JOINTS, Annotation, Annotations

SAME_PX = 1e-9


@dataclass(frozen=True)
class HandChange:
    """What became of one hand in one image.

    Attributes:
        frame: Frame number.
        camera: Camera's id.
        hand: `right` or `left`.
        kind: `added`, `removed` or `changed`.
        joints_added: Names of joints that were not there.
        joints_removed: Names of joints that are no longer there.
        joints_moved: Distance of each joint that moved, px, by name.
        joints_restated: Names of joints whose state alone changed (visible, occluded, outside).
    """

    frame: int
    camera: str
    hand: str
    kind: str
    joints_added: list[str] = field(default_factory=list)
    joints_removed: list[str] = field(default_factory=list)
    joints_moved: dict[str, float] = field(default_factory=dict)
    joints_restated: list[str] = field(default_factory=list)

    @property
    def max_shift_px(self) -> float:
        """Of the joint that moved most."""
        return max(self.joints_moved.values(), default=0.0)


def compare_labels(before: Annotations, after: Annotations) -> list[HandChange]:
    """Every hand that is different, in the order of frames."""
    old = {item.key: item for item in before.items}
    new = {item.key: item for item in after.items}
    changes = [compare_hands(old.get(key), new.get(key)) for key in sorted(old.keys() | new.keys())]
    return [change for change in changes if change is not None]


def compare_hands(old: Annotation | None, new: Annotation | None) -> HandChange | None:
    """What became of a hand; None when nothing did."""
    item = new or old
    assert item is not None
    nothing = np.zeros((len(HAND_JOINTS), 3))
    a, b = (nothing if one is None else one.points for one in (old, new))
    was, is_ = a[:, 2] > 0, b[:, 2] > 0
    shifts = np.linalg.norm(a[:, :2] - b[:, :2], axis=1)
    moved = was & is_ & (shifts > SAME_PX)
    outside = [(points[:, 2] == 0) & points[:, :2].any(axis=1) for points in (a, b)]
    restated = (was & is_ & (a[:, 2] != b[:, 2])) | (~was & ~is_ & (outside[0] != outside[1]))
    if old is not None and new is not None and not (moved | restated | (was != is_)).any():
        return None
    return HandChange(
        frame=item.frame,
        camera=item.camera,
        hand=item.hand,
        kind="added" if old is None else "removed" if new is None else "changed",
        joints_added=_name(is_ & ~was),
        joints_removed=_name(was & ~is_),
        joints_moved={HAND_JOINTS[j]: round(float(shifts[j]), 6) for j in np.flatnonzero(moved)},
        joints_restated=_name(restated),
    )


def _name(which: np.ndarray) -> list[str]:
    return [HAND_JOINTS[j] for j in np.flatnonzero(which)]
