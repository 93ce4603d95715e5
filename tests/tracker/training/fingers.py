"""A toy that can be learnt in a second: a finger of four bones, whose truth is known."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.sparse import csr_array
from scipy.spatial.transform import Rotation

from tracker.model.skinning import keep_heaviest
from tracker.training.rig import Rig, place

PARENTS = np.array([-1, 0, 1, 2])
RINGS, AROUND, LENGTH, RADIUS = 25, 10, 0.10, 0.009


def make_tube() -> tuple[npt.NDArray, npt.NDArray]:
    """A closed tube along x, vertices (V, 3) m and faces (F, 3) that look outward."""
    x = np.linspace(0.0, LENGTH, RINGS)
    angle = np.arange(AROUND) * 2.0 * np.pi / AROUND
    ring = np.stack([np.zeros(AROUND), RADIUS * np.cos(angle), RADIUS * np.sin(angle)], axis=1)
    vertices = np.concatenate(
        [ring + np.array([at, 0.0, 0.0]) for at in x] + [[[-0.003, 0, 0], [LENGTH + 0.003, 0, 0]]]
    )
    faces = []
    for i in range(RINGS - 1):
        for j in range(AROUND):
            a, b = i * AROUND + j, i * AROUND + (j + 1) % AROUND
            faces += [[a, b, a + AROUND], [b, b + AROUND, a + AROUND]]
    last, start, end = (RINGS - 1) * AROUND, len(vertices) - 2, len(vertices) - 1
    for j in range(AROUND):
        faces += [[start, (j + 1) % AROUND, j], [end, last + j, last + (j + 1) % AROUND]]
    return vertices, np.array(faces)[:, ::-1].copy()


def make_weights(x: npt.NDArray, blur: float) -> npt.NDArray:
    """(V, 4) weights that go over from bone to bone within `blur`, m, of each joint."""
    over = [np.clip(0.5 + (x - at) / (2.0 * blur), 0.0, 1.0) for at in (0.03, 0.055, 0.078)]
    steps = [np.ones_like(x), *over, np.zeros_like(x)]
    return np.stack([steps[b] - steps[b + 1] for b in range(4)], axis=1)


@dataclass(frozen=True)
class Fingers:
    """Registrations of some people's fingers with what they were made from."""

    targets: npt.NDArray
    owners: npt.NDArray
    templates: npt.NDArray
    joints: npt.NDArray
    posed_joints: npt.NDArray
    rotations: npt.NDArray
    translations: npt.NDArray
    weights: npt.NDArray
    directions: npt.NDArray
    faces: npt.NDArray


def make_fingers(people: int = 4, poses: int = 20, with_bulges: bool = True, seed: int = 0) -> Fingers:
    """People of different length and width, bent by up to 80 degrees at each joint; exact linear blend skinning, plus
    bulges of up to 2 mm per radian at the joints if asked for."""
    rng = np.random.default_rng(seed)
    tube, faces = make_tube()
    weights = make_weights(tube[:, 0], 0.008)
    base = np.array([[0.0, 0, 0], [0.03, 0, 0.001], [0.055, 0, 0.001], [0.078, 0, 0.001]])
    directions = np.zeros((len(tube), 3, 27))
    if with_bulges:
        for k, at in enumerate((0.03, 0.055, 0.078)):
            near = np.exp(-(((tube[:, 0] - at) / 0.008) ** 2))
            directions[:, 2, 9 * k + 2] = 0.002 * near * np.sign(tube[:, 2])
            directions[:, 0, 9 * k + 6] = 0.001 * near
    rig = Rig(PARENTS, keep_heaviest(weights), directions)
    scales = np.stack([rng.uniform(0.85, 1.2, people), *[rng.uniform(0.8, 1.25, people)] * 2], axis=1)
    templates, joints = tube * scales[:, None], base * scales[:, None]
    owners = np.repeat(np.arange(people), poses)
    count = len(owners)
    angles = np.zeros((count, 4, 3))
    angles[:, 1:, 1] = rng.uniform(-0.1, 1.4, (count, 3))
    angles[:, 1:, 2] = rng.normal(0.0, 0.12, (count, 3))
    angles[:, 1:, 0] = rng.normal(0.0, 0.08, (count, 3))
    angles[np.arange(people) * poses, 1:] *= 0.05
    rotations = Rotation.from_rotvec(angles.reshape(-1, 3)).as_matrix().reshape(count, 4, 3, 3)
    rotations[:, 0] = Rotation.random(count, rng=rng).as_matrix()
    translations = rng.normal(0.0, 0.3, (count, 3))
    targets, posed = np.empty((count, *tube.shape)), np.empty((count, 4, 3))
    for n, person in enumerate(owners):
        hand = place(rig, templates[person], joints[person], rotations[n], translations[n])
        targets[n], posed[n] = hand.vertices, hand.joints
    return Fingers(
        targets, owners, templates, joints, posed, rotations, translations, weights, directions, faces
    )  # fmt: skip


def crude_regressor(template: npt.NDArray) -> csr_array:
    """Joints at the middle of the rings nearest to where a person with average fingers would have them."""
    rows = np.zeros((4, len(template)))
    for b, at in enumerate((0.0, 0.03, 0.055, 0.078)):
        ring = int(np.argmin(np.abs(np.linspace(0.0, LENGTH, RINGS) - at)))
        rows[b, ring * AROUND : (ring + 1) * AROUND] = 1.0 / AROUND
    return csr_array(rows)
