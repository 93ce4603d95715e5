"""Sums of squared residuals of skinned points, kept per pair of bones until they are needed per degree of freedom.

A residual that moves a skinned point x along n has the derivative Σ_j ξ_d · w_j by degree of freedom d, the sum over
the point's bones j below d, w_j = κ_j (n, x_j × n) and ξ_d = (u, ω) the world twist. So JᵀJ and Jᵀr follow from the
6x6 sums of w_j w_kᵀ over pairs of bones that share points, and J is never built.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from numba import njit

from tracker.model.scene import PosedScene

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int32]

MILLIMETRES = 1000.0
"""Residuals are in mm: the paper's weights and thresholds mean something only there."""

MAX_BONES = 12
"""Bones that one surface point can follow: three vertices of four each."""


@dataclass
class NormalEquations:
    """A running sum; the solver's terms add to it in any order.

    Attributes:
        posed: Where everything is linearised.
        pairs: (P, 2) pairs of bones j <= k that share a face.
        pair_index: (B, B) row of a pair, -1 for none.
        blocks: (P, 6, 6) Σ w_k w_jᵀ, mm² per squared unit of twist.
        gradients: (B, 6) Σ w_j r.
        cost: Σ weight r², mm².
        count: Residuals added, the paper's C_all.
    """

    posed: PosedScene
    pairs: Ints
    pair_index: Ints
    blocks: Array
    gradients: Array
    cost: float = 0.0
    count: int = 0

    @classmethod
    def at(cls, posed: PosedScene) -> NormalEquations:
        """An empty sum at a posed scene."""
        pairs, pair_index = posed.scene.bone_pairs
        return cls(posed, pairs, pair_index, np.zeros((len(pairs), 6, 6)), np.zeros((len(pair_index), 6)))

    def add(self, other: NormalEquations) -> None:
        """Add another sum at the same posed scene."""
        assert other.posed is self.posed
        self.blocks += other.blocks
        self.gradients += other.gradients
        self.cost += other.cost
        self.count += other.count

    def assemble(self) -> tuple[Array, Array]:
        """JᵀJ (D, D) and Jᵀr (D,) of all that was added."""
        dofs = self.posed.scene.num_dofs
        JtJ, Jtr = np.zeros((dofs, dofs)), np.zeros(dofs)
        _assemble_into(
            JtJ, Jtr, self.blocks, self.gradients, self.pairs, self.posed.scene.arrays.chains, self.posed.twists
        )
        return JtJ, Jtr


@njit(cache=True, nogil=True)
def gather_bones(bones, sums, ids, barycentric, weight_bones, weights, bone_vertices):
    """Collect the bones of the surface point Σ barycentric[i] · vertex ids[i] and return their number.

    Fills bones (MAX_BONES,) and sums (MAX_BONES, 4), κ and κ x_j of each.
    """
    count = 0
    for corner in range(3):
        share = barycentric[corner]
        if share == 0.0:
            continue
        vertex = ids[corner]
        for slot in range(weights.shape[1]):
            weight = weights[vertex, slot]
            if weight == 0.0:
                break
            bone = weight_bones[vertex, slot]
            place = 0
            while place < count and bones[place] != bone:
                place += 1
            if place == count:
                bones[place] = bone
                sums[place, 0] = sums[place, 1] = sums[place, 2] = sums[place, 3] = 0.0
                count += 1
            kappa = share * weight
            sums[place, 0] += kappa
            sums[place, 1] += kappa * bone_vertices[vertex, slot, 0]
            sums[place, 2] += kappa * bone_vertices[vertex, slot, 1]
            sums[place, 3] += kappa * bone_vertices[vertex, slot, 2]
    return count


@njit(cache=True, nogil=True)
def add_row(blocks, gradients, pair_index, bones, sums, count, wrenches, normal, residual, weight):
    """Add weight · (residual + n · dx)² for a point gathered by `gather_bones`; wrenches (MAX_BONES, 6) is scratch."""
    nx, ny, nz = normal
    for place in range(count):
        kappa, x, y, z = sums[place, 0], sums[place, 1], sums[place, 2], sums[place, 3]
        w = wrenches[place]
        w[0], w[1], w[2] = kappa * nx, kappa * ny, kappa * nz
        w[3], w[4], w[5] = y * nz - z * ny, z * nx - x * nz, x * ny - y * nx
        g = gradients[bones[place]]
        scale = weight * residual
        for i in range(6):
            g[i] += scale * w[i]
    for first in range(count):
        j = bones[first]
        a = wrenches[first]
        a0, a1, a2 = weight * a[0], weight * a[1], weight * a[2]
        a3, a4, a5 = weight * a[3], weight * a[4], weight * a[5]
        for second in range(count):
            k = bones[second]
            if j > k:
                continue
            block = blocks[pair_index[j, k]]
            b = wrenches[second]
            for m in range(6):
                value = b[m]
                block[m, 0] += a0 * value
                block[m, 1] += a1 * value
                block[m, 2] += a2 * value
                block[m, 3] += a3 * value
                block[m, 4] += a4 * value
                block[m, 5] += a5 * value


@njit(cache=True, nogil=True)
def _assemble_into(JtJ, Jtr, blocks, gradients, pairs, chains, twists):
    half = np.zeros(6)
    for bone in range(len(gradients)):
        g = gradients[bone]
        for slot in range(chains.shape[1]):
            dof = chains[bone, slot]
            if dof < 0:
                break
            for i in range(6):
                Jtr[dof] += twists[dof, i] * g[i]
    for pair in range(len(pairs)):
        j, k = pairs[pair, 0], pairs[pair, 1]
        block = blocks[pair]
        for slot in range(chains.shape[1]):
            d = chains[j, slot]
            if d < 0:
                break
            for m in range(6):
                half[m] = 0.0
                for i in range(6):
                    half[m] += twists[d, i] * block[m, i]
            for other in range(chains.shape[1]):
                e = chains[k, other]
                if e < 0:
                    break
                value = 0.0
                for m in range(6):
                    value += half[m] * twists[e, m]
                JtJ[d, e] += value
                if j != k:
                    JtJ[e, d] += value
