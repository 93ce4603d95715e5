"""Spaces of shapes and of poses: principal components, [R17] section 3.3."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.geometry.se3 import find_rotations

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Space:
    """mean (D,); components (C, D) with unit length, most important first; variances (C,) along them."""

    mean: Array
    components: Array
    variances: Array

    @property
    def explained(self) -> Array:
        """(C,) share of the variance that the first components explain together, [R17] Fig. 12."""
        total = self.variances.sum()
        return np.cumsum(self.variances) / total if total > 0.0 else np.ones(len(self.variances))


def find_space(samples: Array) -> Space:
    """Principal components of samples (N, D): at most N - 1 and at most D.

    The sign of a component is fixed by its largest element, which is positive: the same samples always give the same.
    """
    mean = samples.mean(0)
    _, singular, components = np.linalg.svd(samples - mean, full_matrices=False)
    count = min(len(samples) - 1, samples.shape[1])
    components = components[:count]
    signs = np.sign(components[np.arange(count), np.abs(components).argmax(1)])
    return Space(mean, components * signs[:, None], singular[:count] ** 2 / max(len(samples) - 1, 1))


def find_shape_space(templates: Array, count: int) -> tuple[Array, Array, Space]:
    """Mean template (V, 3) and shape directions (V, 3, S) per standard deviation, m, of templates (P, V, 3)."""
    space = find_space(templates.reshape(len(templates), -1))
    used = min(count, len(space.components))
    scaled = space.components[:used] * np.sqrt(space.variances[:used])[:, None]
    V = templates.shape[1]
    return space.mean.reshape(V, 3), np.ascontiguousarray(scaled.T.reshape(V, 3, used)), space


def align_rigidly(templates: Array, joints: Array, anchor: Array, rounds: int = 3) -> tuple[Array, Array, Array]:
    """Lay templates (S, V, 3) and their joints onto their mean: how a template is turned as a whole is arbitrary.

    Args:
        templates, joints (S, B, 3): m.
        anchor: (V,) weights of vertices, such as those of the palm.

    Returns:
        Templates, joints, and the rotations (S, 3, 3) that were applied to them.
    """
    templates, joints = templates.copy(), joints.copy()
    turned = np.tile(np.eye(3), (len(templates), 1, 1))
    share = anchor / anchor.sum()
    for _ in range(rounds):
        mean = templates.mean(0)
        centre = share @ mean
        for s in range(len(templates)):
            own = share @ templates[s]
            R = find_rotations(((mean - centre) * share[:, None]).T @ (templates[s] - own))
            templates[s] = (templates[s] - own) @ R.T + centre
            joints[s] = (joints[s] - own) @ R.T + centre
            turned[s] = R @ turned[s]
    return templates, joints, turned


def compute_rotation_vectors(rotations: Array) -> Array:
    """(N, 3) of rotation matrices (N, 3, 3), angles at most π."""
    from scipy.spatial.transform import Rotation

    return Rotation.from_matrix(rotations).as_rotvec()
