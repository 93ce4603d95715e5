"""What skin does that follows bones: it swells, folds and slides when joints bend."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import numpy.typing as npt
from scipy.sparse import csr_matrix

from tracker.model.joints import FINGERS
from tracker.synthesis.scans.subject import BONES, Subject, load_subject, load_surface

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]


@dataclass(frozen=True)
class Tissue:
    """Displacements of a subject's skin at rest, each driven by the bending of one or two joints.

    Attributes:
        fields: (3 V, K) m for full bending, without those that keep the volume.
        pads: (3 V, K) m for full bending, those that swell to keep the volume.
        first: (K,) flexion that drives a field.
        second: (K,) another that it needs besides, or -1.
        field_power: (K,) how a field grows with the share of full bending.
    """

    fields: csr_matrix
    pads: csr_matrix
    field_drivers: Ints
    pad_drivers: Ints
    field_powers: Array

    def displace(self, angles: Array, strength: float) -> tuple[Array, Array]:
        """(V, 3) displacements of creases, knuckles and sliding, and those of the pads, for angles (D,) rad."""
        field_shares = bending(angles, self.field_drivers)
        pad_shares = bending(angles, self.pad_drivers)
        own = self.fields @ (strength * field_shares**self.field_powers)
        return own.reshape(-1, 3), (self.pads @ (strength * pad_shares**1.4)).reshape(-1, 3)


FULL_BEND = np.radians(95.0)
"""Flexion that counts as 1, rad."""


def bending(angles: Array, drivers: Ints) -> Array:
    """(K,) from 0 to about 1.2: the mean bending of a field's drivers (K, 2), the second of which may be -1.

    Levels off as tissue does that is squeezed already.
    """
    flexed = np.clip(angles, 0.0, None) / FULL_BEND
    flexed = np.append(np.tanh(1.4 * flexed) / np.tanh(1.4), np.nan)
    return np.nanmean(flexed[drivers], axis=1)


@lru_cache(maxsize=48)
def load_tissue(number: int) -> Tissue:
    """The tissue of a subject's hand."""
    return _Builder(load_subject(number)).build()


