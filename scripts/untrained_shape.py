"""Shape directions of the untrained hand: lengths and widths, made up here and taken from nobody's hand."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

CHAINS = {"index": 1, "middle": 4, "little": 7, "ring": 10, "thumb": 13}
TIPS = ("thumb", "index", "middle", "ring", "little")

SIZE = 0.06
FINGERS_LONG, FINGER_LONG, THUMB_LONG = 0.06, 0.04, 0.06
FINGERS_THICK, THUMB_THICK, TIPS_THICK = 0.08, 0.08, 0.08
PALM_LONG, PALM_WIDE, PALM_THICK = 0.06, 0.06, 0.10
THUMB_BASE = 0.004
"""m; the others are relative. Round numbers for the standard deviation among adults."""


class ShapeMaker:
    """Directions over the vertices and, behind them, the joints.

    Args:
        vertices: (V, 3) m.
        joints: (B, 3) m, at the origin the wrist; x towards the middle knuckle, y towards the thumb, z out of the back.
        tips: (5, 3) m.
        weights: (V, B).
    """

    def __init__(self, vertices: Array, joints: Array, tips: Array, weights: Array) -> None:
        parents = dict.fromkeys(CHAINS.values(), 0)
        follow = np.zeros((len(joints), len(joints)))
        for bone in range(len(joints)):
            follow[bone, parents.get(bone, max(bone - 1, 0))] = 1.0
        self.points = np.concatenate([vertices, joints])
        self.weights = np.concatenate([weights, follow])
        self.joints, self.num_vertices = joints, len(vertices)
        self.chains = {f: np.array([*joints[b : b + 3], tips[TIPS.index(f)]]) for f, b in CHAINS.items()}
        self.palm = self.weights[:, 0]
        self.parts: list[tuple[str, Array]] = []

    def make(self) -> tuple[tuple[str, ...], Array, Array]:
        """Names, (V, 3, S) of the vertices and (B, 3, S) of the joints, m per standard deviation."""
        self._add("size", SIZE * self.points)
        self._add("finger length", FINGERS_LONG * sum(self._longer(f) for f in CHAINS if f != "thumb"))
        for finger in ("index", "middle", "ring", "little"):
            self._add(f"{finger} length", FINGER_LONG * self._longer(finger))
        self._add("thumb length", THUMB_LONG * self._longer("thumb"))
        self._add("finger thickness", FINGERS_THICK * sum(self._thicker(f) for f in CHAINS if f != "thumb"))
        self._add("thumb thickness", THUMB_THICK * self._thicker("thumb"))
        self._add("fingertip thickness", TIPS_THICK * sum(self._thicker(f, is_tip=True) for f in CHAINS))
        for name, axis, share in (("length", 0, PALM_LONG), ("width", 1, PALM_WIDE), ("thickness", 2, PALM_THICK)):
            self._add(f"palm {name}", share * self._palm_along(axis))
        for name, axis in (("out", 1), ("forward", 0)):
            thumb = self.weights[:, 13:16].sum(axis=1)
            thumb[self.num_vertices + 13] = 1.0
            move = np.zeros(3)
            move[axis] = THUMB_BASE
            self._add(f"thumb base {name}", thumb[:, None] * move)
        names, offsets = zip(*self.parts, strict=True)
        stacked = np.stack(offsets, axis=2)
        return names, stacked[: self.num_vertices], stacked[self.num_vertices :]

    def _add(self, name: str, offsets: Array) -> None:
        self.parts.append((name, offsets))

    def _longer(self, finger: str) -> Array:
        """Each bone of the finger twice as long."""
        first, chain = CHAINS[finger], self.chains[finger]
        offsets = np.zeros_like(self.points)
        before = np.zeros(3)
        for number in range(3):
            along = chain[number + 1] - chain[number]
            share = np.clip((self.points - chain[number]) @ along / (along @ along), 0.0, None)
            offsets += self.weights[:, first + number][:, None] * (before + share[:, None] * along)
            before = before + along
        return offsets

    def _thicker(self, finger: str, is_tip: bool = False) -> Array:
        """The finger twice as thick about its bones, or only its end."""
        first, chain = CHAINS[finger], self.chains[finger]
        offsets = np.zeros_like(self.points)
        for number in range(3):
            along = chain[number + 1] - chain[number]
            share = (self.points - chain[number]) @ along / (along @ along)
            radial = self.points - chain[number] - share[:, None] * along
            near = np.clip(share, 0.0, 1.0) * (number == 2) if is_tip else 1.0
            offsets += (self.weights[:, first + number] * near)[:, None] * radial
        offsets[self.num_vertices :] = 0.0
        return offsets

    def _palm_along(self, axis: int) -> Array:
        """The palm twice as large along an axis; fingers go with their knuckles."""
        offsets = np.zeros_like(self.points)
        offsets[:, axis] = self.palm * self.points[:, axis]
        for finger, first in CHAINS.items():
            own = self.weights[:, first : first + 3].sum(axis=1)
            offsets[:, axis] += own * self.chains[finger][0][axis]
            offsets[self.num_vertices + first, axis] = self.chains[finger][0][axis]
        return offsets