class _Builder:
    def __init__(self, subject: Subject) -> None:
        surface = load_surface()
        self.subject = subject
        self.normals = vertex_normals(subject.vertices, surface.faces)
        self.weights = surface.all_weights
        self.fields: list[Array] = []
        self.field_drivers: list[tuple[int, int]] = []
        self.powers: list[float] = []
        self.pads: list[Array] = []
        self.pad_drivers: list[tuple[int, int]] = []
        self.size = float(np.linalg.norm(subject.ends[0] - subject.joints[0])) / 0.089

    def build(self) -> Tissue:
        for finger in FINGERS:
            flexions = self._flexions(finger)
            for order, bone in enumerate(flexions):
                self._joint(finger, bone, flexions, order)
            self._pads(finger, flexions)
        return Tissue(
            csr_matrix(np.array(self.fields).T),
            csr_matrix(np.array(self.pads).T),
            np.array(self.field_drivers),
            np.array(self.pad_drivers),
            np.array(self.powers),
        )

    def _flexions(self, finger: str) -> list[int]:
        """Bones that a finger bends by; of the four fingers the phalanges."""
        segments = ("metacarpal", "proximal", "distal") if finger == "thumb" else ("proximal", "middle", "distal")
        return [BONES.index(f"{finger}_{segment}") for segment in segments]

    def _driver(self, bone: int) -> int:
        return next(
            number
            for number, dof in enumerate(self.subject.dofs)
            if self.subject.dof_bones[number] == bone and dof.motion == "flexion"
        )

    def _frame(self, bone: int) -> tuple[Array, Array, Array, float]:
        """Where a bone begins, unit along it, unit out of its back, length."""
        along = self.subject.ends[bone] - self.subject.joints[bone]
        length = float(np.linalg.norm(along))
        along = along / length
        back = np.cross(along, self.subject.dof_axes[self._driver(bone)])
        return self.subject.joints[bone], along, back / np.linalg.norm(back), length

    def _own(self, finger: str) -> Array:
        """(V,) how much a vertex belongs to a finger, with its ray in the palm."""
        return self.weights[:, [number for number, bone in enumerate(BONES) if bone.startswith(finger)]].sum(axis=1)

    def _joint(self, finger: str, bone: int, flexions: list[int], order: int) -> None:
        center, along, back, _ = self._frame(bone)
        driver = self._driver(bone)
        before = self._driver(flexions[order - 1]) if order > 0 else -1
        offset = self.subject.vertices - center
        x, facing = offset @ along, self.normals @ back
        own = self._own(finger) * (np.linalg.norm(offset, axis=1) < 0.035 * self.size)
        size = self.size * (1.0 if order < 2 else 0.8)
        dorsal, palmar = np.clip(facing, 0.0, 1.0) ** 1.5, np.clip(-facing, 0.0, 1.0)
        if finger == "thumb" and order == 0:
            return
        height = (1.3e-3, 0.9e-3, 0.5e-3)[order]
        knuckle = own * dorsal * np.exp(-0.5 * ((x + 1.5e-3) / (4.5e-3 * size)) ** 2)
        self._field(height * size * knuckle[:, None] * self.normals, (driver, -1), 1.6)
        depth = (0.6e-3, 1.1e-3, 0.8e-3)[order]
        crease = own * palmar * np.exp(-0.5 * (x / (2.4e-3 * size)) ** 2)
        self._field(-depth * size * crease[:, None] * self.normals, (driver, -1), 2.0)
        slide = own * dorsal * np.exp(-0.5 * (x / (9e-3 * size)) ** 2) * (0.35 - np.tanh(x / (5e-3 * size)))
        self._field(1.4e-3 * size * slide[:, None] * along, (driver, before), 1.2)

    def _pads(self, finger: str, flexions: list[int]) -> None:
        for order, bone in enumerate(flexions):
            start, along, back, length = self._frame(bone)
            first = self._driver(bone)
            second = self._driver(flexions[order + 1]) if order + 1 < len(flexions) else -1
            offset = self.subject.vertices - start
            x = offset @ along / length - (0.5 if order < 2 else 0.35)
            facing = -(self.normals @ back)
            own = self._own(finger) * (np.linalg.norm(offset - 0.5 * length * along, axis=1) < 0.8 * length)
            swell = own * np.exp(-0.5 * (x / 0.26) ** 2) * np.clip(0.25 + 0.75 * facing, 0.0, 1.0)
            height = (1.9e-3, 1.2e-3, 0.6e-3)[order] if finger != "thumb" else (3.2e-3, 1.2e-3, 0.6e-3)[order]
            self._pad(height * self.size * swell[:, None] * self.normals, (first, second))
        if finger not in ("thumb", "index"):
            return
        # The cushions over the heads of the metacarpals.
        for other in FINGERS[1:] if finger == "index" else ():
            bone = BONES.index(f"{other}_metacarpal")
            end, start = self.subject.ends[bone], self.subject.joints[bone]
            along = (end - start) / np.linalg.norm(end - start)
            x = (self.subject.vertices - end) @ along
            palmar = np.clip(-self.normals[:, 2], 0.0, 1.0)
            cushion = self._own(other) * palmar * np.exp(-0.5 * ((x + 6e-3) / (11e-3 * self.size)) ** 2)
            driver = self._driver(BONES.index(f"{other}_proximal"))
            self._pad(2.2e-3 * self.size * cushion[:, None] * self.normals, (driver, -1))

    def _field(self, displacement: Array, drivers: tuple[int, int], power: float) -> None:
        self.fields.append(_trim(displacement))
        self.field_drivers.append(drivers)
        self.powers.append(power)

    def _pad(self, displacement: Array, drivers: tuple[int, int]) -> None:
        self.pads.append(_trim(displacement))
        self.pad_drivers.append(drivers)


def _trim(displacement: Array) -> Array:
    """(3 V,) with what is below a micrometre gone."""
    flat = displacement.reshape(-1)
    return np.where(np.abs(flat) < 1e-6, 0.0, flat)


def vertex_normals(vertices: Array, faces: Ints) -> Array:
    """(V, 3) unit, outwards, each the mean of its faces' by area."""
    a, b, c = vertices[faces[:, 0]], vertices[faces[:, 1]], vertices[faces[:, 2]]
    crossed = np.cross(b - a, c - a)
    normals = np.stack(
        [np.bincount(faces.ravel(), np.repeat(crossed[:, k], 3), len(vertices)) for k in range(3)], axis=1
    )
    return normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-20)
